#include "patches/cross_data.h"

#include <cmath>
#include <optional>
#include <vector>

#include "curves/difference.h"
#include "curves/modify.h"

namespace isoparm {
namespace {

std::array<Curve, 3> over_unit(const std::array<Curve, 3>& c) { return {reparametrized(c[0], 0, 1), reparametrized(c[1], 0, 1), reparametrized(c[2], 0, 1)}; }
std::string numbered(const char* name, int k) { return name + std::to_string(k + 1); }
const char* vertex_name(int k) { return k == 0 ? "A" : k == 1 ? "B" : "C"; }

void require_continuity(const std::string& name, const Curve& c, int least, const char* expected) {
    for (const auto& b : c.breaks())
        if (b.continuity < least) throw_input("found " + name + " with a " + (b.continuity < 0 ? "jump" : "corner") + " at " + to_text(b.t) + ", expected " + expected);
}

/// A place in [0,1] where `proved` does not hold, though intervals are halved down to 1e-7; none when it holds everywhere.
template <class Proved> std::optional<double> unproved(Proved proved) {
    std::vector<Interval> open{{0, 1}};
    while (!open.empty()) {
        const Interval t = open.back();
        open.pop_back();
        if (proved(t)) continue;
        if (t.hi - t.lo < 1e-7) return mid(t);
        open.push_back({mid(t), t.hi});
        open.push_back({t.lo, mid(t)});
    }
    return std::nullopt;
}

/// Proves that c is C1, with a Lipschitz derivative: every point is inside an interval with bounded second coefficients. The intervals
/// overlap, so that a corner is not passed over where two of them meet.
void require_no_corner(const std::string& name, const Curve& c) {
    if (c.bezier()) return;  // its breaks tell
    const auto corner = unproved([&](const Interval& t) {
        const double margin = (t.hi - t.lo) / 64;
        Vec3<Interval> x[3];
        c.taylor(Interval(std::max(0.0, t.lo - margin), std::min(1.0, t.hi + margin)), 2, x);
        return x[2].x.bounded() && x[2].y.bounded() && x[2].z.bounded();
    });
    if (corner)
        throw_input("found " + name + " with a derivative that is not proved to be continuous near " + to_text(std::round(1e6 * *corner) / 1e6) +
                    ", expected one without corners, as the surface is built from its derivative");
}

/// Scaled by a power of 2 to a length of about 1, for squares of it are taken.
Curve scaled_to_unit(const Curve& c) {
    constexpr int samples = 64;
    double most = 0;
    for (int k = 0; k <= samples; ++k)
        for (int axis = 0; axis < 3; ++axis) most = std::max(most, std::fabs(c(k / double(samples))[axis]));
    const int exponent = most > 0 && std::isfinite(most) ? std::clamp(std::ilogb(most), -1000, 1000) : 0;
    return exponent == 0 ? c : linear_combination({std::ldexp(1.0, -exponent)}, {c});
}

/// Proves that c is not 0 anywhere (nor so small that squares vanish).
void require_nonzero(const std::string& name, const Curve& c) {
    const auto zero = unproved([&](const Interval& t) {
        Vec3<Interval> x;
        c.taylor(t, 0, &x);
        const auto nonzero = [](const Interval& a) { return a.lo > 1e-100 || a.hi < -1e-100; };
        return nonzero(x.x) || nonzero(x.y) || nonzero(x.z);
    });
    if (zero)
        throw_input("found " + name + " with length " + to_text(length(c(*zero))) + " at " + to_text(*zero) + ", expected a normal, which is not 0 anywhere on the edge");
}

/// |sine| of the angle by which a and b fail to be parallel, or to be at a right angle; 0 where one of them is 0.
double unparallel(const Point& a, const Point& b) { return length(cross(normalized(a), normalized(b))); }
double unnormal(const Point& a, const Point& b) { return length(b) == 0 ? 0 : std::abs(dot(normalized(a), normalized(b))); }
void require_angle(const std::string& condition, double sine) {
    if (!(sine <= compatibility_tolerance)) throw IncompatibleError(condition + " (sine of the angle)", sine, compatibility_tolerance);
}

}  // namespace

CrossData::CrossData(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& cross)
    : TriangleEdges(edges), D(over_unit(cross)), slope{derivative_curve(E[0]), derivative_curve(E[1]), derivative_curve(E[2])} {
    double tangents = size;
    for (int k = 0; k < 3; ++k) {
        require_continuity(numbered("the edge E", k), E[k], 1, "one without corners, as the surface is built from its derivative");
        require_no_corner(numbered("the edge E", k), E[k]);
        require_continuity(numbered("the cross derivative D", k), D[k], 0, "a continuous one");
        tangents = std::max({tangents, length(slope[k](0)), length(slope[k](1))});
    }
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;  // E_k runs from vertex i to vertex j
        const std::string d = numbered("D", k), e = numbered("E", k);
        require_equal(d + "(0) = -" + numbered("E", j) + "'(1) - " + e + "'(0)/2 (vertex " + vertex_name(i) + ")", D[k](0), -slope[j](1) - 0.5 * slope[k](0), tangents);
        require_equal(d + "(1) = " + numbered("E", i) + "'(0) + " + e + "'(1)/2 (vertex " + vertex_name(j) + ")", D[k](1), slope[i](0) + 0.5 * slope[k](1), tangents);
    }
}

NormalData::NormalData(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& normals) : TriangleEdges(edges), N(over_unit(normals)) {
    for (auto& n : N) n = scaled_to_unit(n);
    constexpr int samples = 16;
    for (int k = 0; k < 3; ++k) {
        const std::string n = numbered("N", k), name = numbered("the normal N", k);
        require_continuity(name, N[k], 0, "a continuous one");
        require_nonzero(name, N[k]);
        for (int s = 0; s <= samples; ++s) {
            const double t = s / double(samples);
            require_angle(n + " normal to " + numbered("E", k) + "' at " + to_text(t), unnormal(N[k](t), E[k].derivative(t)));
        }
    }
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;  // E_i ends and E_j begins at vertex k
        const std::string at = std::string(" (vertex ") + vertex_name(k) + ")";
        const Point arriving = N[i](1), leaving = N[j](0);
        require_angle(numbered("N", i) + "(1) parallel to " + numbered("N", j) + "(0)" + at, unparallel(arriving, leaving));
        require_angle(numbered("N", j) + "(0) normal to " + numbered("E", i) + "'(1)" + at, unnormal(leaving, E[i].derivative(1)));
        at_vertex[k] = normalized(arriving);
    }
}

}  // namespace isoparm
