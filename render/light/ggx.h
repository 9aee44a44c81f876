// ggx.h -- the micro-facets of rough surfaces; directions relative to the normal, which is z.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/local_frame.h"

namespace isoparm {

/// GGX: density of micro-normals, and what part of them is seen (Walter et al. 2007).
inline double facets(const Point& h, double alpha) {
    const double a = alpha * alpha, d = h.z * h.z * (a - 1) + 1;
    return a / (std::numbers::pi * d * d);
}
inline double lambda(const Point& w, double alpha) {
    const double t = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return 0.5 * (std::sqrt(1 + alpha * alpha * t) - 1);
}
inline double seen(const Point& w, double alpha) { return 1 / (1 + lambda(w, alpha)); }

/// A micro-normal in proportion to what `out` sees of it (Heitz, JCGT 2018).
inline Point seen_facet(const Point& out, double alpha, const Vec2& s) {
    const Point v = normalized(Point{alpha * out.x, alpha * out.y, out.z});
    const double across = v.x * v.x + v.y * v.y;
    const Point t1 = across > 0 ? Point{-v.y, v.x, 0} / std::sqrt(across) : Point{1, 0, 0}, t2 = cross(v, t1);
    const Vec2 d = on_disc(s);
    const double half = 0.5 * (1 + v.z), y = (1 - half) * std::sqrt(std::max(0.0, 1 - d.x * d.x)) + half * d.y;
    const Point n = d.x * t1 + y * t2 + std::sqrt(std::max(0.0, 1 - d.x * d.x - y * y)) * v;
    return normalized(Point{alpha * n.x, alpha * n.y, std::max(1e-9, n.z)});
}

/// Width of the distribution.
inline double width_of_facets(double roughness) { return std::max(1e-3, roughness * roughness); }

}  // namespace isoparm
