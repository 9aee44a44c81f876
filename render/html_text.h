// html_text.h -- pieces of HTML and XML.
#pragma once
#include <string>

namespace isoparm {

/// As text or in a quoted attribute. Control characters, which XML has no place for, become spaces.
inline std::string escaped(const std::string& text) {
    std::string r;
    for (const char c : text) {
        if (c == '<')
            r += "&lt;";
        else if (c == '>')
            r += "&gt;";
        else if (c == '&')
            r += "&amp;";
        else if (c == '"')
            r += "&quot;";
        else
            r += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? ' ' : c;
    }
    return r;
}

/// For data: addresses.
inline std::string base64(const std::string& bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve(bytes.size() * 4 / 3 + 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto at = [&](std::size_t k) { return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u; };
        const unsigned all = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
        text += digits[all >> 18], text += digits[all >> 12 & 63];
        text += i + 1 < bytes.size() ? digits[all >> 6 & 63] : '=';
        text += i + 2 < bytes.size() ? digits[all & 63] : '=';
    }
    return text;
}

}  // namespace isoparm
