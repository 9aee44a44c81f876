#include "scalar/quotient.h"

#include <algorithm>

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

}  // namespace

Quotient operator+(const Quotient& a, const Quotient& b) {
    if (a.is_number(0)) return b;
    if (b.is_number(0)) return a;
    if (a.under.empty() && b.under.empty()) return a.over + b.over;
    const auto more = missing(b.under, a.under);
    Quotient r(times(a.over, more) + times(b.over, missing(a.under, b.under)), a.under);
    r.under.insert(r.under.end(), more.begin(), more.end());
    return r;
}

Quotient operator*(const Quotient& a, const Quotient& b) {
    if (a.is_number(0) || b.is_number(0)) return {};
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
