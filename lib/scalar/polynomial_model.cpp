// polynomial_model.cpp -- Polynomial as a model: a polynomial of low degree with numbers as coefficients, and bounds of what a function and its derivatives
// to second order differ from it. docs/certificates.md, "Models", has the proofs. (Makino and Berz, IJPAM 4, 2003, for values alone.)
#include <algorithm>
#include <array>
#include <cmath>

#include "scalar/elementary.h"
#include "scalar/polynomial.h"
#include "scalar/safe.h"

namespace isoparm {

/// A function f = polynomial + difference over |x| <= hx, |y| <= hy, the difference and its derivatives as small as `rest` says.
struct ModelArithmetic {
    using Rest = Polynomial::Rest;
    static constexpr int degree = 5, stride = degree + 1, wide = 2 * degree + 1;
    /// Half-widths in this range: no power in here overflows, or underflows by more than kUnderflow allows for.
    static constexpr double least_width = 1e-20, most_width = 1e6;
    /// No sum in here has more than 2 * 36 rounded terms.
    static constexpr double rounded = 128 * 0x1p-53;

    int p = 0, q = 0;  // degrees
    std::array<double, std::size_t(stride* stride)> c{};
    Rest rest;
    Interval x{0}, y{0};

    double& at(int i, int j) { return c[std::size_t(i * stride + j)]; }
    double at(int i, int j) const { return c[std::size_t(i * stride + j)]; }

    struct Powers {
        double x[wide], y[wide];
        Powers(double hx, double hy) {
            x[0] = y[0] = 1;
            for (int k = 1; k < wide; ++k) x[k] = x[k - 1] * hx, y[k] = y[k - 1] * hy;
        }
    };
    Powers powers() const { return {x.hi, y.hi}; }

    /// To the bounds, those of c x^i y^j.
    static void add(Rest& r, int i, int j, double size, const Powers& h) {
        if (size == 0) return;
        r.f += size * h.x[i] * h.y[j];
        if (i > 0) r.u += i * size * h.x[i - 1] * h.y[j];
        if (j > 0) r.v += j * size * h.x[i] * h.y[j - 1];
        if (i > 1) r.uu += i * (i - 1) * size * h.x[i - 2] * h.y[j];
        if (i > 0 && j > 0) r.uv += i * j * size * h.x[i - 1] * h.y[j - 1];
        if (j > 1) r.vv += j * (j - 1) * size * h.x[i] * h.y[j - 2];
    }
    /// Of the polynomial alone.
    Rest sizes(const Powers& h) const {
        Rest r;
        for (int i = 0; i <= p; ++i)
            for (int j = 0; j <= q; ++j) add(r, i, j, std::fabs(at(i, j)), h);
        return r;
    }
    static Rest sum(const Rest& a, const Rest& b) { return {a.f + b.f, a.u + b.u, a.v + b.v, a.uu + b.uu, a.uv + b.uv, a.vv + b.vv}; }
    static Rest times(const Rest& a, double s) { return {a.f * s, a.u * s, a.v * s, a.uu * s, a.uv * s, a.vv * s}; }
    /// Leibniz.
    static Rest product(const Rest& a, const Rest& b) {
        return {a.f * b.f,
                a.u * b.f + a.f * b.u,
                a.v * b.f + a.f * b.v,
                a.uu * b.f + 2 * a.u * b.u + a.f * b.uu,
                a.uv * b.f + a.u * b.v + a.v * b.u + a.f * b.uv,
                a.vv * b.f + 2 * a.v * b.v + a.f * b.vv};
    }
    static bool zero(const Rest& r) { return r.f == 0 && r.u == 0 && r.v == 0 && r.uu == 0 && r.uv == 0 && r.vv == 0; }

    ModelArithmetic() = default;
    /// Of a model, or of a number; false where there is none.
    bool take(const Polynomial& a) {
        if (!a.exists() || a.p_ > degree || a.q_ > degree) return false;
        p = a.p_, q = a.q_, rest = a.rest_, x = a.x_, y = a.y_;
        const Powers h = powers();
        for (int i = 0; i <= p; ++i)
            for (int j = 0; j <= q; ++j) {
                const Interval& k = a.coefficient(i, j);
                at(i, j) = mid(k);
                if (k.lo != k.hi) add(rest, i, j, rad(k), h);
            }
        return true;
    }
    Polynomial finished() const {
        double all = rest.f + rest.u + rest.v + rest.uu + rest.uv + rest.vv;
        for (const double k : c) all += std::fabs(k);
        if (!(all < kLargestDerivative)) return Polynomial::nothing();
        Polynomial r(p, q);
        for (int i = 0; i <= p; ++i)
            for (int j = 0; j <= q; ++j) r.coefficient(i, j) = Interval(at(i, j));
        r.x_ = x, r.y_ = y, r.model_ = true;
        r.rest_ = {safe(rest.f), safe(rest.u), safe(rest.v), safe(rest.uu), safe(rest.uv), safe(rest.vv)};
        return r;
    }
    static Polynomial variable(const Interval& t, bool is_u) {
        const double half = rad(t);
        if (!(half >= least_width && half <= most_width)) return Polynomial::nothing();
        Polynomial r = is_u ? Polynomial::variable_u(t) : Polynomial::variable_v(t);
        r.model_ = true;
        return r;
    }
    static bool both(const Polynomial& a, const Polynomial& b, ModelArithmetic& x, ModelArithmetic& y) {
        if (!x.take(a) || !y.take(b)) return false;
        x.x = y.x = hull(x.x, y.x), x.y = y.y = hull(x.y, y.y);
        return true;
    }

