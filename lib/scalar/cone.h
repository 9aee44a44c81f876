// scalar/cone.h -- H(r) g(a/r), r = a + b, for a, b >= 0: the singular corner of side-vertex and Gregory patches.
//
// The ratio tau = a/r is linear-fractional, so it takes its extrema at the ends of a and b: exact ranges. At r = 0 the
// value is 0 (H(0) = 0) and derivatives have closed forms without a division by r: with o = 1 - tau, s = da + db,
// theta = o da - tau db, K = H/r, K' = (H' - K)/r,
//     dF = H' s g + K theta g',     ddF = H'' s^2 g + 2 K' s theta g' + (K/r) theta^2 g''
// where K lies in H'([0,r]), K' in H''([0,r])/2 and, when H'(0) = 0, K/r in H''([0,r])/2. Derivatives that depend on the
// direction of approach do not exist at r = 0: NaN for numbers, their range (or all()) over intervals. H must tend to 0, and answer at 0
// with the piece to its right.
#pragma once
#include <limits>

#include "scalar/jet.h"
#include "scalar/polynomial.h"

namespace isoparm {
namespace cone_detail {

inline double ratio(double a, double b) { return a + b == 0 ? 0 : a / (a + b); }
inline Pack ratio(const Pack& a, const Pack& b) {
    Pack r;
    for (int i = 0; i < Pack::lanes; ++i) r.set(i, ratio(a[i], b[i]));
    return r;
}
inline Interval ratio(const Interval& a, const Interval& b) {
    const Interval p(std::max(a.lo, 0.0), std::max(a.hi, 0.0)), q(std::max(b.lo, 0.0), std::max(b.hi, 0.0));
    const double lo = p.lo == 0 ? 0 : (Interval(p.lo) / (Interval(p.lo) + Interval(q.hi))).lo;
    const double hi = q.lo == 0 ? 1 : (Interval(p.hi) / (Interval(p.hi) + Interval(q.lo))).hi;
    return {std::clamp(lo, 0.0, 1.0), std::clamp(hi, 0.0, 1.0)};
}
/// A radius to divide by: 1 where r = 0, where every numerator that it meets is multiplied by H = H' = 0 later on.
inline double divisor(double r) { return r == 0 ? 1 : r; }
inline Pack divisor(const Pack& r) {
    return each_lane(r, [](double x) { return x == 0 ? 1.0 : x; });
}
inline Interval divisor(const Interval& r) { return r; }

/// H'(0) = 0: exactly at the point, and next to it, in case H answers at 0 with another piece than that to the right.
template <class HF> bool is_flat(const HF& H) {
    const Interval at = H(variable_u<Interval, 1>(Interval(0))).c[1], after = H(variable_u<Interval, 1>(Interval(0, 1e-300))).c[1];
    return at.lo == 0 && at.hi == 0 && mag(after) <= 1e-100;
}

template <class A, class B> struct Joined;
template <class T, int I1, int J1, int I2, int J2, int N> struct Joined<Jet<T, I1, J1, N>, Jet<T, I2, J2, N>> {
    using Base = T;
    using Type = Jet<T, std::max(I1, I2), std::max(J1, J2), N>;
    static constexpr int order = N;
};

template <class X> struct Components {  // one scalar, or the three of a vector
    static constexpr int count = 1;
    static const X& get(const X& x, int) { return x; }
    static X& get(X& x, int) { return x; }
};
template <class S> struct Components<Vec3<S>> {
    static constexpr int count = 3;
    static const S& get(const Vec3<S>& x, int i) { return x[i]; }
    static S& get(Vec3<S>& x, int i) { return x[i]; }
};

/// Coefficients of one component up to order 2 by the closed form. h = {H, H', H''}, k = {K, K', K/r}, g = {g, g', g''}.
template <class T, class R, class A, class B>
void closed_form(const A& a, const B& b, const T& tau, const T (&h)[3], const T (&k)[3], const T (&g)[3], R& f) {
    f.c[0] = h[0] * g[0];
    if constexpr (R::order >= 1) {
        const auto s = [&](int i, int j) { return a.coefficient(i, j) + b.coefficient(i, j); };
        const auto theta = [&](int i, int j) { return (T(1.0) - tau) * a.coefficient(i, j) - tau * b.coefficient(i, j); };
        const T su = s(1, 0), sv = s(0, 1), tu = theta(1, 0), tv = theta(0, 1);
        const auto set = [&](int i, int j, const T& value) {
            const int at = R::index(i, j);
            if (at >= 0) f.c[at] = value;
        };
        set(1, 0, h[1] * su * g[0] + k[0] * tu * g[1]);
        set(0, 1, h[1] * sv * g[0] + k[0] * tv * g[1]);
        if constexpr (R::order >= 2) {
            const T half(0.5);
            set(2, 0, half * (h[2] * (su * su) * g[0] + T(2.0) * k[1] * su * tu * g[1] + k[2] * (tu * tu) * g[2]));
            set(0, 2, half * (h[2] * (sv * sv) * g[0] + T(2.0) * k[1] * sv * tv * g[1] + k[2] * (tv * tv) * g[2]));
            set(1, 1, h[2] * (su * sv) * g[0] + k[1] * (su * tv + sv * tu) * g[1] + k[2] * (tu * tv) * g[2]);
        }
    }
}

}  // namespace cone_detail

/// a and b are affine functions of (u,v) that are not negative on the domain; H a function of r with H(0) = 0, g of tau.
template <class HF, class G, class A, class B> auto cone(const HF& H, const G& g, const A& a, const B& b) {
    using namespace cone_detail;
    using T = typename Joined<A, B>::Base;
    using R = typename Joined<A, B>::Type;
    constexpr int N = R::order;
    const R r = R(a) + R(b);
    // tau by the quotient recurrence, its constant term by the exact range
    R tau;
    {
        const R num(a);
        const T r0 = divisor(r.c[0]);
        tau.c[0] = ratio(a.c[0], b.c[0]);
        for (int k = 1; k < R::size; ++k) {
            const auto [i, j] = R::powers[k];
            T sum = num.c[k];
            for (int l = 0; l < k; ++l) {
                const int rest = R::index(i - R::powers[l].first, j - R::powers[l].second);
                if (rest > 0) sum = sum - tau.c[l] * r.c[rest];
            }
            tau.c[k] = sum / r0;
        }
    }
    auto result = H(r) * g(tau);
    using C = Components<decltype(result)>;
    if constexpr (std::is_same_v<T, Pack>) {  // derivatives at r = 0 are for numbers and intervals only
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        for (int lane = 0; lane < Pack::lanes; ++lane)
            if (r.c[0][lane] == 0)
                for (int i = 0; i < C::count; ++i)
                    for (int k = 1; k < R::size; ++k) C::get(result, i).c[k].set(lane, none);
    }
    if constexpr (std::is_same_v<T, Interval> || std::is_same_v<T, double>) {
        if constexpr (std::is_same_v<T, double>)
            if (r.c[0] != 0) return result;
        constexpr int M = 2;
        const bool flat = N < M || is_flat(H);  // K/r is bounded
        double size = 0;                                   // of g: what its rounding is relative to
        if constexpr (requires { g.size(); }) size = g.size();
        const auto closed = [&](const T& radius, const T& at, auto& out) {
            const auto h = H(variable_u<T, M>(radius));
            const auto gamma = g(variable_u<T, M>(at));
            const T hs[3] = {h.c[0], h.c[1], T(2.0) * h.c[2]};
            T k[3] = {h.c[1], h.c[2], h.c[2]};
            for (int i = 0; i < C::count; ++i) {
                const auto& gi = Components<std::decay_t<decltype(gamma)>>::get(gamma, i);
                const T gs[3] = {gi.c[0], gi.c[1], T(2.0) * gi.c[2]};
                if constexpr (std::is_same_v<T, Interval>) {
                    if (!flat) k[2] = Interval::all();
                } else {
                    size = std::max(size, std::fabs(gs[0]));
                    if (!flat) k[2] = std::fabs(gs[2]) <= 1e-12 * size ? 0 : std::numeric_limits<double>::infinity();
                }
                closed_form(a, b, at, hs, k, gs, C::get(out, i));
            }
        };
        if constexpr (std::is_same_v<T, Interval>) {
            auto other = result;
            closed(Interval(0, r.c[0].hi), tau.c[0], other);
            for (int i = 0; i < C::count; ++i)
                for (int k = 0; k < R::size; ++k) {
                    if (R::powers[k].first + R::powers[k].second > 2) continue;
                    Interval& x = C::get(result, i).c[k];
                    const Interval& y = C::get(other, i).c[k];
                    if (std::max(x.lo, y.lo) <= std::min(x.hi, y.hi)) x = {std::max(x.lo, y.lo), std::min(x.hi, y.hi)};
                }
        } else if constexpr (N >= 1) {
            // At the vertex itself: a derivative exists if all directions of approach agree.
            constexpr int samples = 5;
            decltype(result) at[samples];
            for (int n = 0; n < samples; ++n) closed(0.0, n / (samples - 1.0), at[n]);
            for (int i = 0; i < C::count; ++i)
                for (int k = 0; k < R::size; ++k) {
                    double low = C::get(at[0], i).c[k], high = low;
                    bool exists = true;
                    for (int n = 0; n < samples; ++n) {
                        const double x = C::get(at[n], i).c[k];
                        exists = exists && std::isfinite(x);
                        low = std::min(low, x), high = std::max(high, x);
                    }
                    exists = exists && high - low <= 1e-12 * std::max({size, std::fabs(low), std::fabs(high)});
                    C::get(result, i).c[k] = k == 0 ? 0 : exists ? 0.5 * (low + high) : std::numeric_limits<double>::quiet_NaN();
                }
        }
    }
    return result;
}

/// r^2 and tau^2 (1 - tau): cone(SquareOfRadius{}, GregoryRatio{}, a, b) = a^2 b / (a + b).
struct SquareOfRadius {
    template <class S> S operator()(const S& r) const { return square(r); }
};
struct GregoryRatio {
    template <class S> S operator()(const S& tau) const { return square(tau) * (1.0 - tau); }
};

/// Not a polynomial in general; a model away from r = 0.
template <class HF, class G> auto cone(const HF& H, const G& g, const Polynomial& a, const Polynomial& b) {
    using Value = decltype(g(Polynomial()));
    const Polynomial r = a + b;
    if (!r.is_model()) return Value(g(Polynomial::nothing()));
    return Value(H(r) * g(a / r));
}

}  // namespace isoparm
