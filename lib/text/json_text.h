// json_text.h -- pieces of JSON output. Numbers read back as the same doubles; what does not exist is null.
#pragma once
#include <cmath>
#include <optional>
#include <string>

#include "error.h"
#include "scalar/vec.h"
#include "text/printable_text.h"

namespace isoparm {

/// Always UTF-8: bytes that are none become U+FFFD.
inline std::string json_text(const std::string& text) {
    std::string r = "\"";
    for_each_character(text, [&](const std::string& bytes, int control) {
        if (bytes == "\"" || bytes == "\\") r += "\\" + bytes;
        else if (control == '\n') r += "\\n";
        else if (control >= 0) r += "\\u00" + hex_of(control);
        else r += bytes;
    });
    return r + "\"";
}
inline std::string json_text(double x) { return std::isfinite(x) ? to_text(x) : "null"; }
inline std::string json_text(const Point& p) {
    return finite(p) ? "[" + to_text(p.x) + ", " + to_text(p.y) + ", " + to_text(p.z) + "]" : "null";
}
template <class T> std::string json_text(const std::optional<T>& x) { return x ? json_text(*x) : "null"; }

/// An array of what f makes of each element, one a line.
template <class List, class F> std::string json_list(const List& list, const F& f) {
    std::string text;
    for (const auto& x : list) text += (text.empty() ? "\n  " : ",\n  ") + f(x);
    return "[" + text + "]";
}

}  // namespace isoparm
