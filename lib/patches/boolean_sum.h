// patches/boolean_sum.h -- P1 (+) P2 = P1 + P2 - P1 P2: the one construction behind every Coons surface (Gordon 1969).
//
// P1 interpolates across u: sum_i H_i(u) f_i(v); P2 across v: sum_j H_j(v) g_j(u); their product the corner data
// M_ij = L_i(g_j) = L_j(f_i). A basis is an object that answers basis(t) with the array of its blends at t.
#pragma once
#include <array>

#include "curve.h"

namespace isoparm {

/// Which projector a surface draws.
enum class Part { sum, P1, P2, P1P2 };

/// Weights (1-H, H) with H(0)=0, H(1)=1.
struct BlendBasis {
    static constexpr int size = 2;
    Function H;
    template <class S> std::array<S, 2> operator()(const S& t) const {
        const S h = H(t);
        return {1.0 - h, h};
    }
};
/// Weights (1-t, t).
struct LinearBasis {
    static constexpr int size = 2;
    template <class S> std::array<S, 2> operator()(const S& t) const { return {1.0 - t, t}; }
};
/// Cubic Hermite blends in the order value, derivative at 0, derivative, value at 1 (H1..H4 of seed 002 (3)).
struct HermiteBasis {
    static constexpr int size = 4;
    template <class S> std::array<S, 4> operator()(const S& t) const {
        static constexpr double h[4][4] = {{1, 0, -3, 2}, {0, 1, -2, 1}, {0, 0, -1, 1}, {0, 0, 3, -2}};
        return {polynomial(h[0], 3, t), polynomial(h[1], 3, t), polynomial(h[2], 3, t), polynomial(h[3], 3, t)};
    }
};

template <class Basis> struct BooleanSum {
    static constexpr int n = Basis::size;
    Basis basis;
    std::array<Curve, n> f, g;                   // f[i](v), g[j](u)
    std::array<std::array<Point, n>, n> corner;  // M_ij
    Part part = Part::sum;

    /// Lines u = const and v = const where its curves have breaks.
    std::vector<double> breaks_u() const { return lines(g); }
    std::vector<double> breaks_v() const { return lines(f); }

    template <class U, class V> auto operator()(const U& u, const V& v) const {
        const auto across_u = basis(u);
        const auto across_v = basis(v);
        auto p1 = across_u[0] * f[0](v);
        auto p2 = across_v[0] * g[0](u);
        const auto corners = [&](int i) {
            auto row = across_v[0] * corner[i][0];
            for (int j = 1; j < n; ++j) row = row + across_v[j] * corner[i][j];
            return row;
        };
        auto p12 = across_u[0] * corners(0);
        for (int i = 1; i < n; ++i) {
            p1 = p1 + across_u[i] * f[i](v);
            p2 = p2 + across_v[i] * g[i](u);
            p12 = p12 + across_u[i] * corners(i);
        }
        switch (part) {
            case Part::P1: return p1;
            case Part::P2: return p2;
            case Part::P1P2: return p12;
            default: return p1 + p2 - p12;
        }
    }

private:
    static std::vector<double> lines(const std::array<Curve, n>& curves) {
        std::vector<double> list;
        for (const Break& b : breaks_of(curves)) list.push_back(b.t);
        return list;
    }
};

}  // namespace isoparm
