// scalar/elementary.h -- sin, cos, exp, log and powers on packs, intervals and jets; kinks (abs, min, max, if) on all.
//
// The mathematical libraries in use err by less than one unit in the last place here, but do not round correctly; the
// interval versions therefore move results outward by three such steps. Jets come from Taylor coefficients by compose().
#pragma once
#include <cmath>
#include <numbers>

#include "scalar/interval.h"
#include "scalar/jet.h"
#include "scalar/pack.h"
#include "scalar/polynomial.h"

namespace isoparm {

// ---- packs: lane by lane what a double would do ---------------------------------------------------------------------
inline Pack sin(const Pack& a) { return each_lane(a, [](double x) { return std::sin(x); }); }
inline Pack cos(const Pack& a) { return each_lane(a, [](double x) { return std::cos(x); }); }
inline Pack exp(const Pack& a) { return each_lane(a, [](double x) { return std::exp(x); }); }
inline Pack log(const Pack& a) { return each_lane(a, [](double x) { return std::log(x); }); }
inline Pack pow(const Pack& a, double p) { return each_lane(a, [p](double x) { return std::pow(x, p); }); }

// ---- intervals ------------------------------------------------------------------------------------------------------
namespace rounding {
/// Below and above every number that a library function may have meant by x; an underflowed 0 may be any tiny number.
inline double below(double x) { return x == 0 ? -kTiny : down(down(down(x))); }
inline double above(double x) { return x == 0 ? kTiny : up(up(up(x))); }
/// May phase + k period, k an integer, lie in a? Never no when it does.
inline bool may_hold(const Interval& a, const Interval& phase, const Interval& period) {
    const Interval turns = (a - phase) / period;
    return !turns.bounded() || std::ceil(turns.lo) <= turns.hi;
}
inline const Interval pi{3.141592653589793, 3.1415926535897936};
}  // namespace rounding

inline Interval cos(const Interval& a) {
    using namespace rounding;
    if (!a.bounded()) return {-1, 1};
    const double p = std::cos(a.lo), q = std::cos(a.hi);
    const Interval turn = pi * 2.0;
    const double lo = may_hold(a, pi, turn) ? -1 : std::max(-1.0, below(std::min(p, q)));
    const double hi = may_hold(a, 0.0, turn) ? 1 : std::min(1.0, above(std::max(p, q)));
    return {lo, hi};
}
inline Interval sin(const Interval& a) {
    using namespace rounding;
    if (!a.bounded()) return {-1, 1};
    if (a.lo == 0 && a.hi == 0) return 0.0;
    const double p = std::sin(a.lo), q = std::sin(a.hi);
    const Interval turn = pi * 2.0, quarter = pi * 0.5;
    const double lo = may_hold(a, -quarter, turn) ? -1 : std::max(-1.0, below(std::min(p, q)));
    const double hi = may_hold(a, quarter, turn) ? 1 : std::min(1.0, above(std::max(p, q)));
    return {lo, hi};
}
inline Interval exp(const Interval& a) {
    using namespace rounding;
    return checked(std::max(0.0, below(std::exp(a.lo))), above(std::exp(a.hi)));
}
/// Of the positive part of a; all() where that reaches 0.
inline Interval log(const Interval& a) {
    using namespace rounding;
    if (!(a.lo > 0)) return Interval::all();
    return checked(below(std::log(a.lo)), above(std::log(a.hi)));
}
/// a^p, p not an integer, of the part of a that is not negative. p is an interval too, because the exponents of
/// derivatives, p - 1 and so on, are rounded; p log a takes its extrema at the corners.
inline Interval pow(const Interval& a, const Interval& p) {
    using namespace rounding;
    if (a.hi < 0 || (p.lo < 0 && a.lo <= 0)) return Interval::all();
    const double x = std::max(a.lo, 0.0);
    const auto [low, high] = std::minmax({std::pow(x, p.lo), std::pow(x, p.hi), std::pow(a.hi, p.lo), std::pow(a.hi, p.hi)});
    return checked(std::max(0.0, below(low)), above(high));
}
inline Interval pow(const Interval& a, double p) { return pow(a, Interval(p)); }

// ---- jets -----------------------------------------------------------------------------------------------------------
/// compose() with the coefficients that a jet of order N <= 3 needs.
template <class T, int I, int J, int N> Jet<T, I, J, N> compose_series(const T (&f)[4], const Jet<T, I, J, N>& x) {
    T needed[N + 1];
    for (int k = 0; k <= N; ++k) needed[k] = f[k];
    return compose(needed, x);
}
template <class T, int I, int J, int N> Jet<T, I, J, N> sin(const Jet<T, I, J, N>& x) {
    using std::cos, std::sin;
    const T s = sin(x.c[0]), c = cos(x.c[0]);
    const T f[] = {s, c, -s / T(2.0), -c / T(6.0)};
    return compose_series(f, x);
}
template <class T, int I, int J, int N> Jet<T, I, J, N> cos(const Jet<T, I, J, N>& x) {
    using std::cos, std::sin;
    const T s = sin(x.c[0]), c = cos(x.c[0]);
    const T f[] = {c, -s, -c / T(2.0), s / T(6.0)};
    return compose_series(f, x);
}
template <class T, int I, int J, int N> Jet<T, I, J, N> exp(const Jet<T, I, J, N>& x) {
    using std::exp;
    const T e = exp(x.c[0]);
    const T f[] = {e, e, e / T(2.0), e / T(6.0)};
    return compose_series(f, x);
}
template <class T, int I, int J, int N> Jet<T, I, J, N> log(const Jet<T, I, J, N>& x) {
    using std::log;
    const T r = T(1.0) / x.c[0];
    const T f[] = {log(x.c[0]), r, -(r * r) / T(2.0), r * r * r / T(3.0)};
    return compose_series(f, x);
}
template <class T, int I, int J, int N> Jet<T, I, J, N> sqrt(const Jet<T, I, J, N>& x) {
    using std::sqrt;
    const T s = sqrt(x.c[0]);
    const T r = T(0.5) / s, r3 = r * r * r;
    const T f[] = {s, r, -r3, r3 * r * r * T(2.0)};  // 1/(2s), -1/(8s^3), 1/(16s^5)
    return compose_series(f, x);
}
/// x^p, p not an integer, x >= 0.
template <class T, int I, int J, int N> Jet<T, I, J, N> pow(const Jet<T, I, J, N>& x, double p) {
    using std::pow;
    T f[4], factor(1.0);
    for (int k = 0; k <= std::min(N, 3); ++k) {
        if constexpr (std::is_same_v<T, Interval>) f[k] = factor * pow(x.c[0], Interval(p) - Interval(double(k)));
        else f[k] = factor * pow(x.c[0], p - k);
        factor = factor * (T(p) - T(double(k))) / T(double(k + 1));
    }
    return compose_series(f, x);
}

/// x^n by repeated squaring: polynomials stay polynomials.
template <class S> S power(const S& x, int n) {
    if (n < 0) return S(1.0) / power(x, -n);
    if (n == 0) return S(1.0);
    if (n == 1) return x;
    const S half = square(power(x, n / 2));
    return n % 2 == 0 ? half : half * x;
}

// ---- choices: a formula with a case distinction ---------------------------------------------------------------------
enum class Comparison { less, less_equal, greater, greater_equal, equal, not_equal };
enum class Truth { no, yes, unknown };

template <class T> auto compared(Comparison how, const T& a, const T& b) {
    switch (how) {
        case Comparison::less: return a < b;
        case Comparison::less_equal: return a <= b;
        case Comparison::greater: return a > b;
        case Comparison::greater_equal: return a >= b;
        case Comparison::equal: return a == b;
        default: return a != b;
    }
}
inline bool decide(Comparison how, double a, double b, bool) { return compared(how, a, b); }
inline auto decide(Comparison how, const Pack& a, const Pack& b, bool) { return compared(how, a.v, b.v); }
/// `touching`: intervals that only touch count as lying to either side, which is right for a choice that is continuous.
inline Truth decide(Comparison how, const Interval& a, const Interval& b, bool touching) {
    const bool point = a.lo == a.hi && b.lo == b.hi;
    if (point) return compared(how, a.lo, b.lo) ? Truth::yes : Truth::no;
    const bool below = a.hi < b.lo || (touching && a.hi == b.lo), above = a.lo > b.hi || (touching && a.lo == b.hi);
    if (!below && !above) return Truth::unknown;
    switch (how) {
        case Comparison::less:
        case Comparison::less_equal: return below ? Truth::yes : Truth::no;
        case Comparison::greater:
        case Comparison::greater_equal: return above ? Truth::yes : Truth::no;
        default: return touching && (a.hi == b.lo || a.lo == b.hi) ? Truth::unknown
                                                                  : how == Comparison::equal ? Truth::no : Truth::yes;
    }
}

/// The same for a choice that is continuous. Where x = y at a point, what holds just to its right: x and y are then jets of one
/// variable that grows, and the first coefficient in which they differ decides.
template <int I, int J, int N> bool decide_after(Comparison how, const Jet<double, I, J, N>& x, const Jet<double, I, J, N>& y) {
    for (int k = 0; k < x.size; ++k)
        if (x.c[k] != y.c[k]) return compared(how, x.c[k], y.c[k]);
    return compared(how, 0.0, 0.0);
}
template <int I, int J, int N> auto decide_after(Comparison how, const Jet<Pack, I, J, N>& x, const Jet<Pack, I, J, N>& y) {
    auto yes = compared(how, x.c[0].v, y.c[0].v);
    for (int k = x.size - 1; k >= 0; --k) {
        const auto differ = x.c[k].v != y.c[k].v;
        yes = (differ & compared(how, x.c[k].v, y.c[k].v)) | (~differ & yes);
    }
    return yes;
}
template <int I, int J, int N> Truth decide_after(Comparison how, const Jet<Interval, I, J, N>& x, const Jet<Interval, I, J, N>& y) {
    const auto same = [](const Interval& a, const Interval& b) { return a.lo == b.lo && a.hi == b.hi && a.lo == a.hi; };
    for (int k = 0; k < x.size; ++k)
        if (!same(x.c[k], y.c[k])) return decide(how, x.c[k], y.c[k], k == 0);
    return compared(how, 0.0, 0.0) ? Truth::yes : Truth::no;
}
inline bool decide_after(Comparison how, double x, double y) { return compared(how, x, y); }

template <class T> T choose(bool c, const T& a, const T& b) { return c ? a : b; }
template <class Mask, int I, int J, int N>
Jet<Pack, I, J, N> choose(const Mask& c, Jet<Pack, I, J, N> a, const Jet<Pack, I, J, N>& b) {
    for (int k = 0; k < a.size; ++k) a.c[k].v = c ? a.c[k].v : b.c[k].v;
    return a;
}
template <int I, int J, int N>
Jet<Interval, I, J, N> choose(Truth c, const Jet<Interval, I, J, N>& a, const Jet<Interval, I, J, N>& b, bool continuous) {
    if (c != Truth::unknown) return c == Truth::yes ? a : b;
    // A continuous choice is Lipschitz: its slope stays between those of its branches, but it has no second derivative.
    Jet<Interval, I, J, N> r;
    for (int k = 0; k < r.size; ++k) {
        const int order = r.powers[k].first + r.powers[k].second;
        r.c[k] = order == 0 || (order == 1 && continuous) ? hull(a.c[k], b.c[k]) : Interval::all();
    }
    return r;
}

/// a where x compares so with y, else b. `continuous`: the branches agree where the choice switches.
template <class S> S choose(Comparison how, const S& x, const S& y, const S& a, const S& b, bool continuous) {
    if constexpr (std::is_same_v<S, Polynomial>) {
        // A model lies to one side or has no second derivatives that could be bounded.
        if (!x.exists() || !y.exists() || !(x.is_model() || y.is_model())) return Polynomial::nothing();
        const Truth c = decide(how, x.range(), y.range(), continuous);
        return c == Truth::unknown ? Polynomial::nothing() : c == Truth::yes ? a : b;
    } else {
        const auto c = continuous ? decide_after(how, x, y) : decide(how, base(x), base(y), false);
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(c)>, Truth>) return choose(c, a, b, continuous);
        else return choose(c, a, b);
    }
}
template <class S> constexpr bool keeps_enclosures = requires(const S& x) { base(x).lo; };
template <class S> S absolute(const S& x) {
    S r = choose(Comparison::less, x, S(0.0), S(-x), x, true);
    if constexpr (keeps_enclosures<S>) r.c[0] = abs(x.c[0]);
    return r;
}
template <class S> S smaller(const S& a, const S& b) {
    S r = choose(Comparison::less, b, a, b, a, true);
    if constexpr (keeps_enclosures<S>) r.c[0] = min(a.c[0], b.c[0]);
    return r;
}
template <class S> S larger(const S& a, const S& b) {
    S r = choose(Comparison::less, a, b, b, a, true);
    if constexpr (keeps_enclosures<S>) r.c[0] = max(a.c[0], b.c[0]);
    return r;
}

}  // namespace isoparm
