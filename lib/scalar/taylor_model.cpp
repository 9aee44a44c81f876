#include "scalar/taylor_model.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

/// All values of c d^k, k > 0.
Interval with_power(const Interval& c, int k) { return k % 2 == 0 ? Interval(std::min(c.lo, 0.0), std::max(c.hi, 0.0)) : Interval(-mag(c), mag(c)); }

/// Coefficients as numbers with the errors that they may have.
struct Numbers {
    int degree;
    double x[TaylorModel::order + 1], error[TaylorModel::order + 1];
    explicit Numbers(const TaylorModel& a) : degree(a.degree()) {
        for (int k = 0; k <= degree; ++k) {
            const Interval c = a.coefficient(k);
            x[k] = mid(c), error[k] = c.lo == c.hi ? 0 : rad(c);
        }
    }
};
/// Coefficients of the product, in plain arithmetic: of x y, with |x - p| <= a and |y - q| <= b, p q is off by (|p| + a) b + a |q|, and a sum of n rounded products by n + 1 units of the sum of
/// their sizes. Errors are sums of at most 48 numbers that are not negative: kSafe makes up for their rounding, kTiny for what underflows.
struct Products {
    static constexpr int most = 2 * TaylorModel::order + 1;
    static constexpr double kSafe = 1 + 1e-12;
    double sum[most]{}, size[most]{}, error[most]{};
    Interval operator[](int k) const { return error[k] == 0 ? Interval(0) : checked(rounding::down(sum[k] - error[k]), rounding::up(sum[k] + error[k])); }

    Products(const Numbers& a, const Numbers& b) {
        for (int i = 0; i <= a.degree; ++i) {
            const double p = a.x[i], p_size = std::fabs(p), p_error = a.error[i], p_most = p_size + p_error;
            if (p_most == 0) continue;
            for (int j = 0; j <= b.degree; ++j) {
                const double q = b.x[j], q_size = std::fabs(q);
                sum[i + j] += p * q;
                size[i + j] += p_size * q_size;
                error[i + j] += p_most * b.error[j] + p_error * q_size + (q == 0 && b.error[j] == 0 ? 0 : rounding::kTiny);
            }
        }
        const double units = (std::min(a.degree, b.degree) + 3) * 0x1p-53;
        for (int k = 0; k <= a.degree + b.degree; ++k) error[k] = (error[k] + units * size[k]) * kSafe;
    }
};

}  // namespace

TaylorModel::TaylorModel(const Interval& value) {
    if (value.lo != 0 || value.hi != 0) set(0, value);
}
TaylorModel TaylorModel::linear(const Interval& middle, const Interval& slope) {
    const Interval c[] = {middle, slope};
    return polynomial(c, 1);
}
TaylorModel TaylorModel::polynomial(const Interval* c, int degree) {
    TaylorModel r;
    for (int k = 0; k <= degree; ++k)
        if (c[k].lo != 0 || c[k].hi != 0) r.set(k, c[k]);
    return r;
}

void TaylorModel::widen(const Interval& by) { rest_ = rest_ + by; }

/// An unbounded coefficient makes the rest unbounded: so there is one place to look.
void TaylorModel::set(int k, const Interval& c) {
    if (!c.bounded()) {
        rest_ = Interval::all();
        return;
    }
    while (degree_ < k) c_[std::size_t(++degree_)] = Interval(0);
    c_[std::size_t(k)] = c;
}

Interval TaylorModel::range() const {
    if (!bounded()) return Interval::all();
    Interval sum = coefficient(0) + rest_;
    for (int k = 3; k <= degree_; ++k) sum = sum + with_power(c_[std::size_t(k)], k);
    const Interval c1 = coefficient(1), c2 = coefficient(2);
    const double p = mid(c1), q = mid(c2);
    const Interval p2 = Interval(p), q2 = Interval(q);
    Interval quadratic = hull(q2 - p2, q2 + p2);
    if (std::fabs(p) <= 2 * std::fabs(q) * (1 + 1e-15) && q != 0) quadratic = hull(quadratic, -(square(p2) / (Interval(4) * q2)));  // the vertex
    const double wide = rounding::up(rad(c1) + rad(c2));
    return sum + quadratic + Interval(-wide, wide);
}

Interval TaylorModel::at(double d) const {
    if (!bounded()) return Interval::all();
    Interval sum(0);
    for (int k = degree_; k >= 0; --k) sum = sum * Interval(d) + c_[std::size_t(k)];
    return sum + rest_;
}

TaylorModel TaylorModel::restricted(double middle, double half) const {
    TaylorModel r = *this;
    for (int k = 0; k < (half == 0 ? std::min(degree_, 1) : degree_); ++k)  // repeated synthetic division
        for (int i = degree_ - 1; i >= k; --i) r.c_[std::size_t(i)] = r.c_[std::size_t(i)] + r.c_[std::size_t(i + 1)] * Interval(middle);
    if (half == 0) {
        r.degree_ = std::min(degree_, 0);
        return r;
    }
    Interval scale(1);
    for (int k = 0; k <= degree_; ++k) {
        r.c_[std::size_t(k)] = r.c_[std::size_t(k)] * scale;
        scale = scale * Interval(half);
    }
    r.trim();
    return r;
}

