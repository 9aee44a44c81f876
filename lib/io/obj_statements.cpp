#include "io/obj_statements.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "error.h"
#include "text/printable_text.h"

namespace isoparm {
namespace {

constexpr double max_coordinate = 1e100;
constexpr std::string_view space = " \t\r\v\f";

/// Is the next line joined to this one? The backslash is cut off.
bool continues(std::string_view& line) {
    const std::size_t last = line.find_last_not_of(space);
    if (last == line.npos || line[last] != '\\' || line.find('#') != line.npos) return false;
    line = line.substr(0, last);
    return true;
}

}  // namespace

bool ObjStatements::advance() {
    tokens_.clear();
    while (at_ < text_.size()) {
        const std::size_t end = std::min(text_.find('\n', at_), text_.size());
        ++line_;
        std::string_view line = std::string_view(text_).substr(at_, end - at_);
        const bool goes_on = continues(line);
        split(line);
        at_ = end + 1;
        if (!(goes_on && at_ < text_.size()) && !tokens_.empty()) return true;
    }
    return false;
}

void ObjStatements::fail(Place p, const std::string& found, const std::string& expected) const {
    throw_input(path_ + ":" + std::to_string(p.line) + ":" + std::to_string(p.column) + ": found " + found + ", expected " + expected);
}

/// Adds the tokens of a line to those of the statement.
void ObjStatements::split(std::string_view line) {
    next_ = 1;
    std::size_t at = 0;
    while ((at = line.find_first_not_of(space, at)) != line.npos && line[at] != '#') {
        const std::size_t end = std::min(line.find_first_of(space, at), line.size());
        tokens_.push_back({line.substr(at, end - at), {line_, static_cast<int>(at) + 1}});
        at = end;
    }
    end_ = {line_, static_cast<int>(std::min(line.find_last_not_of(space) + 1, line.size())) + 1};
}

ObjStatements::Token ObjStatements::token(const char* expected) {
    if (!more()) fail(end_, "the end of the line", expected);
    return tokens_[next_++];
}

void ObjStatements::nothing_more(const char* after) const {
    if (more()) fail(tokens_[next_].place, in_quotes(tokens_[next_].text), std::string("nothing after ") + after);
}

double ObjStatements::number(const char* expected) {
    const Token t = token(expected);
    const std::string_view digits = t.text.substr(t.text.starts_with('+'));
    double x = 0;
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
    if (status == std::errc::result_out_of_range && end == digits.data() + digits.size()) {
        // too small rounds to zero, too large is refused: only the exponent's sign tells
        if (digits.find("e-") != digits.npos || digits.find("E-") != digits.npos) return 0;
    } else if (status == std::errc() && end == digits.data() + digits.size() && std::abs(x) <= max_coordinate) {
        return x;
    }
    fail(t.place, in_quotes(t.text), std::string(expected) + ": a finite number of at most 1e100 in size");
}

int ObjStatements::integer(std::string_view text, const Token& t, const char* expected) const {
    int x = 0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (status != std::errc() || end != text.data() + text.size()) fail(t.place, in_quotes(t.text), expected);
    return x;
}

int ObjStatements::integer(const char* expected) {
    const Token t = token(expected);
    return integer(t.text, t, expected);
}

}  // namespace isoparm
