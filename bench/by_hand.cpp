#include "by_hand.h"

#include <algorithm>

namespace isoparm::bench {
namespace {

template <int n> using Weights = std::array<double, n>;

// ---- the bases and their derivatives --------------------------------------------------------------------------------
Weights<4> bernstein(double t) {
    const double s = 1 - t;
    return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}
Weights<4> bernstein_1(double t) {
    const double s = 1 - t;
    return {-3 * s * s, 3 * s * (s - 2 * t), 3 * t * (2 * s - t), 3 * t * t};
}
Weights<4> bernstein_2(double t) { return {6 - 6 * t, 18 * t - 12, 6 - 18 * t, 6 * t}; }

template <int n> Weights<n> blends(double t) {
    if constexpr (n == 2)
        return {1 - t, t};
    else
        return {1 + t * t * (2 * t - 3), t * (1 + t * (t - 2)), t * t * (t - 1), t * t * (3 - 2 * t)};
}
template <int n> Weights<n> blends_1(double t) {
    if constexpr (n == 2)
        return {-1, 1};
    else
        return {6 * t * (t - 1), 1 + t * (3 * t - 4), t * (3 * t - 2), 6 * t * (1 - t)};
}
Weights<4> hermite_2(double t) { return {12 * t - 6, 6 * t - 4, 6 * t - 2, 6 - 12 * t}; }

// ---- sums ----------------------------------------------------------------------------------------------------------
template <int n> Point sum(const Weights<n>& w, const std::array<Point, n>& p) {
    Point r = w[0] * p[0];
    for (int i = 1; i < n; ++i) r += w[i] * p[i];
    return r;
}
/// The curves (or rows of points) at one parameter.
template <int n, int m>
std::array<Point, n> each(const std::array<std::array<Point, m>, n>& rows, const Weights<m>& w) {
    std::array<Point, n> r;
    for (int i = 0; i < n; ++i) r[i] = sum<m>(w, rows[i]);
    return r;
}
template <int n> std::array<Point, n> minus(const std::array<Point, n>& a, const std::array<Point, n>& b) {
    std::array<Point, n> r;
    for (int i = 0; i < n; ++i) r[i] = a[i] - b[i];
    return r;
}

// ---- the same, eight lanes at a time
// ---------------------------------------------------------------------------------
constexpr int kLanes = 8;
using Lanes = double[kLanes];

void bernstein(const double* t, Lanes (&b)[4]) {
    for (int l = 0; l < kLanes; ++l) {
        const double s = 1 - t[l];
        b[0][l] = s * s * s;
        b[1][l] = 3 * s * s * t[l];
        b[2][l] = 3 * s * t[l] * t[l];
        b[3][l] = t[l] * t[l] * t[l];
    }
}
template <int n> void blends(const double* t, Lanes (&b)[n]) {
    for (int l = 0; l < kLanes; ++l) {
        const double x = t[l];
        if constexpr (n == 2) {
            b[0][l] = 1 - x;
            b[1][l] = x;
        } else {
            b[0][l] = 1 + x * x * (2 * x - 3);
            b[1][l] = x * (1 + x * (x - 2));
            b[2][l] = x * x * (x - 1);
            b[3][l] = x * x * (3 - 2 * x);
        }
    }
}
template <int n> void sum(const Lanes (&w)[n], const std::array<Point, n>& p, int axis, Lanes& r) {
    for (int l = 0; l < kLanes; ++l) r[l] = w[0][l] * p[0][axis];
    for (int i = 1; i < n; ++i)
        for (int l = 0; l < kLanes; ++l) r[l] += w[i][l] * p[i][axis];
}

void block(const HandBezier& s, const double* u, const double* v, Lanes (&x)[3]) {
    Lanes bu[4], bv[4], row;
    bernstein(u, bu);
    bernstein(v, bv);
    for (int axis = 0; axis < 3; ++axis) {
        std::fill_n(x[axis], kLanes, 0.0);
        for (int i = 0; i < 4; ++i) {
            sum<4>(bv, s.p[i], axis, row);
            for (int l = 0; l < kLanes; ++l) x[axis][l] += bu[i][l] * row[l];
        }
    }
}

template <int n> void block(const HandCoons<n>& s, const double* u, const double* v, Lanes (&x)[3]) {
    Lanes bu[4], bv[4], hu[n], hv[n], curve, row;
    bernstein(u, bu);
    bernstein(v, bv);
    blends<n>(u, hu);
    blends<n>(v, hv);
    for (int axis = 0; axis < 3; ++axis) {
        std::fill_n(x[axis], kLanes, 0.0);
        for (int i = 0; i < n; ++i) {
            sum<4>(bv, s.f[i], axis, curve);
            sum<n>(hv, s.m[i], axis, row);
            for (int l = 0; l < kLanes; ++l) x[axis][l] += hu[i][l] * (curve[l] - row[l]);
            sum<4>(bu, s.g[i], axis, curve);
            for (int l = 0; l < kLanes; ++l) x[axis][l] += hv[i][l] * curve[l];
        }
    }
}

template <class S> void in_blocks(const S& s, std::size_t count, const double* u, const double* v, Point* out) {
    std::size_t k = 0;
    for (; k + kLanes <= count; k += kLanes) {
        Lanes x[3];
        block(s, u + k, v + k, x);
        for (int l = 0; l < kLanes; ++l) out[k + l] = {x[0][l], x[1][l], x[2][l]};
    }
    for (; k < count; ++k) out[k] = point(s, u[k], v[k]);
}

}  // namespace

// ---- the Bezier patch
// ------------------------------------------------------------------------------------------------
Point point(const HandBezier& s, double u, double v) { return sum<4>(bernstein(u), each<4, 4>(s.p, bernstein(v))); }

Derivatives derivatives(const HandBezier& s, double u, double v) {
    const auto b = bernstein(u), b1 = bernstein_1(u), b2 = bernstein_2(u);
    const auto row = each<4, 4>(s.p, bernstein(v)), row1 = each<4, 4>(s.p, bernstein_1(v));
    return {sum<4>(b, row),  sum<4>(b1, row),  sum<4>(b, row1),
            sum<4>(b2, row), sum<4>(b1, row1), sum<4>(b, each<4, 4>(s.p, bernstein_2(v)))};
}

void points(const HandBezier& s, std::size_t n, const double* u, const double* v, Point* out) {
    for (std::size_t k = 0; k < n; ++k) out[k] = point(s, u[k], v[k]);
}
void points_side_by_side(const HandBezier& s, std::size_t n, const double* u, const double* v, Point* out) {
    in_blocks(s, n, u, v, out);
}

// ---- the Coons patches: sum_i h_i(u) (f_i - row_i)(v) + sum_j h_j(v) g_j(u)
// ---------------------------------------------
template <int n> Point point(const HandCoons<n>& s, double u, double v) {
    const auto hu = blends<n>(u), hv = blends<n>(v);
    return sum<n>(hu, minus<n>(each<n, 4>(s.f, bernstein(v)), each<n, n>(s.m, hv))) +
           sum<n>(hv, each<n, 4>(s.g, bernstein(u)));
}

template <int n> Derivatives derivatives(const HandCoons<n>& s, double u, double v) {
    const auto hu = blends<n>(u), hu1 = blends_1<n>(u), hv = blends<n>(v), hv1 = blends_1<n>(v);
    const auto f = minus<n>(each<n, 4>(s.f, bernstein(v)), each<n, n>(s.m, hv));
    const auto f1 = minus<n>(each<n, 4>(s.f, bernstein_1(v)), each<n, n>(s.m, hv1));
    auto f2 = each<n, 4>(s.f, bernstein_2(v));
    const auto g = each<n, 4>(s.g, bernstein(u)), g1 = each<n, 4>(s.g, bernstein_1(u)),
               g2 = each<n, 4>(s.g, bernstein_2(u));
    Derivatives d{sum<n>(hu, f) + sum<n>(hv, g),     sum<n>(hu1, f) + sum<n>(hv, g1),
                  sum<n>(hu, f1) + sum<n>(hv1, g),   sum<n>(hv, g2),
                  sum<n>(hu1, f1) + sum<n>(hv1, g1), {}};
    if constexpr (n == 4) {  // linear blends have no second derivative
        const auto hv2 = hermite_2(v);
        f2 = minus<n>(f2, each<n, n>(s.m, hv2));
        d[3] += sum<n>(hermite_2(u), f);
        d[5] = sum<n>(hv2, g);
    }
    d[5] += sum<n>(hu, f2);
    return d;
}

template <int n> void points(const HandCoons<n>& s, std::size_t count, const double* u, const double* v, Point* out) {
    for (std::size_t k = 0; k < count; ++k) out[k] = point(s, u[k], v[k]);
}
template <int n>
void points_side_by_side(const HandCoons<n>& s, std::size_t count, const double* u, const double* v, Point* out) {
    in_blocks(s, count, u, v, out);
}

#define ISOPARM_INSTANTIATE(n)                                                                    \
    template Point point(const HandCoons<n>&, double, double);                                    \
    template Derivatives derivatives(const HandCoons<n>&, double, double);                        \
    template void points(const HandCoons<n>&, std::size_t, const double*, const double*, Point*); \
    template void points_side_by_side(const HandCoons<n>&, std::size_t, const double*, const double*, Point*);
ISOPARM_INSTANTIATE(2)
ISOPARM_INSTANTIATE(4)
#undef ISOPARM_INSTANTIATE

}  // namespace isoparm::bench
