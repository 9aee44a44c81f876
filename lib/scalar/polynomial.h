// scalar/polynomial.h -- exact polynomials: univariate with known coefficients, and bivariate as a scalar of formulas.
//
// A polynomial of degree n is its own Taylor expansion of order n. So a formula that runs on Polynomial instead of a jet
// yields, when all its parts are polynomial, the surface itself: exact up to the outward rounding of the coefficients.
// What is not polynomial (a quotient, a rational curve) makes the result `!exists()`, and callers use interval jets.
//
// A formula that runs on model_u() and model_v() yields a model of the surface instead: a polynomial of degree <= 5 in each parameter and a
// bound of what is left out (Rest), whatever smooth functions it is made of. scalar/polynomial_model.cpp; docs/certificates.md, "Models", has the proofs.
#pragma once
#include <vector>

#include "scalar/jet.h"

namespace isoparm {

double binomial(int n, int k);

/// Taylor coefficients out[0..order] at t of sum c[k] t^k. Over an interval: centred form, so no dependency is lost
/// between the powers of t.
template <class T> void polynomial_taylor(const double* c, int degree, const T& t, int order, T* out) {
    constexpr int usual = 7;
    T few[usual + 1];
    std::vector<T> many;
    T* a = few;
    if (degree > usual) many.resize(static_cast<std::size_t>(degree) + 1), a = many.data();
    for (int i = 0; i <= degree; ++i) a[i] = T(c[i]);
    for (int k = 0; k <= order; ++k) {  // repeated synthetic division
        out[k] = T(0.0);
        if (k > degree) continue;
        for (int i = degree - 1; i >= k; --i) a[i] = a[i] + a[i + 1] * t;
        out[k] = a[k];
    }
}
/// Taylor coefficients over c + d (d an interval around 0) from those at c: sum_j binomial(j,k) a[j] d^(j-k).
void shift_taylor(const Interval* a, int degree, const Interval& d, int order, Interval* out);
void polynomial_taylor(const double* c, int degree, const Interval& t, int order, Interval* out);

/// sum c[k] t^k for a jet t, or a number.
template <class T, int I, int J, int N> Jet<T, I, J, N> polynomial(const double* c, int degree, const Jet<T, I, J, N>& t) {
    T a[N + 1];
    polynomial_taylor(c, degree, t.c[0], N, a);
    return compose(a, t);
}
inline double polynomial(const double* c, int degree, double t) {
    double r = c[degree];
    for (int k = degree - 1; k >= 0; --k) r = r * t + c[k];
    return r;
}

/// Polynomial in (x,y) = (u,v) - centre with interval coefficients, over the box |x| <= hx, |y| <= hy.
class Polynomial {
public:
    /// At least the absolute values of a function of (u,v) and of its derivatives over the box.
    struct Rest {
        double f = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;
    };
    Polynomial(double value = 0) : p_(0), q_(0), c_{Interval(value)} {}  // NOLINT: numbers are polynomials
    Polynomial(const Interval& value) : p_(0), q_(0), c_{value} {}       // NOLINT
    static Polynomial variable_u(const Interval& u);
    static Polynomial variable_v(const Interval& v);
    static Polynomial nothing();
    /// The variables as models: what is made of one is a model too. Half the width of the box is from 1e-20 to 1e6.
    static Polynomial model_u(const Interval& u);
    static Polynomial model_v(const Interval& v);
    bool is_model() const { return model_; }
    /// Of what differs from the polynomial by this, the function itself: all 0 but for models.
    const Rest& rest() const { return rest_; }
    /// f(x) for a model x inside f's domain, f smooth on an interval that holds x's range and `at`: Taylor coefficients f[0..n-1] at `at`, f[n] over all of the interval.
    static Polynomial composed(const Interval* f, int n, const Polynomial& x, double at);

    bool exists() const { return !c_.empty(); }
    int degree_u() const { return p_; }
    int degree_v() const { return q_; }
    const Interval& coefficient(int i, int j) const { return c_[i * (q_ + 1) + j]; }
    Interval& coefficient(int i, int j) { return c_[i * (q_ + 1) + j]; }
    /// Encloses all values over the box.
    Interval range() const;
    /// The same function, no model, centred in the middle of the box (u,v); it was centred in (centre_u, centre_v).
    Polynomial moved(double centre_u, double centre_v, const Interval& u, const Interval& v) const;

    friend Polynomial operator+(const Polynomial& a, const Polynomial& b);
    friend Polynomial operator-(const Polynomial& a);
    friend Polynomial operator*(const Polynomial& a, const Polynomial& b);
    /// Of models, where the denominator has no zero; of exact polynomials by numbers only.
    friend Polynomial operator/(const Polynomial& a, const Polynomial& b);

