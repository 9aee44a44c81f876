// patches/edge_series.h -- surfaces over a triangle beside one of its edges, to second order in the distance from it.
//
// Beside edge E_e, from the vertex e + 1 (t = 0) to e + 2 (t = 1), run t along it and x across, from the edge's point at t in the direction of the median: then the barycentric coordinates are
//     U = x (of the vertex e),  V = 1 - t - x/2,  W = t - x/2,      r = V + W = 1 - x,  W / r = t + (t - 1/2) (x + x^2 + ...).
// Everything is a series in x up to x^2, whose coefficients are polynomials in t: position, first and second derivatives on the inside of the edge. Where a ratio has
// U above and below, U^3 / (U + V) is O(x^3) and U^2 V / (U + V) = U^2 + O(x^3), U V^2 / (U + V) = U V - U^2 + O(x^3).
#pragma once
#include <array>
#include <functional>
#include <initializer_list>
#include <utility>
#include <vector>

#include "patch.h"

namespace isoparm {

struct Series {
    Polynomial c[3];
    Series(const Polynomial& a = 0, const Polynomial& b = 0, const Polynomial& d = 0) : c{a, b, d} {}  // NOLINT: polynomials are series
};
inline Series operator+(const Series& a, const Series& b) { return {a.c[0] + b.c[0], a.c[1] + b.c[1], a.c[2] + b.c[2]}; }
inline Series operator-(const Series& a, const Series& b) { return {a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2]}; }
inline Series operator*(const Series& a, const Series& b) {
    return {a.c[0] * b.c[0], a.c[0] * b.c[1] + a.c[1] * b.c[0], a.c[0] * b.c[2] + a.c[1] * b.c[1] + a.c[2] * b.c[0]};
}
inline Series power(const Series& x, int n) {
    Series r(1);
    for (int k = 0; k < n; ++k) r = r * x;
    return r;
}
/// sum c[k] x^k
inline Series polynomial(const double* c, int degree, const Series& x) {
    Series r(c[degree]);
    for (int k = degree - 1; k >= 0; --k) r = r * x + Series(c[k]);
    return r;
}

/// Over a part of the edge; polynomials are in t minus its middle.
struct EdgeFrame {
    Interval over{0, 1};
    Polynomial t = Polynomial::variable_u(over), rest = Polynomial(1) - t;  // of 1
    Series U{0, 1, 0}, V{rest, -0.5, 0}, W{t, -0.5, 0}, r{1, -1, 0}, inverse_r{1, 1, 1}, ratio{t, t - Polynomial(0.5), t - Polynomial(0.5)};
};

using Polynomial3 = Vec3<Polynomial>;
using Series3 = Vec3<Series>;

inline bool exists(const Polynomial3& x) { return x.x.exists() && x.y.exists() && x.z.exists(); }
/// A curve if it is one polynomial on the part.
inline Polynomial3 form_of(const Curve& c, const Interval& over = {0, 1}) { return c(Polynomial::variable_u(over)); }
/// At s, a series of numbers in that part.
inline Series3 at(const Polynomial3& curve, const Series& s, const Interval& over = {0, 1}) {
    const Series from_middle = s - Series(mid(over));
    Series3 r;
    for (int axis = 0; axis < 3; ++axis)
        for (int k = curve[axis].degree_u(); k >= 0; --k) r[axis] = r[axis] * from_middle + Series(curve[axis].coefficient(k, 0));
    return r;
}
/// The quotient of two polynomials in `variable`, the highest coefficient of `by` being 1; `of` keeps the rest.
Polynomial divided(Polynomial& of, const Polynomial& by, const Polynomial& variable);
template <class T> Series3 constant(const Vec3<T>& p) { return {Series(Polynomial(p.x)), Series(Polynomial(p.y)), Series(Polynomial(p.z))}; }

/// The surface beside an edge: value + x across + x^2 (second + extra), each over its own denominator. All but that of `extra` are positive on [0,1]; a denominator of degree 0 is 1.
struct EdgeForm {
    Polynomial3 value, across, second, extra;
    Polynomial under[4] = {1, 1, 1, 1};

    EdgeForm() = default;
    explicit EdgeForm(const Series3& s) {
        for (int axis = 0; axis < 3; ++axis) value[axis] = s[axis].c[0], across[axis] = s[axis].c[1], second[axis] = s[axis].c[2];
    }
    /// As Patch::exact_cell() gives it, with the part of the edge; empty where something is no polynomial.
    std::vector<Polynomial> list(const Interval& over) const {
        std::vector<Polynomial> all;
        for (const auto* part : {&value, &across, &second, &extra}) {
            for (int axis = 0; axis < 3; ++axis) all.push_back((*part)[axis]);
            all.push_back(under[all.size() / 4]);
        }
        for (const Polynomial& p : all)
            if (!p.exists()) return {};
        all.push_back(over);
        return all;
    }
};

/// The parts of [0,1] between the breaks of curves.
std::vector<Interval> parts_of(std::initializer_list<const Curve*> curves);
/// The patch with forms(e, k) beside part k = 0, 1, ... of its edge e, the last one empty; made when asked for.
Patch with_triangle_forms(Patch patch, std::function<std::vector<Polynomial>(int edge, std::size_t part)> forms);

}  // namespace isoparm
