// printable_text.h -- text from outside (names of files, channels, parts) made safe to print.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace isoparm {

/// Bytes of the UTF-8 character that begins at `at`; 0: none does (overlong, a surrogate, above U+10FFFF, cut off).
inline std::size_t utf8_length(const std::string& text, std::size_t at) {
    const auto byte = [&](std::size_t k) { return at + k < text.size() ? static_cast<unsigned char>(text[at + k]) : 0u; };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    const std::size_t length = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((byte(k) & 0xc0) != 0x80) return 0;
    const unsigned second = byte(1);
    const bool bad = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) || (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
    return bad ? 0 : length;
}

/// Each character of `text` is given to `put(bytes, control)`; bytes that are no UTF-8 as U+FFFD, one for each. `control`: its number if it is a
/// control character (below U+0020, U+007F to U+009F), else -1.
template <class Put>
void for_each_character(const std::string& text, const Put& put) {
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t n = utf8_length(text, i);
        const auto code = static_cast<unsigned char>(text[i]);
        int control = -1;
        if (n == 1 && (code < 0x20 || code == 0x7f)) control = code;
        if (n == 2 && code == 0xc2 && static_cast<unsigned char>(text[i + 1]) < 0xa0) control = static_cast<unsigned char>(text[i + 1]);
        put(n == 0 ? std::string("\xef\xbf\xbd") : text.substr(i, n), control);
        i += n == 0 ? 1 : n;
    }
}

inline std::string hex_of(int byte) {
    static constexpr char digits[] = "0123456789abcdef";
    return {digits[byte >> 4 & 15], digits[byte & 15]};
}

/// UTF-8 on one line without control characters: these become \x1b and the like.
inline std::string printable(const std::string& text) {
    std::string r;
    for_each_character(text, [&](const std::string& bytes, int control) { r += control < 0 ? bytes : "\\x" + hex_of(control); });
    return r;
}

/// The beginning of a word that was found in a file, in quotation marks: ASCII, whatever the file holds.
inline std::string in_quotes(std::string_view text) {
    std::string r = "'";
    for (const char c : text.substr(0, 40)) r += c >= 32 && c < 127 ? c : '?';
    return r + (text.size() > 40 ? "...'" : "'");
}

}  // namespace isoparm
