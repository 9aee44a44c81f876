#include "curves/difference.h"
#include "curves/modify.h"
#include "patch_model.h"
#include "patches/bbg.h"
#include "patches/cross_data.h"
#include "patches/edge_series.h"
#include "scalar/cone.h"

namespace isoparm {
namespace {

/// On the line u = const of length 1-u = v+w, with r = v/(1-u), P1 is the cubic Hermite interpolant of positions and derivatives along e2 - e3:
///     P1 = H0(r) E2(u) + H1(r) (1-u) F2(u) + H2(r) (1-u) F3(u) + H3(r) E3(1-u),   F2(u) = D2(u) + E2'(u)/2,   F3(u) = -D3(1-u) + E3'(1-u)/2.
/// With Q = (E3(1-u) - E2(u))/(1-u) and as H1 + H2 + H3 = r that is E2 + v Q + (1-u) (H1(r) (F2 - Q) + H2(r) (F3 - Q)). At the vertex A both
/// differences vanish (compatibility), so they are u - 1 times their divided differences G2, G3 with the end u = 1:
///     P1 = E2(u) + v Q(u) - v w^2/(v+w) G2(u) + v^2 w/(v+w) G3(u),
/// C1 at A, with second derivatives that depend on the direction. P2 and P3 cyclically.
struct BbgC1 {
    static constexpr Domain domain = Domain::triangle;
    std::array<Curve, 3> E, Q, G2, G3;  // of P1, P2, P3
    TrianglePart part;

    struct Projector {
        const BbgC1& s;
        template <class X, class Y, class Z> auto operator()(int k, const X& x, const Y& y, const Z& z) const {
            return s.E[(k + 1) % 3](x) + y * s.Q[k](x) + (cone(SquareOfRadius{}, GregoryRatio{}, y, z) * s.G3[k](x) - cone(SquareOfRadius{}, GregoryRatio{}, z, y) * s.G2[k](x));
        }
    };
    template <class U, class V, class W> auto operator()(const U& u, const V& v, const W& w) const {
        const auto P = [&](int k) { return turned(k, Projector{*this}, u, v, w); };
        if (part != TrianglePart::sum) return P(vertex_of(part));
        // Weights with double zeros on the edges that a projector misses; their sum is 1.
        const auto weight = [&](const auto& x, const auto& y, const auto& z) { return square(x) * (3.0 - 2.0 * x + 6.0 * y * z); };
        return weight(u, v, w) * P(0) + weight(v, w, u) * P(1) + weight(w, u, v) * P(2);
    }
    std::vector<Polynomial> beside(int e) const;
};

/// The sum beside edge e; its cones are a^2 b / (a + b).
std::vector<Polynomial> BbgC1::beside(int e) const {
    const EdgeFrame f;
    Series b[3];
    b[e] = f.U, b[(e + 1) % 3] = f.V, b[(e + 2) % 3] = f.W;
    const auto ratio = [&](int i, int j) {
        if (i == e) return f.U * f.U;
        return j == e ? f.U * b[i] - f.U * f.U : b[i] * b[i] * b[j] * f.inverse_r;
    };
    Series3 sum;
    for (int k = 0; k < 3; ++k) {
        const int y = (k + 1) % 3, z = (k + 2) % 3;
        const Polynomial3 on = form_of(E[y]), q = form_of(Q[k]), low = form_of(G2[k]), high = form_of(G3[k]);
        if (!exists(on) || !exists(q) || !exists(low) || !exists(high)) return {};
        const Series weight = b[k] * b[k] * (Series(3) - Series(2) * b[k] + Series(6) * b[y] * b[z]);
        sum += weight * (at(on, b[k]) + b[y] * at(q, b[k]) + (ratio(y, z) * at(high, b[k]) - ratio(z, y) * at(low, b[k])));
    }
    return EdgeForm(sum).list({0, 1});
}

}  // namespace

Patch make_bbg_c1(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& cross, TrianglePart part) {
    const CrossData d(edges, cross);
    std::vector<Curve> Q, G2, G3;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const Curve &on = d.E[i], back = reversed(d.E[j]);  // both end in the vertex k
        const auto difference = [](const Curve& c, int times = 1) { return divided_difference(c, CurveEnd::last, times); };
        Q.push_back(linear_combination({1, -1}, {difference(on), difference(back)}));
        // Differences are linear, and those of Q are second ones of the edges.
        const std::vector<Curve> of_Q{difference(on, 2), difference(back, 2)};
        G2.push_back(linear_combination({1, 0.5, -1, 1}, {difference(d.D[i]), difference(d.slope[i]), of_Q[0], of_Q[1]}));
        G3.push_back(linear_combination({-1, 0.5, -1, 1}, {difference(reversed(d.D[j])), difference(reversed(d.slope[j])), of_Q[0], of_Q[1]}));
    }
    const BbgC1 formula{d.E, {Q[0], Q[1], Q[2]}, {G2[0], G2[1], G2[2]}, {G3[0], G3[1], G3[2]}, part};
    if (part != TrianglePart::sum) return make_patch(formula);
    return with_triangle_forms(make_patch(formula), [formula](int edge, std::size_t part) { return part == 0 ? formula.beside(edge) : std::vector<Polynomial>{}; });
}

}  // namespace isoparm
