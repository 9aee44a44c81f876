#include "io/token_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace isoparm {
namespace {

constexpr const char* kSpace = " \t\r\n\f\v";

template <class T> bool parse(std::string_view text, T& x) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    return !text.empty() && error == std::errc() && end == text.data() + text.size();
}

}  // namespace

std::string_view TokenReader::read() {
    at_ = std::min(text_.find_first_not_of(kSpace, end_), text_.size());
    end_ = std::min(text_.find_first_of(kSpace, at_), text_.size());
    return token_ = std::string_view(text_).substr(at_, end_ - at_);
}

void TokenReader::fail(const std::string& expected) const {
    std::string found = token_.empty() ? "the end of the file" : "'" + std::string(token_.substr(0, 40)) + "'";
    for (char& c : found)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    fail_at(at_, found, expected);
}

void TokenReader::fail_at(std::size_t place, const std::string& found, const std::string& expected) const {
    std::size_t line = 1, start = 0;
    for (std::size_t i = 0; i < place; ++i)
        if (text_[i] == '\n') ++line, start = i + 1;
    throw_input(path_ + ":" + std::to_string(line) + ":" + std::to_string(place - start + 1) + ": found " + found + ", expected " + expected);
}

bool TokenReader::next_number(double& x) { return parse(read(), x) && std::isfinite(x); }
bool TokenReader::next_integer(int& n) { return parse(read(), n); }

}  // namespace isoparm