    static Polynomial sum(const Polynomial& a, const Polynomial& b) {
        ModelArithmetic s, t;
        if (!both(a, b, s, t)) return Polynomial::nothing();
        s.p = std::max(s.p, t.p), s.q = std::max(s.q, t.q);
        for (std::size_t k = 0; k < s.c.size(); ++k) s.c[k] += t.c[k];
        s.rest = sum(sum(s.rest, t.rest), times(s.sizes(s.powers()), 0x1p-52));  // each coefficient is rounded once
        return s.finished();
    }

    /// (A + a)(B + b) = AB + A b + B a + a b; what is of too high degree in AB, and the rounding of all of it, joins the rest.
    static Polynomial product(const Polynomial& a, const Polynomial& b) {
        ModelArithmetic s, t, r;
        if (!both(a, b, s, t)) return Polynomial::nothing();
        const Powers h = s.powers();
        const Rest A = s.sizes(h), B = t.sizes(h);
        double full[wide][wide];
        multiply(s, t, full);
        r.p = std::min(s.p + t.p, degree), r.q = std::min(s.q + t.q, degree), r.x = s.x, r.y = s.y;
        r.rest = times(product(A, B), rounded);
        if (!zero(t.rest)) r.rest = sum(r.rest, product(sum(A, s.rest), t.rest));
        if (!zero(s.rest)) r.rest = sum(r.rest, product(B, s.rest));
        for (int i = 0; i <= s.p + t.p; ++i)
            for (int j = 0; j <= s.q + t.q; ++j) {
                if (i <= degree && j <= degree) r.at(i, j) = full[i][j];
                else add(r.rest, i, j, std::fabs(full[i][j]), h);
            }
        return r.finished();
    }
    static void multiply(const ModelArithmetic& s, const ModelArithmetic& t, double (&full)[wide][wide]) {
        for (int i = 0; i <= s.p + t.p; ++i) std::fill_n(full[i], s.q + t.q + 1, 0.0);
        for (int i = 0; i <= s.p; ++i)
            for (int j = 0; j <= s.q; ++j) {
                const double k = s.at(i, j);
                if (k == 0) continue;
                for (int m = 0; m <= t.p; ++m)
                    for (int n = 0; n <= t.q; ++n) full[i + m][j + n] += k * t.at(m, n);
            }
    }

    /// Any polynomial Q serves: D = a/b - Q is (a - Q b)/b =: R/b. That of the power series makes R small. Differentiate R = D b.
    static Polynomial quotient(const Polynomial& a, const Polynomial& b) {
        ModelArithmetic s, t, r;
        if (!both(a, b, s, t)) return Polynomial::nothing();
        const Powers h = s.powers();
        const Rest A = s.sizes(h), B = t.sizes(h), all = sum(B, t.rest);
        const double first = std::fabs(t.at(0, 0)), least = (first - safe(all.f - first)) * (1 - 1e-12) - 1e-12 * safe(all.f);
        if (!(least > 1e-3 * first) || !(least > 1e-60)) return Polynomial::nothing();
        r.p = s.p == 0 && t.p == 0 ? 0 : degree, r.q = s.q == 0 && t.q == 0 ? 0 : degree, r.x = s.x, r.y = s.y;
        for (int i = 0; i <= r.p; ++i)
            for (int j = 0; j <= r.q; ++j) {
                double value = i <= s.p && j <= s.q ? s.at(i, j) : 0;
                for (int m = 0; m <= std::min(i, t.p); ++m)
                    for (int n = m == 0 ? 1 : 0; n <= std::min(j, t.q); ++n) value -= t.at(m, n) * r.at(i - m, j - n);
                r.at(i, j) = value / t.at(0, 0);
            }
        const Rest Q = r.sizes(h);
        double full[wide][wide];
        multiply(r, t, full);
        Rest R = sum(s.rest, times(sum(A, product(Q, B)), rounded));
        if (!zero(t.rest)) R = sum(R, product(Q, t.rest));
        for (int i = 0; i <= r.p + t.p; ++i)
            for (int j = 0; j <= r.q + t.q; ++j) add(R, i, j, std::fabs((i <= s.p && j <= s.q ? s.at(i, j) : 0) - full[i][j]), h);
        const double each = 1 / least * (1 + 1e-15);
        const double d = R.f * each, u = (R.u + d * all.u) * each, v = (R.v + d * all.v) * each;
        r.rest = {d, u, v, (R.uu + 2 * u * all.u + d * all.uu) * each, (R.uv + u * all.v + v * all.u + d * all.uv) * each, (R.vv + 2 * v * all.v + d * all.vv) * each};
        return r.finished();
    }

