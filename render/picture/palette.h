// palette.h -- the colours of what a scene gives none.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "scene/scene.h"

namespace isoparm {

inline double linear_from_srgb(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }
inline double srgb_from_linear(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }
/// 0 to 255.
inline int srgb_byte(double linear) { return static_cast<int>(std::lround(255 * std::clamp(srgb_from_linear(std::max(0.0, linear)), 0.0, 1.0))); }
/// How bright linear light looks: the Y of CIE 1931, white is 1.
inline double luminance(const Color& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }
inline Color linear_from_srgb(double r, double g, double b) {
    return {linear_from_srgb(r), linear_from_srgb(g), linear_from_srgb(b)};
}

/// Of the n-th surface of a picture: muted, of similar lightness, each told from its neighbours also by the
/// colour-blind.
inline Color surface_color(std::size_t n) {
    static const std::array<Color, 8> colors{linear_from_srgb(0.89, 0.58, 0.33), linear_from_srgb(0.36, 0.58, 0.76),
                                             linear_from_srgb(0.60, 0.72, 0.42), linear_from_srgb(0.80, 0.47, 0.52),
                                             linear_from_srgb(0.90, 0.76, 0.38), linear_from_srgb(0.56, 0.52, 0.74),
                                             linear_from_srgb(0.36, 0.66, 0.64), linear_from_srgb(0.66, 0.63, 0.59)};
    return colors[n % colors.size()];
}
inline Color curve_color() { return linear_from_srgb(0.17, 0.19, 0.24); }
inline Color net_color() { return linear_from_srgb(0.36, 0.38, 0.42); }
inline Color ink_color() { return linear_from_srgb(0.08, 0.08, 0.09); }  // of letters and axes
inline Color point_color() { return linear_from_srgb(0.76, 0.20, 0.16); }

/// The other side of a surface: grey with a touch of the complement, so that one look tells the sides apart.
inline Color back_color(const Color& front) {
    const double grey = luminance(front);
    const auto channel = [&](double c) { return std::clamp(1.05 * (grey - 0.15 * (c - grey)), 0.0, 1.0); };
    return {channel(front.x), channel(front.y), channel(front.z)};
}

}  // namespace isoparm
