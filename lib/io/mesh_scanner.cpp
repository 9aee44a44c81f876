#include "io/mesh_scanner.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "error.h"

namespace isoparm {
namespace {

constexpr double kMostCoordinate = 1e50;  // sixth powers of lengths stay finite
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\r'; }

}  // namespace

bool TextScanner::next_line() {
    at_ = text_.find('\n', at_);
    if (at_ == text_.npos) {
        at_ = text_.size();
        return false;
    }
    line_start_ = ++at_;
    ++line_;
    return at_ < text_.size();
}

std::string_view TextScanner::take(bool over_lines) {
    for (;;) {
        while (at_ < text_.size() && is_space(text_[at_])) ++at_;
        word_line_ = line_, word_column_ = at_ - line_start_ + 1;
        if (at_ == text_.size()) return {};
        const bool joined = text_[at_] == '\\' && (text_.substr(at_ + 1, 1) == "\n" || text_.substr(at_ + 1, 2) == "\r\n");
        if (text_[at_] != '\n' && !(joined && !over_lines)) break;
        if (!over_lines && !joined) return {};
        next_line();
    }
    if (!over_lines && text_[at_] == '#') return {};
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_]) && text_[at_] != '\n') ++at_;
    return text_.substr(begin, at_ - begin);
}

void TextScanner::fail(const std::string& found, const std::string& expected) const {
    throw_input(path_ + ":" + std::to_string(word_line_) + ":" + std::to_string(word_column_) + ": found " + found + ", expected " + expected);
}
void TextScanner::fail_word(std::string_view word, const char* expected) const {
    const bool end_of_text = word_line_ == line_ && at_ == text_.size();
    fail(!word.empty() ? in_quotes(word) : end_of_text ? "the end of the file" : "the end of the line", expected);
}

double TextScanner::number(std::string_view word, const char* expected) const {
    const std::string_view digits = word.substr(word.starts_with('+') ? 1 : 0);
    double x = 0;
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
    if (!digits.empty() && end == digits.data() + digits.size()) {
        if (status == std::errc() && std::fabs(x) <= kMostCoordinate) return x;
        // Too small becomes 0; only the sign of the exponent tells it from too large.
        if (status == std::errc::result_out_of_range && (digits.find("e-") != digits.npos || digits.find("E-") != digits.npos)) return 0;
    }
    if (word.empty()) fail_word(word, expected);
    fail(in_quotes(word), std::string(expected) + ": a finite number of at most 1e50 in size");
}

long long TextScanner::integer(std::string_view word, const char* expected) const {
    long long x = 0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), x);
    if (word.empty() || status != std::errc() || end != word.data() + word.size()) fail_word(word, expected);
    return x;
}

void ByteScanner::fail(const std::string& found, const std::string& expected) const {
    throw_input(*path_ + ": byte " + std::to_string(last_) + ": found " + found + ", expected " + expected);
}

template <class T> T ByteScanner::number(const char* expected) {
    last_ = at_;
    if (left() < sizeof(T)) fail("the end of the file", expected);
    char bytes[sizeof(T)];
    std::memcpy(bytes, bytes_.data() + at_, sizeof(T));
    if (big_endian_ != (std::endian::native == std::endian::big)) std::reverse(bytes, bytes + sizeof(T));
    at_ += sizeof(T);
    T x;
    std::memcpy(&x, bytes, sizeof(T));
    return x;
}
template std::int8_t ByteScanner::number(const char*);
template std::uint8_t ByteScanner::number(const char*);
template std::int16_t ByteScanner::number(const char*);
template std::uint16_t ByteScanner::number(const char*);
template std::int32_t ByteScanner::number(const char*);
template std::uint32_t ByteScanner::number(const char*);
template float ByteScanner::number(const char*);
template double ByteScanner::number(const char*);

double ByteScanner::coordinate(double x) const {
    if (!(std::fabs(x) <= kMostCoordinate)) fail(to_text(x), "a coordinate: a finite number of at most 1e50 in size");
    return x;
}
void ByteScanner::skip(std::size_t n, const char* expected) {
    last_ = at_;
    if (left() < n) fail("the end of the file", expected);
    at_ += n;
}

void add_polygon(MeshFile& file, const std::vector<std::uint32_t>& corners) {
    if (corners.size() > 3) ++file.polygons;
    for (std::size_t k = 2; k < corners.size(); ++k) file.mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

}  // namespace isoparm