    /// f(at + d) = f_0 + ... + f_(n-1) d^(n-1) + m d^n + g(d), m the middle of the n-th coefficient's range: |g^(k)(d)| <= rad n!/(n-k)! |d|^(n-k).
    static Polynomial composed(const Interval* f, int n, const Polynomial& x, double centre) {
        const Polynomial d = x - Polynomial(centre);
        ModelArithmetic t, r;
        for (int k = 0; k <= n; ++k)
            if (!f[k].bounded()) return Polynomial::nothing();
        if (!t.take(d)) return Polynomial::nothing();
        Polynomial s(mid(f[n]));
        for (int k = n - 1; k >= 0; --k) s = s * d + Polynomial(f[k]);
        if (!r.take(s)) return s;
        const Rest D = sum(t.sizes(t.powers()), t.rest);
        double g2 = f[n].lo == f[n].hi ? 0 : rad(f[n]);
        for (int k = 2; k < n; ++k) g2 *= D.f;
        const double g1 = n * g2 * D.f, g0 = g2 * D.f * D.f;
        g2 *= n * (n - 1);
        r.rest = sum(r.rest, {g0, g1 * D.u, g1 * D.v, g2 * D.u * D.u + g1 * D.uu, g2 * D.u * D.v + g1 * D.uv, g2 * D.v * D.v + g1 * D.vv});
        return r.finished();
    }
};

Polynomial Polynomial::model_u(const Interval& u) { return ModelArithmetic::variable(u, true); }
Polynomial Polynomial::model_v(const Interval& v) { return ModelArithmetic::variable(v, false); }
Polynomial Polynomial::composed(const Interval* f, int n, const Polynomial& x, double at) { return ModelArithmetic::composed(f, n, x, at); }
Polynomial model_sum(const Polynomial& a, const Polynomial& b) { return ModelArithmetic::sum(a, b); }
Polynomial model_product(const Polynomial& a, const Polynomial& b) { return ModelArithmetic::product(a, b); }
Polynomial model_quotient(const Polynomial& a, const Polynomial& b) { return ModelArithmetic::quotient(a, b); }

namespace {

constexpr int kOrder = 8;
using Series = std::array<Interval, kOrder + 1>;

bool is_number(const Polynomial& x) { return x.exists() && !x.is_model() && x.degree_u() == 0 && x.degree_v() == 0; }

/// series(t): Taylor coefficients over t; of a number the first.
template <class F> Polynomial by_series(const Polynomial& x, const Interval& domain, F series) {
    if (is_number(x) || (x.exists() && x.is_model())) {
        const Interval range = x.range();
        if (!range.bounded() || !(range.lo > domain.lo && range.hi < domain.hi)) return Polynomial::nothing();
        if (!x.is_model()) {
            const Interval value = series(range)[0];
            return value.bounded() ? Polynomial(value) : Polynomial::nothing();
        }
        const double at = mid(range);
        Series f = series(Interval(at));
        f[kOrder] = series(range)[kOrder];
        return Polynomial::composed(f.data(), kOrder, x, at);
    }
    return Polynomial::nothing();
}

/// sin(t + quarter turns)
Series circular(const Interval& t, int turns) {
    const Interval s = sin(t), c = cos(t), all[4] = {s, c, -s, -c};
    Series f;
    Interval factorial(1);
    for (int k = 0; k <= kOrder; ++k) {
        f[std::size_t(k)] = all[(k + turns) % 4] / factorial;
        factorial = factorial * Interval(k + 1.0);
    }
    return f;
}

const Interval kPositive{0, std::numeric_limits<double>::infinity()};

}  // namespace

Polynomial sin(const Polynomial& x) {
    return by_series(x, Interval::all(), [](const Interval& t) { return circular(t, 0); });
}
Polynomial cos(const Polynomial& x) {
    return by_series(x, Interval::all(), [](const Interval& t) { return circular(t, 1); });
}
Polynomial exp(const Polynomial& x) {
    return by_series(x, Interval::all(), [](const Interval& t) {
        Series f{exp(t)};
        for (std::size_t k = 1; k < f.size(); ++k) f[k] = f[k - 1] / Interval(double(k));
        return f;
    });
}
Polynomial log(const Polynomial& x) {
    return by_series(x, kPositive, [](const Interval& t) {
        Series f{log(t)};
        const Interval each = -(Interval(1) / t);
        Interval power = Interval(-1);
        for (std::size_t k = 1; k < f.size(); ++k) {
            power = power * each;
            f[k] = power / Interval(double(k));
        }
        return f;
    });
}
Polynomial pow(const Polynomial& x, double p) {
    return by_series(x, kPositive, [p](const Interval& t) {
        Series f;
        Interval factor(1);
        for (std::size_t k = 0; k < f.size(); ++k) {
            const Interval left = Interval(p) - Interval(double(k));
            f[k] = factor * pow(t, left);
            factor = factor * left / Interval(double(k + 1));
        }
        return f;
    });
}
Polynomial sqrt(const Polynomial& x) { return pow(x, 0.5); }

}  // namespace isoparm
