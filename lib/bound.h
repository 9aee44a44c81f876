// bound.h -- what is proved about a patch over a triangle of its domain. docs/certificates.md has the proofs.
#pragma once
#include <array>
#include <limits>
#include <vector>

#include "patch.h"

namespace isoparm {

/// Which distance is proved: of points at equal parameters, or between the two sets, both ways.
enum class Measure { parametric, geometric };

/// At least the distance of x from the exact S(p).
double slack_of(const Patch& patch, const Vec2& p, const Point& x);

/// Does the segment lie along one of the lines u = us[i] or v = vs[j]? Both lists are sorted.
bool along_line(const Vec2& a, const Vec2& b, const std::vector<double>& us, const std::vector<double>& vs);

/// The box of a triangle of the domain.
Box box_of(const std::array<Vec2, 3>& corners);

struct CornerData {
    std::array<Vec2, 3> uv;       // parameters in the domain, counter-clockwise or all clockwise
    std::array<Point, 3> points;  // mesh vertices
    double slack = 0;             // at least the distance of each from S at its parameters
};

/// L is the linear interpolant of the exact S at the corners, d = S - L, n the unit normal of L.
struct TriangleBound {
    static constexpr double none = std::numeric_limits<double>::infinity();
    static constexpr double unasked = -1;  // as a limit of turn: it is not bounded at all

    double parametric = none;            // at least |d| everywhere; infinite when nothing could be proved
    double normal = none;                // at least |n.d| everywhere; infinite for triangles that are not quiet
    std::array<double, 3> beside{none, none, none};  // at least |n.d| where S may lie over the plane beyond edge k, and on that edge
    std::array<double, 3> across{};      // at least |(n x e_k).d| on edge k, e_k its direction
    Point unit;                          // n up to tilt
    double tilt = none;
    double turn = none;                  // at least the tangent of the angle between unit and the normal of S, anywhere; geometric measure only, where asked for
    bool quiet = false;                  // S bends so little that it lies over L as a graph, and lenses around its edges do not meet
    int worst_edge = 0;                  // edge (corner k, k+1) whose bisection gains most
    int worst_turn = 0;                  // the same for turn
    int worst_across = 0;                // the same for the part of d along the triangle's plane

    /// What has to be small for the measure.
    double own(Measure measure) const { return measure == Measure::geometric && quiet ? std::min(parametric, normal) : parametric; }
};

/// By an enclosure over the triangle's own box: parametric only. The triangle must not cross a break of the patch.
TriangleBound bound_triangle(const Patch& patch, const std::array<Vec2, 3>& corners, const std::array<Point, 3>& points);

/// The triangle of the same patch on the other side of an edge, and as which of its own edges it has it.
struct Neighbour {
    const TriangleBound* bound = nullptr;  // none: the edge is open, or another patch lies behind it
    int edge = 0;
};

/// The geometric bound of a triangle from its own numbers and those of the neighbours over edge k.
double geometric_bound(const TriangleBound& t, const std::array<Neighbour, 3>& neighbours);

/// 1/3 rounded up: a product by it is at least the third, up to the product's own rounding.
inline constexpr double kThird = 0x1.5555555555556p-2;

/// An upper bound of max over the simplex of a l0 l1 + b l1 l2 + c l2 l0, not below 0, exact but for rounding.
double simplex_maximum(double a, double b, double c);

}  // namespace isoparm
