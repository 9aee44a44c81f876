// scalar/quotient.h -- quotients of exact polynomials in one variable t: what rational curves are.
#pragma once
#include <vector>

#include "scalar/polynomial.h"

namespace isoparm {

/// The denominator stays in its factors, so that a sum of quotients with the same ones has them once. What is no such quotient has a numerator that does not exist; 0 times that is 0.
struct Quotient {
    Polynomial over;
    std::vector<Polynomial> under;

    Quotient(double value = 0) : over(value) {}                                                              // NOLINT: numbers are quotients
    Quotient(const Polynomial& p, std::vector<Polynomial> factors = {}) : over(p), under(std::move(factors)) {}  // NOLINT: and polynomials
    bool is_number() const { return over.exists() && over.degree_u() == 0 && over.degree_v() == 0 && under.empty(); }
    bool is_number(double x) const { return is_number() && over.coefficient(0, 0).lo == x && over.coefficient(0, 0).hi == x; }
};
Quotient operator+(const Quotient& a, const Quotient& b);
Quotient operator*(const Quotient& a, const Quotient& b);

/// Brings x, y and z over one denominator, which it returns, multiplied out.
Polynomial common_denominator(Vec3<Quotient>& x);

}  // namespace isoparm
