#include "scalar/polynomial.h"

#include <algorithm>

namespace isoparm {

double binomial(int n, int k) {
    static const auto table = [] {
        std::array<std::array<double, 65>, 65> t{};
        for (int i = 0; i < 65; ++i) {
            t[i][0] = 1;
            for (int j = 1; j <= i; ++j) t[i][j] = t[i - 1][j - 1] + t[i - 1][j];
        }
        return t;
    }();
    return table[n][k];
}

void shift_taylor(const Interval* a, int degree, const Interval& d, int order, Interval* out) {
    const double r = mag(d);
    const bool symmetric = d.lo < 0 && d.hi > 0;
    for (int k = 0; k <= order; ++k) {
        out[k] = k <= degree ? a[k] : Interval(0);
        double p = 1;       // at least r^(j-k)
        Interval power(1);  // encloses d^(j-k)
        for (int j = k + 1; j <= degree; ++j) {
            if (symmetric) {  // even powers are not negative, odd ones lie in [-r^n, r^n]
                p = rounding::product_up(p, r);
                power = Interval((j - k) % 2 == 0 ? 0 : -p, p);
            } else {
                power = power * d;
            }
            out[k] = out[k] + (a[j] * power) * Interval(binomial(j, k));
        }
    }
}

void polynomial_taylor(const double* c, int degree, const Interval& t, int order, Interval* out) {
    const double m = mid(t);
    std::vector<Interval> a(c, c + degree + 1);
    for (int k = 0; k <= degree; ++k)
        for (int i = degree - 1; i >= k; --i) a[i] = a[i] + a[i + 1] * Interval(m);
    shift_taylor(a.data(), degree, t - Interval(m), order, out);
}

// polynomial_model.cpp
Polynomial model_sum(const Polynomial& a, const Polynomial& b);
Polynomial model_product(const Polynomial& a, const Polynomial& b);
Polynomial model_quotient(const Polynomial& a, const Polynomial& b);

Polynomial Polynomial::nothing() {
    Polynomial p;
    p.c_.clear();
    return p;
}

Polynomial Polynomial::variable_u(const Interval& u) {
    Polynomial p(1, 0);
    p.coefficient(0, 0) = Interval(mid(u));
    p.coefficient(1, 0) = Interval(1);
    p.x_ = Interval(-rad(u), rad(u));
    return p;
}

Polynomial Polynomial::variable_v(const Interval& v) {
    Polynomial p(0, 1);
    p.coefficient(0, 0) = Interval(mid(v));
    p.coefficient(0, 1) = Interval(1);
    p.y_ = Interval(-rad(v), rad(v));
    return p;
}

Interval Polynomial::range() const {
    Interval sum(0), px(1);
    for (int i = 0; i <= p_; ++i) {
        Interval py(1), row(0);
        for (int j = 0; j <= q_; ++j) {
            row = row + coefficient(i, j) * py;
            py = py * y_;
        }
        sum = sum + row * px;
        px = px * x_;
    }
    return model_ ? sum + Interval(-rest_.f, rest_.f) : sum;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
    if (!a.exists() || !b.exists()) return Polynomial::nothing();
    if (a.model_ || b.model_) return model_sum(a, b);
    Polynomial r(std::max(a.p_, b.p_), std::max(a.q_, b.q_));
    r.x_ = hull(a.x_, b.x_);
    r.y_ = hull(a.y_, b.y_);
    for (int i = 0; i <= a.p_; ++i)
        for (int j = 0; j <= a.q_; ++j) r.coefficient(i, j) = a.coefficient(i, j);
    for (int i = 0; i <= b.p_; ++i)
        for (int j = 0; j <= b.q_; ++j) r.coefficient(i, j) = r.coefficient(i, j) + b.coefficient(i, j);
    return r;
}

Polynomial operator-(const Polynomial& a) {
    Polynomial r = a;
    for (auto& c : r.c_) c = -c;
    return r;
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
    if (!a.exists() || !b.exists() || a.p_ + b.p_ > 64 || a.q_ + b.q_ > 64) return Polynomial::nothing();
    if (a.model_ || b.model_) return model_product(a, b);
    Polynomial r(a.p_ + b.p_, a.q_ + b.q_);
    r.x_ = hull(a.x_, b.x_);
    r.y_ = hull(a.y_, b.y_);
    for (int i = 0; i <= a.p_; ++i)
        for (int j = 0; j <= a.q_; ++j)
            for (int k = 0; k <= b.p_; ++k)
                for (int l = 0; l <= b.q_; ++l)
                    r.coefficient(i + k, j + l) = r.coefficient(i + k, j + l) + a.coefficient(i, j) * b.coefficient(k, l);
    return r;
}

Polynomial operator/(const Polynomial& a, const Polynomial& b) {
    if (!b.exists()) return Polynomial::nothing();
    if (b.model_) return a.exists() ? model_quotient(a, b) : Polynomial::nothing();
    if (b.p_ != 0 || b.q_ != 0) return Polynomial::nothing();
    if (a.model_) return a * Polynomial(Interval(1) / b.c_[0]);
    Polynomial r = a;
    for (auto& c : r.c_) c = c / b.c_[0];
    return r;
}

namespace {

/// Numbers with a bound of their errors: the sums and products of Horner's scheme at d, in plain arithmetic. Errors are sums of numbers
/// >= 0, of a few hundred operations at most: kSafe makes up for their rounding.
struct Horner {
    static constexpr double kSafe = 1 + 1e-12, kUnit = 0x1p-53;
    double d, d_error, d_size;

