// shapes.h -- surfaces that tests know by heart.
#pragma once
#include <cmath>
#include <string>

#include "composite.h"
#include "patches/tensor_bezier.h"
#include "patches/transformed.h"

namespace isoparm::tests {

/// An eighth of the unit sphere; the edge u = 0 is its pole (0,0,1).
inline Patch octant() {
    const double s = std::sqrt(0.5);
    return make_bezier_patch({{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
                             {{1, s, 1}, {s, 0.5, s}, {1, s, 1}});
}

inline Composite sphere() {
    Composite c;
    for (int k = 0; k < 8; ++k)
        c.push_back({"octant" + std::to_string(k), transformed(octant(), Transform::scale({k & 1 ? -1.0 : 1.0, k & 2 ? -1.0 : 1.0, k & 4 ? -1.0 : 1.0}))});
    return c;
}

}  // namespace isoparm::tests
