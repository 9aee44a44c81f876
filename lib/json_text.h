// json_text.h -- pieces of JSON output. Numbers read back as the same doubles; what does not exist is null.
#pragma once
#include <cmath>
#include <optional>
#include <string>

#include "error.h"
#include "scalar/vec.h"

namespace isoparm {

inline std::string json_text(const std::string& text) {
    static constexpr char hex[] = "0123456789abcdef";
    std::string r = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') r += '\\', r += c;
        else if (c == '\n') r += "\\n";
        else if (code < 0x20) r += std::string("\\u00") + hex[code >> 4] + hex[code & 15];
        else r += c;
    }
    return r + "\"";
}
inline std::string json_text(double x) { return std::isfinite(x) ? to_text(x) : "null"; }
inline std::string json_text(const Point& p) {
    return finite(p) ? "[" + to_text(p.x) + ", " + to_text(p.y) + ", " + to_text(p.z) + "]" : "null";
}
template <class T> std::string json_text(const std::optional<T>& x) { return x ? json_text(*x) : "null"; }

}  // namespace isoparm
