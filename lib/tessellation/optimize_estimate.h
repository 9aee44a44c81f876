// optimize_estimate.h -- what optimize() expects of triangles before they are proved; internal to optimize*.cpp.
#pragma once
#include "batch.h"
#include "bounds/bound_cell.h"

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

/// Triangles that may come to be, each with a model that need not hold it, by lanes; those beyond the ones asked for may hold any.
struct EstimateLanes {
    static constexpr int size = 8;
    alignas(64) double u[3][size]{}, v[3][size]{}, x[3][3][size]{}, slack[size]{};
    double model_u[size]{}, model_v[size]{}, h[3][3][size]{}, t[4][3][size]{}, t_least[4][size]{};  // t_least: sizes of third derivatives somewhere

    void set(std::size_t lane, const SecondDerivatives& model, const Places& places);
};

/// Of the first n triangles, by the geometric measure, what finer cells would tell: whether they are quiet, and all else but `parametric` of those that are.
/// The same for every instruction set.
void estimate_lanes(const EstimateLanes& lanes, int n, double tolerance, Estimate* estimates);
/// With the loops of one instruction set, which must run here.
void estimate_lanes(Isa isa, const EstimateLanes& lanes, int n, double tolerance, Estimate* estimates);

}  // namespace isoparm
