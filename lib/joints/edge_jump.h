// edge_jump.h -- how much a surface jumps across an edge: certified bounds over the whole edge.
//
// Both sides run along the edge in step (s of one is s of the other, or a function of it), and their directions across continue each other.
// Then, with x and y the two sides, derivatives by the parameter across and x_s along:
//   c0  |x - y|,  c1  |x_c - y_c|,  c2  |x_cc - y_cc|                   lengths, scene units
//   g1  the angle between x_s x x_c and y_s x y_c                       degrees, 0 to 180
//   g2  the difference of the normal curvatures in the direction at a right angle to the edge in each tangent plane, 1/scene units
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "joints/edge_estimate.h"

namespace isoparm {

/// The largest jump along an edge lies in [lower, upper]; upper is infinite where nothing is proved.
struct JumpBound {
    double lower = 0, upper = 0;
    Vec2 at;                     // where lower was found, or, when it is 0, where the bound is worst; parameters of side a
    std::vector<Vec2> singular;  // ends of the edge next to which (2^-12 of its length) nothing has a bound: then upper is infinite,
    double inside = 0;           // and the bound on the rest is this; else it is upper
};

inline constexpr double kTip = 0x1p-12;  // of the length of an edge: next to a singular end, where nothing is known

inline constexpr int kNormal = 2;

/// A part of an edge within one cell of either side.
struct EdgeSegment {
    EdgeSide a, b;
    /// s of b, of s of a, where the two do not run in step: as a model over [middle - half, middle + half].
    std::function<TaylorModel(double middle, double half)> matched;
    /// Then, at most the distance of the point of a at s from all of the edge of b: the lower bound of c0.
    std::function<double(double s)> distance;
    /// What a is compared with instead of b, if anything: its position, or with derivative 1 its derivative across, against this curve (c0 alone). With kNormal c0 is an angle, in degrees, 0 to
    /// 90: of the normal with this direction or the opposite one.
    std::function<Vec3<TaylorModel>(double middle, double half)> curve;
    int derivative = 0;
    /// Next to an extraordinary vertex (2^-12 of the edge), where derivatives have no bound: its parameters on side a. Positions alone are compared.
    std::optional<Vec2> singular;
};

struct JumpLimits {
    std::array<double, kMeasures> tolerance{};  // 0: none; below a hundredth of it, no bound is made sharper
    double relative = 0.01;                     // nor when upper - lower is less than this fraction of upper
    int max_halvings = 4000;                     // of pieces, for the sake of one measure: the budget; what is left is a wider interval
};

/// Segments in order along the edge. Deterministic.
std::array<JumpBound, kMeasures> bound_jumps(const std::vector<EdgeSegment>& segments, const JumpLimits& limits);

}  // namespace isoparm