    /// Taylor coefficients of order N over the box (u,v); exact ranges up to rounding of the centred form.
    template <int N> void jets(double centre_u, double centre_v, const Interval& u, const Interval& v,
                               JetUV<Interval, 2>* at_centre, JetUV<Interval, N>* over) const;

private:
    friend struct ModelArithmetic;
    Polynomial(int p, int q) : p_(p), q_(q), c_(static_cast<std::size_t>((p + 1) * (q + 1))) {}
    Interval at(const Interval& dx, const Interval& dy) const;
    void recentre(const Interval& dx, const Interval& dy, std::vector<Interval>& out) const;
    int p_, q_;
    std::vector<Interval> c_;
    Interval x_{0}, y_{0};  // the box, around 0
    bool model_ = false;    // coefficients are numbers
    Rest rest_;
};

/// Of models that stay in the domain of these functions, and of numbers; nothing() otherwise.
Polynomial sin(const Polynomial& x);
Polynomial cos(const Polynomial& x);
Polynomial exp(const Polynomial& x);
Polynomial log(const Polynomial& x);
Polynomial sqrt(const Polynomial& x);
Polynomial pow(const Polynomial& x, double p);

inline Polynomial operator-(const Polynomial& a, const Polynomial& b) { return a + (-b); }
inline Polynomial square(const Polynomial& a) { return a * a; }
inline Polynomial polynomial(const double* c, int degree, const Polynomial& t) {
    Polynomial r(c[degree]);
    for (int k = degree - 1; k >= 0; --k) r = r * t + Polynomial(c[k]);
    return r;
}

template <int N>
void Polynomial::jets(double centre_u, double centre_v, const Interval& u, const Interval& v, JetUV<Interval, 2>* at_centre,
                      JetUV<Interval, N>* over) const {
    const double mu = mid(u), mv = mid(v);
    if constexpr (N == 0)
        if (over && !at_centre && u.lo == u.hi && v.lo == v.hi) {
            over->c[0] = at(Interval(mu) - Interval(centre_u), Interval(mv) - Interval(centre_v));
            return;
        }
    thread_local std::vector<Interval> a;
    recentre(Interval(mu) - Interval(centre_u), Interval(mv) - Interval(centre_v), a);
    const int stride = q_ + 1;
    if (at_centre)
        for (int k = 0; k < at_centre->size; ++k) {
            const auto [i, j] = JetUV<Interval, 2>::powers[k];
            at_centre->c[k] = i <= p_ && j <= q_ ? a[i * stride + j] : Interval(0);
        }
    if (!over) return;
    const double ru = rad(u), rv = rad(v);
    const auto power = [](double p, double r) { return r > 0 && p > 0 ? std::max(p * r, rounding::kTiny) : 0; };
    // sum over a >= i, b >= j of binomial(a,i) binomial(b,j) c_ab dx^(a-i) dy^(b-j), powers at most pu and pv; even ones are
    // not negative. Times an interval around 0, or from 0, only the magnitude counts, or the signs of c_ab.
    for (int k = 0; k < over->size; ++k) {
        const auto [i, j] = JetUV<Interval, N>::powers[k];
        if (i > p_ || j > q_) {
            over->c[k] = Interval(0);
            continue;
        }
        const Interval first = a[i * stride + j];
        double lo = 0, hi = 0, terms = 0, pu = 1;  // the rest: sums of numbers <= 0 and >= 0
        for (int s = i; s <= p_; ++s) {
            const bool even_u = (s - i) % 2 == 0;
            double pv = pu;
            for (int t = j; t <= q_; ++t) {
                const Interval& c = a[s * stride + t];
                if ((s != i || t != j) && pv > 0 && (c.lo != 0 || c.hi != 0)) {
                    const double m = pv * (binomial(s, i) * binomial(t, j));
                    if (even_u && (t - j) % 2 == 0) {
                        lo += m * std::min(0.0, c.lo), hi += m * std::max(0.0, c.hi);
                    } else {
                        const double x = m * mag(c);
                        lo -= x, hi += x;
                    }
                    terms += 1;
                }
                pv = power(pv, rv);
            }
            pu = power(pu, ru);
        }
        // Every term is at most p + q + 4 products of one sign, the sum `terms` additions of one sign: relative errors add up.
        const double widen = 1 + (terms + p_ + q_ + 8) * 0x1p-52, tiny = (terms + 1) * rounding::kTiny;
        over->c[k] = terms > 0 ? first + checked(lo * widen - tiny, hi * widen + tiny) : first;
    }
}

/// A number known to lie in x, for a formula that runs on S: x itself where S keeps enclosures, its middle elsewhere.
template <class S> auto constant_for(const Interval& x) {
    if constexpr (std::is_same_v<S, Polynomial>) return Polynomial(x);
    else if constexpr (std::is_same_v<std::remove_cvref_t<decltype(base(std::declval<S>()))>, Interval>) return x;
    else return mid(x);
}

}  // namespace isoparm
