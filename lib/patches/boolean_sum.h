// patches/boolean_sum.h -- P1 (+) P2 = P1 + P2 - P1 P2: the one construction behind every Coons surface (Gordon 1969).
//
// P1 interpolates across u: sum_i H_i(u) f_i(v); P2 across v: sum_j H_j(v) g_j(u); their product the corner data
// M_ij = L_i(g_j) = L_j(f_i). What the H_i are is the business of a basis (patches/basis.h).
#pragma once
#include <algorithm>

#include "patches/basis.h"
#include "patches/tensor_bezier.h"

namespace isoparm {

/// Which projector a surface draws.
enum class Part { sum, P1, P2, P1P2 };

template <class BasisU, class BasisV = BasisU> struct BooleanSum {
    static constexpr Domain domain = Domain::quad;
    BasisU basis_u;
    BasisV basis_v;
    std::vector<Curve> f, g;  // f[i](v), g[j](u); not needed by parts that do not use them
    Grid<Point> corner;       // M_ij
    Part part = Part::sum;
    Rect over{};

    Rect rect() const { return over; }
    /// Lines u = const and v = const where the basis or the curves have breaks.
    std::vector<double> breaks_u() const { return lines(basis_u.breaks(), g, over.u0, over.u1); }
    std::vector<double> breaks_v() const { return lines(basis_v.breaks(), f, over.v0, over.v1); }

    template <class U, class V> auto operator()(const U& u, const V& v) const {
        const auto across_u = basis_u(u);
        const auto across_v = basis_v(v);
        const auto p1 = [&] { return sum_of(across_u, [&](std::size_t i) { return f[i](v); }); };
        const auto p2 = [&] { return sum_of(across_v, [&](std::size_t j) { return g[j](u); }); };
        const auto p12 = [&] {
            return sum_of(across_u, [&](std::size_t i) { return sum_of(across_v, [&](std::size_t j) { return corner[i][j]; }); });
        };
        using Value = decltype(p12());
        switch (part) {
            case Part::P1: return Value(p1());
            case Part::P2: return Value(p2());
            case Part::P1P2: return p12();
            default: return Value(p1() + p2() - p12());
        }
    }

private:
    template <class Blends, class Data> static auto sum_of(const Blends& blends, const Data& data) {
        auto sum = blends.weights[0] * data(blends.first);
        for (std::size_t k = 1; k < blends.weights.size(); ++k) sum = sum + blends.weights[k] * data(blends.first + k);
        return sum;
    }
    static std::vector<double> lines(std::vector<double> list, const std::vector<Curve>& curves, double begin, double end) {
        const std::size_t nodes = list.size();
        for (const double b : break_parameters(curves)) {
            const auto near = [&](double t) { return std::abs(t - b) <= break_rounding * (end - begin); };
            if (begin < b && b < end && std::none_of(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(nodes), near)) list.push_back(b);
        }
        std::sort(list.begin(), list.end());
        return list;
    }
};

}  // namespace isoparm
