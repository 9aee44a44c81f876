// patches/edge_scalar.h -- the scalar on which the formula of a surface over a rectangle yields the surface beside a line u = const or v = const, to second order.
//
// The parameter along the line stays a variable t, the other one is its value on the line plus x. Everything is a series in x up to x^2 whose coefficients are quotients of
// polynomials in t: curves that run along the line must be polynomial or rational there; of those across it, whatever they are, only the Taylor coefficients count, which are numbers.
#pragma once
#include <functional>

#include "patch_model.h"
#include "scalar/cone.h"
#include "scalar/quotient.h"

namespace isoparm {

class EdgeScalar {
public:
    Quotient c[3];  // of 1, x, x^2

    EdgeScalar(double value = 0) : EdgeScalar(Interval(value)) {}                  // NOLINT: numbers are series
    EdgeScalar(const Interval& value) : c{Quotient(Polynomial(value)), {}, {}} {}  // NOLINT
    /// t over a cell.
    static EdgeScalar along(const Interval& cell);
    /// An end of a cell plus x, which grows with the parameter.
    static EdgeScalar across(const Interval& cell, bool upper);

    /// At one of these two; at another series nothing is known. Where the line is a break, of the piece in the cell.
    Vec3<EdgeScalar> of(const Curve& curve) const;
    EdgeScalar of(const Function& f) const;
    /// Across the line, and just this number on it?
    bool is(double value) const { return kind_ == Kind::across && c[0].is_number(value); }
    /// In the cell.
    double inner() const { return mid(cell_); }

private:
    enum class Kind { other, along, across } kind_ = Kind::other;
    Interval cell_, side_;  // side_: the end of the cell that is meant, from inside
};

EdgeScalar operator+(const EdgeScalar& a, const EdgeScalar& b);
EdgeScalar operator-(const EdgeScalar& a);
EdgeScalar operator*(const EdgeScalar& a, const EdgeScalar& b);
inline EdgeScalar operator-(const EdgeScalar& a, const EdgeScalar& b) { return a + (-b); }
inline EdgeScalar square(const EdgeScalar& a) { return a * a; }
EdgeScalar polynomial(const double* c, int degree, const EdgeScalar& t);
EdgeScalar kept_in(EdgeScalar x, double low, double high);
inline double representative(const EdgeScalar& x) { return x.inner(); }
Interval base(const EdgeScalar& x);  // for its type: constants are intervals

/// Gregory's p^2 q / (p + q), p and q linear in the parameters: where p is 0 on the line it is p^2 + O(x^3), where q is 0 p q - q^2 + O(x^3). At the corner itself second derivatives do
/// not exist; these are their limits along the line.
EdgeScalar cone(const SquareOfRadius&, const GregoryRatio&, const EdgeScalar& p, const EdgeScalar& q);

using EdgeFormula = std::function<Vec3<EdgeScalar>(const EdgeScalar& u, const EdgeScalar& v)>;
/// `patch`, whose formula this is, with forms beside the edges of those of its cells that have no exact form (exact_parts.h).
Patch with_edge_forms(Patch patch, EdgeFormula formula);
/// As make_patch(), with them.
template <class F> Patch make_patch_with_edges(const F& f) {
    return with_edge_forms(make_patch(f), [f](const EdgeScalar& u, const EdgeScalar& v) { return Vec3<EdgeScalar>(f(u, v)); });
}

}  // namespace isoparm
