// scalar/taylor_model.h -- a function of one variable d in [-1,1] as a polynomial and an interval that holds the rest.
//
// f(d) = sum c[k] d^k + rest, the rest another number for every d. Sums and differences of two models cancel coefficient by coefficient,
// so that a small difference of two large functions is enclosed as sharply as rounding allows: what an interval of values cannot do.
// Terms above the order go to the rest; over a piece half as long they are 2^-16 of it. (Makino and Berz, IJPAM 4, 2003.)
// Coefficients are intervals, rounded outward. What has no bound shows as Interval::all() in the rest.
#pragma once
#include <array>

#include "scalar/interval.h"

namespace isoparm {

class TaylorModel {
public:
    static constexpr int order = 15;

    TaylorModel(double value = 0) : TaylorModel(Interval(value)) {}  // NOLINT: numbers are models
    TaylorModel(const Interval& value);                              // NOLINT
    static TaylorModel linear(const Interval& middle, const Interval& slope);
    /// The polynomial with these coefficients, at most order + 1.
    static TaylorModel polynomial(const Interval* c, int degree);

    int degree() const { return degree_; }  // -1: the polynomial is 0
    Interval coefficient(int k) const { return k <= degree_ ? c_[std::size_t(k)] : Interval(0); }
    const Interval& rest() const { return rest_; }
    bool exact() const { return rest_.lo == 0 && rest_.hi == 0; }
    bool bounded() const { return rest_.bounded(); }
    void widen(const Interval& by);

    /// Encloses all values; exact up to rounding for polynomials of second degree.
    Interval range() const;
    Interval at(double d) const;
    /// The model of f(middle + half d); [middle - half, middle + half] lies in [-1,1] (up to rounding, which is not asked for where the rest is 0).
    TaylorModel restricted(double middle, double half) const;

    friend TaylorModel operator+(const TaylorModel& a, const TaylorModel& b);
    friend TaylorModel operator-(const TaylorModel& a);
    friend TaylorModel operator*(const TaylorModel& a, const TaylorModel& b);
    friend TaylorModel operator/(const TaylorModel& a, const TaylorModel& b);
    /// Of a function that is positive; else unbounded.
    friend TaylorModel sqrt(const TaylorModel& a);

private:
    void set(int k, const Interval& c);
    void trim();
    std::array<Interval, order + 1> c_;
    int degree_ = -1;
    Interval rest_{0};
};

inline TaylorModel operator-(const TaylorModel& a, const TaylorModel& b) { return a + (-b); }

}  // namespace isoparm
