#include "scalar/quotient.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

bool same(const Polynomial& a, const Polynomial& b) {
    if (a.degree_u() != b.degree_u() || a.degree_v() != b.degree_v()) return false;
    for (int i = 0; i <= a.degree_u(); ++i)
        for (int j = 0; j <= a.degree_v(); ++j)
            if (a.coefficient(i, j).lo != b.coefficient(i, j).lo || a.coefficient(i, j).hi != b.coefficient(i, j).hi) return false;
    return true;
}

/// Those of `of` that `in` has not, each as often as it is there.
std::vector<Polynomial> missing(const std::vector<Polynomial>& of, std::vector<Polynomial> in) {
    std::vector<Polynomial> rest;
    for (const Polynomial& f : of) {
        const auto at = std::find_if(in.begin(), in.end(), [&](const Polynomial& g) { return same(f, g); });
        if (at == in.end()) rest.push_back(f);
        else in.erase(at);
    }
    return rest;
}

Polynomial times(Polynomial p, const std::vector<Polynomial>& factors) {
    for (const Polynomial& f : factors) p = p * f;
    return p;
}

/// Intervals round outward always. What is exact in floating point, as 2 - 2 of Hermite's polynomials at their ends, stays a number here: only 0 has no denominators.
bool is_point(const Quotient& a) { return a.is_number(a.over.exists() ? a.over.coefficient(0, 0).lo : 0); }
double value(const Quotient& a) { return a.over.coefficient(0, 0).lo; }

}  // namespace

Quotient operator+(const Quotient& a, const Quotient& b) {
    if (a.is_number(0)) return b;
    if (b.is_number(0)) return a;
    if (is_point(a) && is_point(b)) {
        const double p = value(a), q = value(b), sum = p + q, of_q = sum - p, of_p = sum - of_q;  // Knuth's error of a sum
        if (p - of_p == 0 && q - of_q == 0) return sum;
    }
    if (a.under.empty() && b.under.empty()) return a.over + b.over;
    const auto more = missing(b.under, a.under);
    Quotient r(times(a.over, more) + times(b.over, missing(a.under, b.under)), a.under);
    r.under.insert(r.under.end(), more.begin(), more.end());
    return r;
}

Quotient operator*(const Quotient& a, const Quotient& b) {
    if (a.is_number(0) || b.is_number(0)) return {};
    if (is_point(a) && is_point(b)) {
        const double product = value(a) * value(b);
        if (std::fabs(product) > 0x1p-900 && std::fma(value(a), value(b), -product) == 0) return product;
    }
    Quotient r(a.over * b.over, a.under);
    r.under.insert(r.under.end(), b.under.begin(), b.under.end());
    return r;
}

Polynomial common_denominator(Vec3<Quotient>& x) {
    std::vector<Polynomial> all;
    for (int axis = 0; axis < 3; ++axis) {
        const auto more = missing(x[axis].under, all);
        all.insert(all.end(), more.begin(), more.end());
    }
    for (int axis = 0; axis < 3; ++axis) x[axis] = Quotient(times(x[axis].over, missing(all, x[axis].under)), all);
    return times(1, all);
}

}  // namespace isoparm
