// patches/hermite_patch.h -- the formula of the bicubically blended Coons patch with Gregory's twists; shared by
// coons_hermite.cpp (one patch) and network.cpp (a cell of a network).
#pragma once
#include <array>

#include "patch.h"
#include "patches/boolean_sum.h"
#include "scalar/cone.h"

namespace isoparm {

struct SquareOfRadius {
    template <class S> S operator()(const S& r) const { return square(r); }
};
/// tau^2 (1 - tau): with H = r^2 the function a^2 b / (a + b)
struct GregoryRatio {
    template <class S> S operator()(const S& tau) const { return square(tau) * (1.0 - tau); }
};

/// Gregory's twist at a corner is T = (p a + q b) / (p + q), p and q the distances to the edges u = const and v = const,
/// a = d/dv x_u and b = d/du x_v there. The boolean sum carries b; each corner adds -H(u) H(v) (a - b) p / (p + q).
struct HermitePatch {
    static constexpr Domain domain = Domain::quad;
    BooleanSum<HermiteBasis> sum;
    std::array<std::array<Point, 2>, 2> jump{};  // a - b at corner (i,j); 0 where the twists agree

    std::vector<double> breaks_u() const { return sum.breaks_u(); }
    std::vector<double> breaks_v() const { return sum.breaks_v(); }

    template <class U, class V> auto operator()(const U& u, const V& v) const {
        auto x = sum(u, v);
        if (sum.part == Part::P1 || sum.part == Part::P2) return x;
        const double sign = sum.part == Part::sum ? -1.0 : 1.0;
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j) {
                if (jump[i][j] == Point{}) continue;
                const U p = i == 0 ? u : U(1.0 - u), p_far = i == 0 ? U(1.0 - u) : u;
                const V q = j == 0 ? v : V(1.0 - v), q_far = j == 0 ? V(1.0 - v) : v;
                // H1(p) = p (1-p)^2 at the low end, -H1(p) at the high end; one factor p and q go into the cone
                const double corner = sign * (i == j ? 1.0 : -1.0);
                const auto weight = (square(p_far) * square(q_far)) * cone(SquareOfRadius{}, GregoryRatio{}, p, q);
                x = x + weight * (corner * jump[i][j]);
            }
        return x;
    }
};

}  // namespace isoparm
