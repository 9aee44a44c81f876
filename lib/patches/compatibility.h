// patches/compatibility.h -- the one way in which make_* compares data that must agree.
#pragma once
#include <algorithm>
#include <string>

#include "curve.h"
#include "error.h"

namespace isoparm {

/// Positions, tangents and twists agree when they differ by at most this fraction of the data's size.
inline constexpr double compatibility_tolerance = 1e-9;

/// Largest distance, at nine samples, of a curve from its own first point.
inline double size_of(std::initializer_list<const Curve*> curves) {
    double size = 0;
    for (const Curve* c : curves)
        for (int k = 0; k <= 8; ++k) size = std::max(size, distance((*c)(c->begin()), (*c)(c->begin() + k / 8.0 * (c->end() - c->begin()))));
    return size;
}

/// Rounding of the coordinates themselves, for data far from the origin.
inline double rounding_of(const Point& a, const Point& b) { return 1e-14 * (length(a) + length(b)); }

inline void require_equal(const std::string& condition, const Point& a, const Point& b, double size) {
    const double gap = distance(a, b), tolerance = compatibility_tolerance * size + rounding_of(a, b);
    if (!(gap <= tolerance)) throw IncompatibleError(condition, gap, tolerance);
}

}  // namespace isoparm
