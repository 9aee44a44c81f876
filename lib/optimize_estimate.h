// optimize_estimate.h -- what optimize() expects of a triangle before it is proved; internal to optimize*.cpp.
#pragma once
#include "bound_cell.h"

namespace isoparm {

/// The corners of a triangle that may come to be, and their largest slack.
struct Places {
    std::array<Vec2, 3> uv;
    std::array<Point, 3> x;
    double slack = 0;

    CornerData corners() const { return {uv, x, slack}; }
};

/// TriangleBound without its rounding, in tolerances (but for the normal), slack included.
struct Estimate {
    double parametric = 0;  // what counts where it is not quiet
    double normal = 0;
    std::array<double, 3> beside{}, across{};
    Point unit;
    bool quiet = false;

    double least() const { return quiet ? normal : parametric; }
    /// With the neighbour over edge k, nullptr where it does not count, as in geometric_bound(), but that the surface along the edge is as
    /// far from the one plane as from the other.
    double beyond(int k, const Estimate* other) const;
    /// With all three.
    double with(const std::array<const Estimate*, 3>& neighbours) const;
};

/// The normal, the parts across and whether it is quiet, in lengths, from a model that need not hold the triangle: what finer cells would tell.
Estimate estimate(const SecondDerivatives& model, const Places& places);

}  // namespace isoparm
