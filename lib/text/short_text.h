// short_text.h -- numbers for people to read: few digits, and bounds that are bounds still.
#pragma once
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace isoparm {

/// x with `digits` significant digits (1 to 17), rounded to the nearest; "nan", "inf", "-inf".
inline std::string short_text(double x, int digits = 4) {
    if (std::isnan(x)) return "nan";  // printf's may have a sign
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", digits, x);
    return text;
}

/// x with `digits` significant digits (1 to 17), rounded up or down; "unknown" when it is not finite.
inline std::string bound_text(double x, int digits, bool up) {
    if (!std::isfinite(x)) return "unknown";
    const double step = std::pow(10.0, -digits) * std::fabs(x);
    for (double y = x;; y += up ? step : -step) {
        const std::string text = short_text(y, digits);
        const double back = std::strtod(text.c_str(), nullptr);
        if (up ? back >= x : back <= x) return text;
    }
}

}  // namespace isoparm