    explicit Horner(const Interval& step) : d(mid(step)), d_error(rad(step)), d_size(rounding::up(std::fabs(d) + d_error)) {}
    /// x + y d
    void step(double& x, double& x_error, double y, double y_error) const {
        if (y == 0 && y_error == 0) return;
        const double product = y * d, sum = x + product;
        const double rounded = (std::fabs(product) + std::fabs(sum)) * kUnit;
        x_error += y_error * d_size + std::fabs(y) * d_error + rounded + rounding::kTiny;
        x = sum;
    }
};
Interval enclosed(double x, double error) { return error == 0 ? Interval(x) : checked(rounding::down(x - error * Horner::kSafe), rounding::up(x + error * Horner::kSafe)); }

struct Split {
    std::vector<double> x, error;
    void take(const std::vector<Interval>& c) {
        x.resize(c.size()), error.resize(c.size());
        for (std::size_t i = 0; i < c.size(); ++i) x[i] = mid(c[i]), error[i] = c[i].lo == c[i].hi ? 0 : rad(c[i]);
    }
};

}  // namespace

/// The value at (dx, dy) from the centre.
Interval Polynomial::at(const Interval& dx, const Interval& dy) const {
    thread_local Split a;
    a.take(c_);
    const Horner along_x(dx), along_y(dy);
    const int stride = q_ + 1;
    for (int i = p_; i >= 0; --i) {
        double* x = &a.x[std::size_t(i * stride)];
        double* error = &a.error[std::size_t(i * stride)];
        for (int j = q_ - 1; j >= 0; --j) along_y.step(x[j], error[j], x[j + 1], error[j + 1]);
        if (i < p_) along_x.step(x[0], error[0], x[stride], error[stride]);
    }
    return enclosed(a.x[0], a.error[0]);
}

/// Coefficients about the centre moved by (dx, dy): Horner's scheme along each parameter (repeated synthetic division).
void Polynomial::recentre(const Interval& dx, const Interval& dy, std::vector<Interval>& out) const {
    thread_local Split a;
    a.take(c_);
    const Horner along_x(dx), along_y(dy);
    const int stride = q_ + 1;
    double *x = a.x.data(), *error = a.error.data();
    for (int k = 0; k < p_; ++k)
        for (int i = p_ - 1; i >= k; --i)
            for (int j = 0; j <= q_; ++j) along_x.step(x[i * stride + j], error[i * stride + j], x[(i + 1) * stride + j], error[(i + 1) * stride + j]);
    for (int i = 0; i <= p_; ++i)
        for (int k = 0; k < q_; ++k)
            for (int j = q_ - 1; j >= k; --j) along_y.step(x[i * stride + j], error[i * stride + j], x[i * stride + j + 1], error[i * stride + j + 1]);
    out.resize(c_.size());
    for (std::size_t i = 0; i < c_.size(); ++i) out[i] = enclosed(x[i], error[i]);
}

Polynomial Polynomial::moved(double centre_u, double centre_v, const Interval& u, const Interval& v) const {
    Polynomial r(p_, q_);
    recentre(Interval(mid(u)) - Interval(centre_u), Interval(mid(v)) - Interval(centre_v), r.c_);
    r.x_ = Interval(-rad(u), rad(u)), r.y_ = Interval(-rad(v), rad(v));
    return r;
}

}  // namespace isoparm
