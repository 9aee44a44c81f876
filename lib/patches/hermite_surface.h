// patches/hermite_surface.h -- the formula of the bicubically blended Coons patch and of networks of them, with Gregory's twists
// (seed 002 (4), (17); formula sheet A4, A5, A8); shared by coons_hermite.cpp (one cell) and network.cpp.
#pragma once
#include <functional>
#include <string>

#include "patches/boolean_sum.h"
#include "patches/coons_hermite.h"
#include "patches/edge_scalar.h"

namespace isoparm {

/// Over [0,m] x [0,n]. Gregory's twist at a corner of a cell is T = (p a + q b) / (p + q), p and q the distances to its edges u =
/// const and v = const, a = d/dv x_u and b = d/du x_v there. The boolean sum carries b; each corner adds -H(u) H(v) (a - b) p / (p + q).
struct HermiteSurface {
    static constexpr Domain domain = Domain::quad;
    BooleanSum<HermiteBasis> sum;
    Grid<Point> jump;  // a - b at node (i,j); empty where all twists agree

    Rect rect() const { return sum.rect(); }
    std::vector<double> breaks_u() const { return sum.breaks_u(); }
    std::vector<double> breaks_v() const { return sum.breaks_v(); }

    template <class U, class V> auto operator()(const U& u, const V& v) const {
        auto x = sum(u, v);
        if (jump.empty() || sum.part == Part::P1 || sum.part == Part::P2) return x;
        const double sign = sum.part == Part::sum ? -1.0 : 1.0;
        const Cells &cells_u = sum.basis_u.cells, &cells_v = sum.basis_v.cells;
        const std::size_t m = cells_u.at(u), n = cells_v.at(v);
        const U s = cells_u.local(m, u);
        const V t = cells_v.local(n, v);
        for (std::size_t i = 0; i < 2; ++i)
            for (std::size_t j = 0; j < 2; ++j) {
                const Point& step = jump[m + i][n + j];
                if (step == Point{}) continue;
                const U p = i == 0 ? s : U(1.0 - s), p_far = i == 0 ? U(1.0 - s) : s;
                const V q = j == 0 ? t : V(1.0 - t), q_far = j == 0 ? V(1.0 - t) : t;
                // H1(p) = p (1-p)^2 at the low end, -H1(p) at the high end; one factor p and q go into the cone
                const double corner = sign * (i == j ? 1.0 : -1.0);
                const auto weight = (square(p_far) * square(q_far)) * cone(SquareOfRadius{}, GregoryRatio{}, p, q);
                x = x + weight * (corner * step);
            }
        return x;
    }
};

/// Curves and cross derivatives in the order of a HermiteBasis, over [0,n] and [0,m].
struct HermiteNetwork {
    std::vector<Curve> f;                                         // f_2i = x(i,.), f_2i+1 = x_u(i,.), i = 0..m
    std::vector<Curve> g;                                         // g_2j = x(.,j), g_2j+1 = x_v(.,j), j = 0..n
    std::function<std::string(char family, std::size_t k)> name;  // of f_k and g_k, for messages
};
/// Gregory's surface near its edges: a surface without rational terms that has the same positions and first derivatives on them. With p and q zero on the two
/// edges at a corner, its term p^2 q / (p + q) is p^2 + ... along p = 0 and p q + ... along q = 0, up to terms of second order in what is zero there; terms of other corners
/// have double zeros on the edge. So along the lines u = const the twists of the g_j do for it (`of_f`), along v = const those of the f_i. The corners are rounded: `slack`, if asked for,
/// becomes what first derivatives may be off by that.
HermiteSurface on_edges(HermiteSurface gregory, bool of_f, double* slack = nullptr);
/// Throws IncompatibleError where positions differ, tangents when `tangents_agree` is asked for (else the cross derivatives give
/// the corner data), and twists when they must be compatible.
HermiteSurface hermite_surface(const HermiteNetwork& network, Twist twist, bool tangents_agree, Part part);

}  // namespace isoparm