/// Terms that are far below the rounding of the others go to the rest: on short pieces, the higher ones.
void TaylorModel::trim() {
    double most = 0;
    for (int k = 0; k <= degree_; ++k) most = std::max(most, mag(c_[std::size_t(k)]));
    for (; degree_ > 0 && mag(c_[std::size_t(degree_)]) <= 0x1p-64 * most; --degree_) rest_ = rest_ + with_power(c_[std::size_t(degree_)], degree_);
}

TaylorModel operator+(const TaylorModel& a, const TaylorModel& b) {
    TaylorModel r;
    r.rest_ = a.rest_ + b.rest_;
    for (int k = std::max(a.degree_, b.degree_); k >= 0; --k) {
        if (k > b.degree_) r.set(k, a.c_[std::size_t(k)]);
        else if (k > a.degree_) r.set(k, b.c_[std::size_t(k)]);
        else r.set(k, a.c_[std::size_t(k)] + b.c_[std::size_t(k)]);
    }
    return r;
}

TaylorModel operator-(const TaylorModel& a) {
    TaylorModel r = a;
    for (int k = 0; k <= a.degree_; ++k) r.c_[std::size_t(k)] = -r.c_[std::size_t(k)];
    r.rest_ = -r.rest_;
    return r;
}

TaylorModel operator*(const TaylorModel& a, const TaylorModel& b) {
    TaylorModel r;
    if ((a.degree_ < 0 && a.exact()) || (b.degree_ < 0 && b.exact())) {
        if (!a.bounded() || !b.bounded()) r.rest_ = Interval::all();
        return r;
    }
    if (!a.bounded() || !b.bounded()) {
        r.rest_ = Interval::all();
        return r;
    }
    if (a.degree_ >= 0 && b.degree_ >= 0) {
        const Products product{Numbers(a), Numbers(b)};
        Interval above(0);
        for (int k = a.degree_ + b.degree_; k >= 0; --k) {
            if (k <= TaylorModel::order) r.set(k, product[k]);
            else above = above + with_power(product[k], k);
        }
        r.rest_ = r.rest_ + above;
    }
    // (p + r)(q + s) = pq + r (q + s) + p s
    if (!a.exact()) r.rest_ = r.rest_ + a.rest_ * b.range();
    if (!b.exact()) r.rest_ = r.rest_ + (a.range() - a.rest_) * b.rest_;  // a.range() - a.rest_ holds the range of p
    if (!r.exact()) r.trim();
    return r;
}

// Any polynomial q serves as the quotient: a/b - q = (a - q b)/b. That of the power series makes the rest small.
TaylorModel operator/(const TaylorModel& a, const TaylorModel& b) {
    TaylorModel r;
    const Interval divisor = b.range();
    if (!a.bounded() || !(divisor.lo > 0 || divisor.hi < 0)) {
        r.rest_ = Interval::all();
        return r;
    }
    const bool constant = b.degree_ == 0 && b.exact();
    const int most = constant ? a.degree_ : TaylorModel::order;
    if (constant) {
        for (int k = most; k >= 0; --k) r.set(k, a.c_[std::size_t(k)] / divisor);
        r.rest_ = r.rest_ + a.rest_ / divisor;
        return r;
    }
    std::array<double, TaylorModel::order + 1> q{};
    for (int k = 0; k <= most; ++k) {
        double sum = mid(a.coefficient(k));
        for (int i = 0; i < k; ++i) sum -= q[std::size_t(i)] * mid(b.coefficient(k - i));
        q[std::size_t(k)] = sum / mid(b.coefficient(0));
    }
    int last = most;
    if (!(std::fabs(q[std::size_t(most)]) <= std::fabs(q[0]) + std::fabs(q[1]))) last = std::min(most, 2);  // the series diverges
    for (int k = last; k >= 0; --k) r.set(k, Interval(q[std::size_t(k)]));
    r.rest_ = r.rest_ + (a - r * b).range() / divisor;
    return r;
}

// sqrt(a) - s = (a - s^2) / (sqrt(a) + s)
TaylorModel sqrt(const TaylorModel& a) {
    TaylorModel r;
    const Interval value = a.range();
    if (!(value.lo > 0) || !value.bounded() || !(mid(a.coefficient(0)) > 0)) {
        r.rest_ = Interval::all();
        return r;
    }
    std::array<double, TaylorModel::order + 1> s{};
    s[0] = std::sqrt(mid(a.coefficient(0)));
    for (int k = 1; k <= TaylorModel::order; ++k) {
        double sum = mid(a.coefficient(k));
        for (int i = 1; i < k; ++i) sum -= s[std::size_t(i)] * s[std::size_t(k - i)];
        s[std::size_t(k)] = sum / (2 * s[0]);
    }
    const int last = std::fabs(s[TaylorModel::order]) <= s[0] ? (a.degree_ <= 0 ? 0 : TaylorModel::order) : 2;
    for (int k = last; k >= 0; --k) r.set(k, Interval(s[std::size_t(k)]));
    const Interval sum = sqrt(value) + r.range();
    r.rest_ = sum.lo > 0 ? r.rest_ + (a - r * r).range() / sum : Interval::all();
    return r;
}

}  // namespace isoparm
