#include "joints/edge_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scalar/elementary.h"

namespace isoparm {
namespace {

const Interval kUnknown{0, std::numeric_limits<double>::infinity()};

/// A number of either side, and their difference.
struct Twin {
    Interval x, y, d;
};
Twin operator+(const Twin& a, const Twin& b) { return {a.x + b.x, a.y + b.y, a.d + b.d}; }
Twin operator-(const Twin& a, const Twin& b) { return {a.x - b.x, a.y - b.y, a.d - b.d}; }
Twin operator*(const Twin& a, const Twin& b) { return {a.x * b.x, a.y * b.y, a.x * b.d + a.d * b.y}; }
Twin operator/(const Twin& a, const Twin& b) {
    const Interval q = a.y / b.y;
    return {a.x / b.x, q, (a.d - q * b.d) / b.x};
}
Twin sqrt(const Twin& a) {
    if (!(a.x.lo > 0 && a.y.lo > 0)) return {Interval::all(), Interval::all(), Interval::all()};
    const Interval x = isoparm::sqrt(a.x), y = isoparm::sqrt(a.y);
    return {x, y, a.d / (x + y)};
}
Twin twice(const Twin& a) { return a + a; }

using Twins = Vec3<Twin>;
Twins twins(const EdgeSide::Jet& x, const EdgeSide::Jet& y, int n) {
    Twins t;
    for (int axis = 0; axis < 3; ++axis) {
        const TaylorModel &a = x[axis].c[n], &b = y[axis].c[n];
        t[axis] = {a.range(), b.range(), (a - b).range()};
    }
    return t;
}
Interval length_of(const Interval& x, const Interval& y, const Interval& z) {
    const Interval squares = square(x) + square(y) + square(z);
    return squares.bounded() ? isoparm::sqrt(Interval(std::max(0.0, squares.lo), squares.hi)) : kUnknown;
}
Interval difference_of(const Twins& t) { return length_of(t.x.d, t.y.d, t.z.d); }

/// x x y = x x (y - x).
Interval angle_of(const Twins& w) {
    const auto part = [&](const Twin& a, const Twin& b) { return a.x * b.d - a.d * b.x; };
    return degrees_of(length_of(part(w.y, w.z), part(w.z, w.x), part(w.x, w.y)), w.x.x * w.x.y + w.y.x * w.y.y + w.z.x * w.z.y);
}

double degrees_up(double angle) { return std::min(180.0, (Interval(rounding::above(angle)) * (Interval(180) / rounding::pi)).hi); }
double degrees_down(double angle) { return angle <= 0 ? 0 : std::max(0.0, (Interval(rounding::below(angle)) * (Interval(180) / rounding::pi)).lo); }

}  // namespace

Interval degrees_of(const Interval& y, const Interval& x) {
    if (!y.bounded() || !x.bounded() || (y.lo == 0 && x.lo <= 0 && x.hi >= 0)) return kUnknown;
    const double most = x.lo < 0 ? std::atan2(y.lo, x.lo) : std::atan2(y.hi, x.lo), least = x.hi > 0 ? std::atan2(y.lo, x.hi) : std::atan2(y.hi, x.hi);
    return {degrees_down(least), degrees_up(most)};
}

JumpSizes estimate_jumps(const EdgeSide::Jet& x, const EdgeSide::Jet& y) {
    const Twins along = twins(x, y, 1), across = twins(x, y, 2), second = twins(x, y, 5), w = cross(along, across);
    JumpSizes s{difference_of(twins(x, y, 0)), difference_of(across), difference_of(second) * Interval(2), angle_of(w), kUnknown};
    const Twin E = dot(along, along), F = dot(along, across), ww = dot(w, w);
    const Twin L = twice(dot(twins(x, y, 3), w)), M = dot(twins(x, y, 4), w), N = twice(dot(second, w));
    const Interval jump = (((L * F - twice(M * E)) * F + N * (E * E)) / (E * ww * sqrt(ww))).d;
    if (jump.bounded()) s[kG2] = abs(jump);
    for (Interval& m : s)
        if (!(m.hi < std::numeric_limits<double>::infinity())) m = kUnknown;
    return s;
}

}  // namespace isoparm
