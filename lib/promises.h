// promises.h -- what the data of a surface must fulfil, and what the surface promises of them, measured.
//
// make_* throws where data contradict each other; this tells all gaps, those below the tolerance and those that a remedy (a twist option)
// takes care of, and lists the curves that the surface interpolates, so that the residual can be bounded along all of them.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "joints/edge_jump.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/gordon.h"
#include "patches/network.h"

namespace isoparm {

/// Two data that should be equal.
struct Condition {
    std::string what;
    double gap = 0, tolerance = 0;  // a condition holds when gap <= tolerance
    std::string remedy;             // what the surface does about a gap; empty: nothing, so that it could not have been built
};
/// A curve that the surface interpolates along a line of its domain, or, with derivative 1, a derivative across that line (along line.cross), or, with kNormal, a direction normal to the
/// surface, whose residual is an angle in degrees.
struct Promise {
    std::string what;
    ParameterLine line;
    Curve curve;
    int derivative = 0;
    std::size_t patch = 0;  // of the surface's patches
    double allowed = 0;     // a residual up to this is what was asked for, whatever the tolerance of the check
    std::optional<Patch> on_edge{};  // a patch that on the line has the same positions and first derivatives up to `slack`, by the surface's formula, and is easier to bound
    double slack = 0;
};
/// Both mixed derivatives at a corner of Hermite data, or where curves of a network cross.
struct TwistPair {
    Point at, of_f, of_g;  // of the derivatives across the lines u = const (f, A: x_uv), and across v = const (g, B: x_vu)
    double gap = 0, tolerance = 0;
    std::string remedy;
};
struct DataReport {
    std::vector<Condition> conditions;
    std::vector<Promise> promises;
    std::vector<std::size_t> smooth;  // patches that are C1 across the lines between their cells
    std::vector<TwistPair> twists{};  // all of them
};

DataReport examine(const CoonsCurves& curves);
DataReport examine(const HermiteData& data, Twist twist);
/// Of networks, the largest gap of each kind is a condition. `cross`: those given; none: finite differences.
DataReport examine(const Network& network, const CrossDerivatives* cross, Twist twist);
DataReport examine(const GordonNetwork& network, GordonBlend blend, const Rect& domain);
DataReport examine_triangle(const std::array<Curve, 3>& edges);
/// With cross derivatives in the direction of the medians.
DataReport examine_triangle(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& cross);
/// The same of make_nielson_c1(): on E_k the weights of the other two rays' interpolants have double zeros, so that the one of vertex k alone stands for the surface there.
DataReport examine_nielson(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& cross);
/// Of make_nielson_g1(), likewise. Conditions on normals are sines of angles.
DataReport examine_nielson_g1(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& normals);

/// How far the patch is from keeping the promise: certified bounds for the whole line. Safe to call from every thread.
JumpBound bound_residual(const Patch& patch, const Promise& promise, double tolerance);

}  // namespace isoparm
