// scalar/jet.h -- truncated Taylor expansions in (u,v): how a formula becomes its derivatives.
//
// Jet<T,I,J,N> holds the Taylor coefficients f_ij = (d^i/du^i)(d^j/dv^j) f / (i! j!) with i <= I, j <= J, i + j <= N.
// A function of u alone is a Jet<T,N,0,N>, of v alone a Jet<T,0,N,N>; products of the two are outer products, so no
// coefficient that is zero by nature is ever stored or multiplied. T is double, Pack or Interval; over intervals the
// coefficients enclose those at every point of the box (Moore 1966).
#pragma once
#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include "scalar/interval.h"
#include "scalar/pack.h"
#include "scalar/vec.h"

namespace isoparm {

template <class T, int I, int J, int N> struct Jet {
    static constexpr int order = N;
    static constexpr int max_u = I, max_v = J;
    static constexpr bool has(int i, int j) { return i >= 0 && j >= 0 && i <= I && j <= J && i + j <= N; }
    static constexpr int size = [] {
        int k = 0;
        for (int d = 0; d <= N; ++d)
            for (int b = 0; b <= d; ++b) k += has(d - b, b);
        return k;
    }();
    static constexpr std::array<std::pair<int, int>, size> powers = [] {
        std::array<std::pair<int, int>, size> p{};
        int k = 0;
        for (int d = 0; d <= N; ++d)
            for (int b = 0; b <= d; ++b)
                if (has(d - b, b)) p[k++] = {d - b, b};
        return p;
    }();

    /// Where f_ij stands in c, or -1 for a coefficient that is 0 by nature. Numbered by total degree, then by j.
    static constexpr int index(int i, int j) { return has(i, j) ? table[i][j] : -1; }
    static constexpr std::array<std::array<int, N + 1>, N + 1> table = [] {
        std::array<std::array<int, N + 1>, N + 1> t{};
        for (int k = 0; k < size; ++k) t[powers[k].first][powers[k].second] = k;
        return t;
    }();

    T c[size]{};

    Jet() = default;
    Jet(const T& value) { c[0] = value; }  // NOLINT: constants are jets
    template <class S, class = std::enable_if_t<std::is_arithmetic_v<S> && !std::is_same_v<S, T>>>
    Jet(S value) { c[0] = T(double(value)); }  // NOLINT

    template <int I2, int J2, class = std::enable_if_t<(I2 <= I && J2 <= J) && (I2 < I || J2 < J)>>
    Jet(const Jet<T, I2, J2, N>& o) {  // NOLINT: a function of u alone is a function of (u,v)
        using O = Jet<T, I2, J2, N>;
        for (int k = 0; k < O::size; ++k) c[index(O::powers[k].first, O::powers[k].second)] = o.c[k];
    }
    const T& value() const { return c[0]; }
    /// Taylor coefficient f_ij; 0 where the jet has none by nature.
    T coefficient(int i, int j) const {
        const int k = index(i, j);
        return k < 0 ? T(0.0) : c[k];
    }
};

template <class T, int N> using JetU = Jet<T, N, 0, N>;
template <class T, int N> using JetV = Jet<T, 0, N, N>;
template <class T, int N> using JetUV = Jet<T, N, N, N>;

template <class X> struct IsJet : std::false_type {};
template <class T, int I, int J, int N> struct IsJet<Jet<T, I, J, N>> : std::true_type {
    using Base = T;
};

template <class T, int N> JetU<T, N> variable_u(const T& u) {
    JetU<T, N> j(u);
    if constexpr (N > 0) j.c[1] = T(1.0);
    return j;
}
template <class T, int N> JetV<T, N> variable_v(const T& v) {
    JetV<T, N> j(v);
    if constexpr (N > 0) j.c[1] = T(1.0);
    return j;
}
/// The third barycentric coordinate w = 1 - u - v; its value is given, for boxes that know it better than 1 - u - v.
template <class T, int N> JetUV<T, N> variable_w(const T& w) {
    JetUV<T, N> j(w);
    if constexpr (N > 0) j.c[1] = j.c[2] = T(-1.0);
    return j;
}

/// The number under a scalar: itself, or the constant term of a jet.
inline double base(double x) { return x; }
inline const Interval& base(const Interval& x) { return x; }
inline const Pack& base(const Pack& x) { return x; }
template <class T, int I, int J, int N> const T& base(const Jet<T, I, J, N>& x) { return x.c[0]; }

/// The value brought back into [low, high], where only rounding can have put it outside; derivatives stay.
inline double kept_in(double x, double low, double high) { return x < low ? low : x > high ? high : x; }
inline Interval kept_in(const Interval& x, double low, double high) { return clip(x, {low, high}); }
inline Pack kept_in(const Pack& x, double low, double high) {
    return each_lane(x, [&](double lane) { return kept_in(lane, low, high); });
}
template <class T, int I, int J, int N> Jet<T, I, J, N> kept_in(Jet<T, I, J, N> x, double low, double high) {
    x.c[0] = kept_in(x.c[0], low, high);
    return x;
}

// ---- arithmetic -----------------------------------------------------------------------------------------------------
template <class T, int I1, int J1, int I2, int J2, int N>
auto operator+(const Jet<T, I1, J1, N>& a, const Jet<T, I2, J2, N>& b) {
    using A = Jet<T, I1, J1, N>;
    using B = Jet<T, I2, J2, N>;
    using R = Jet<T, std::max(I1, I2), std::max(J1, J2), N>;
    R r;
    for (int k = 0; k < R::size; ++k) {
        const int p = A::index(R::powers[k].first, R::powers[k].second), q = B::index(R::powers[k].first, R::powers[k].second);
        if (p >= 0 && q >= 0) r.c[k] = a.c[p] + b.c[q];
        else if (p >= 0) r.c[k] = a.c[p];
        else if (q >= 0) r.c[k] = b.c[q];
    }
    return r;
}
template <class T, int I, int J, int N> Jet<T, I, J, N> operator-(const Jet<T, I, J, N>& a) {
    Jet<T, I, J, N> r;
    for (int k = 0; k < r.size; ++k) r.c[k] = -a.c[k];
    return r;
}
template <class T, int I1, int J1, int I2, int J2, int N>
auto operator-(const Jet<T, I1, J1, N>& a, const Jet<T, I2, J2, N>& b) { return a + (-b); }

template <class T, int I, int J, int N> Jet<T, I, J, N> operator+(Jet<T, I, J, N> a, const std::type_identity_t<T>& s) { a.c[0] = a.c[0] + s; return a; }
template <class T, int I, int J, int N> Jet<T, I, J, N> operator+(const std::type_identity_t<T>& s, Jet<T, I, J, N> a) { a.c[0] = s + a.c[0]; return a; }
template <class T, int I, int J, int N> Jet<T, I, J, N> operator-(Jet<T, I, J, N> a, const std::type_identity_t<T>& s) { a.c[0] = a.c[0] - s; return a; }
template <class T, int I, int J, int N> Jet<T, I, J, N> operator-(const std::type_identity_t<T>& s, const Jet<T, I, J, N>& a) {
    Jet<T, I, J, N> r = -a;
    r.c[0] = s - a.c[0];
    return r;
}
template <class T, int I, int J, int N> Jet<T, I, J, N> operator*(Jet<T, I, J, N> a, const std::type_identity_t<T>& s) {
    for (auto& x : a.c) x = x * s;
    return a;
}
template <class T, int I, int J, int N> Jet<T, I, J, N> operator*(const std::type_identity_t<T>& s, const Jet<T, I, J, N>& a) { return a * s; }
template <class T, int I, int J, int N> Jet<T, I, J, N> operator/(Jet<T, I, J, N> a, const std::type_identity_t<T>& s) {
    for (auto& x : a.c) x = x / s;
    return a;
}

/// The products a.c[p] * b.c[q] that add up to r.c[k], as a table known to the compiler. MinA, MinB: total degrees below
/// which a and b are known to vanish.
template <class A, class B, class R, int MinA = 0, int MinB = 0> struct ProductTable {
    struct Term {
        int k, p, q;
        bool first;
    };
    static constexpr bool counts(int p, int q) {
        const auto [i, j] = A::powers[p];
        const auto [k, l] = B::powers[q];
        return i + j >= MinA && k + l >= MinB && R::has(i + k, j + l);
    }
    static constexpr int count = [] {
        int n = 0;
        for (int p = 0; p < A::size; ++p)
            for (int q = 0; q < B::size; ++q) n += counts(p, q);
        return n;
    }();
    static constexpr std::array<Term, count> terms = [] {
        std::array<Term, count> t{};
        int n = 0;
        for (int k = 0; k < R::size; ++k) {
            bool first = true;
            for (int p = 0; p < A::size; ++p)
                for (int q = 0; q < B::size; ++q)
                    if (counts(p, q) && A::powers[p].first + B::powers[q].first == R::powers[k].first &&
                        A::powers[p].second + B::powers[q].second == R::powers[k].second) {
                        t[n++] = {k, p, q, first};
                        first = false;
                    }
        }
        return t;
    }();
};

/// Cauchy product, truncated at total degree N.
template <int MinA = 0, int MinB = 0, class T, int I1, int J1, int I2, int J2, int N>
auto product(const Jet<T, I1, J1, N>& a, const Jet<T, I2, J2, N>& b) {
    using R = Jet<T, std::max(I1, I2), std::max(J1, J2), N>;
    using Table = ProductTable<Jet<T, I1, J1, N>, Jet<T, I2, J2, N>, R, MinA, MinB>;
    R r;
    [&]<std::size_t... M>(std::index_sequence<M...>) {
        ([&] {
            constexpr auto t = Table::terms[M];
            if constexpr (t.first) r.c[t.k] = a.c[t.p] * b.c[t.q];
            else r.c[t.k] = r.c[t.k] + a.c[t.p] * b.c[t.q];
        }(), ...);
    }(std::make_index_sequence<Table::count>{});
    return r;
}
template <class T, int I1, int J1, int I2, int J2, int N>
auto operator*(const Jet<T, I1, J1, N>& a, const Jet<T, I2, J2, N>& b) { return product(a, b); }

/// Quotient by the recurrence q_k = (a_k - sum q_l b_{k-l}) / b_0.
template <class T, int I1, int J1, int I2, int J2, int N>
auto operator/(const Jet<T, I1, J1, N>& a, const Jet<T, I2, J2, N>& b) {
    using A = Jet<T, I1, J1, N>;
    using B = Jet<T, I2, J2, N>;
    using R = Jet<T, std::max(I1, I2), std::max(J1, J2), N>;
    R r;
    for (int k = 0; k < R::size; ++k) {
        const auto [i, j] = R::powers[k];
        const int ka = A::index(i, j);
        T sum = ka < 0 ? T(0.0) : a.c[ka];
        for (int p = 0; p <= i; ++p)
            for (int q = 0; q <= j; ++q) {
                const int kb = B::index(i - p, j - q), kr = R::index(p, q);
                if ((p == i && q == j) || kb < 0 || kr < 0) continue;
                sum = sum - r.c[kr] * b.c[kb];
            }
        r.c[k] = sum / b.c[0];
    }
    return r;
}
template <class T, int I, int J, int N> Jet<T, I, J, N> operator/(const std::type_identity_t<T>& s, const Jet<T, I, J, N>& a) { return Jet<T, I, J, N>(s) / a; }

inline double square(double x) { return x * x; }
inline Pack square(const Pack& x) { return x * x; }
template <class T, int I, int J, int N> Jet<T, I, J, N> square(const Jet<T, I, J, N>& a) {
    auto r = a * a;
    r.c[0] = square(a.c[0]);
    return r;
}

// ---- composition ----------------------------------------------------------------------------------------------------
/// f(x) from the Taylor coefficients f_0..f_N of f at the constant term of x: sum f_k (x - x_0)^k, for `count` functions
/// that share the powers. (x - x_0)^k vanishes below degree k.
template <int Count, class T, int I, int J, int N> void compose(const T (*f)[N + 1], const Jet<T, I, J, N>& x, Jet<T, I, J, N>* out) {
    using X = Jet<T, I, J, N>;
    for (int n = 0; n < Count; ++n) out[n].c[0] = f[n][0];
    const auto add = [&]<int K>(std::integral_constant<int, K>, const X& power) {
        for (int k = 0; k < X::size; ++k) {
            if (X::powers[k].first + X::powers[k].second < K) continue;
            for (int n = 0; n < Count; ++n) out[n].c[k] = K == 1 ? f[n][1] * power.c[k] : out[n].c[k] + f[n][K] * power.c[k];
        }
    };
    if constexpr (N >= 1) add(std::integral_constant<int, 1>{}, x);
    if constexpr (N >= 2) {
        const X second = product<1, 1>(x, x);
        add(std::integral_constant<int, 2>{}, second);
        if constexpr (N >= 3) add(std::integral_constant<int, 3>{}, product<1, 2>(x, second));
    }
    static_assert(N <= 3);
}
template <class T, int I, int J, int N> Jet<T, I, J, N> compose(const T* f, const Jet<T, I, J, N>& x) {
    T a[1][N + 1];
    std::copy(f, f + N + 1, a[0]);
    Jet<T, I, J, N> r;
    compose<1>(a, x, &r);
    return r;
}
template <class T, int I, int J, int N> auto compose(const Vec3<T>* f, const Jet<T, I, J, N>& x) {
    T a[3][N + 1];
    for (int k = 0; k <= N; ++k)
        for (int i = 0; i < 3; ++i) a[i][k] = f[k][i];
    Jet<T, I, J, N> r[3];
    compose<3>(a, x, r);
    return Vec3<Jet<T, I, J, N>>{r[0], r[1], r[2]};
}

}  // namespace isoparm
