// bound.h -- what is proved about a patch over a triangle of its domain. docs/certificates.md has the proof.
#pragma once
#include <array>

#include "patch.h"

namespace isoparm {

struct TriangleBound {
    /// At least |S(p) - L(p)| for every p of the triangle, L the linear interpolant of the exact S at its corners;
    /// rounded outward. Infinite when nothing could be proved.
    double parametric = 0;
    /// Edge (corner k, k+1) whose bisection gains most.
    int worst_edge = 0;
};

/// `corners` are parameters in the domain; `points` the positions there (used only to choose worst_edge where derivatives
/// have no bound). The triangle must not cross a break of the patch.
TriangleBound bound_triangle(const Patch& patch, const std::array<Vec2, 3>& corners, const std::array<Point, 3>& points);

/// An upper bound of max over the simplex of a l0 l1 + b l1 l2 + c l2 l0, not below 0, exact but for rounding.
double simplex_maximum(double a, double b, double c);

}  // namespace isoparm
