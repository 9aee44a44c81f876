// bound_text.h -- bounds in few digits that are bounds still.
#pragma once
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace isoparm {

/// x with `digits` significant digits (1 to 17), rounded up or down; "unknown" when it is not finite.
inline std::string bound_text(double x, int digits, bool up) {
    if (!std::isfinite(x)) return "unknown";
    const double step = std::pow(10.0, -digits) * std::fabs(x);
    char text[32];
    for (double y = x;; y += up ? step : -step) {
        std::snprintf(text, sizeof text, "%.*g", digits, y);
        const double back = std::strtod(text, nullptr);
        if (up ? back >= x : back <= x) return text;
    }
}

}  // namespace isoparm
