#include "patches/bbg.h"

#include "curves/difference.h"
#include "patch_model.h"
#include "patches/triangle_edges.h"

namespace isoparm {
namespace {

/// On the line u = const the projector P1 is the chord from E2(u) to E3(1-u): with r = v/(1-u)
///     P1 = E2(u) + r (E3(1-u) - E2(u)) = E2(u) + v (first3(1-u) + last2(u)),
/// first and last the divided differences of an edge with its ends, as both edges end in A. So nothing is divided by 1-u.
/// P2 and P3 cyclically.
struct Bbg {
    static constexpr Domain domain = Domain::triangle;
    std::array<Curve, 3> E, first, last;
    std::array<Point, 3> V;
    BbgForm form;

    struct Projector {
        const Bbg& s;
        template <class X, class Y, class Z> auto operator()(int k, const X& x, const Y& y, const Z&) const {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            return s.E[i](x) + y * (s.first[j](from_other_end(x)) + s.last[i](x));
        }
    };
    /// Pi - Pi Pj: what Pi makes of the one edge that Pj replaces by its chord, less the chord.
    struct Missing {
        const Bbg& s;
        bool next;  // j = i + 1, otherwise i + 2
        template <class X, class Y, class Z> auto operator()(int k, const X& x, const Y& y, const Z& z) const {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            using Sum = decltype(y * s.E[i](x) + z * s.E[i](x));
            return next ? Sum(z * ((s.V[k] - s.V[j]) - s.last[i](x))) : Sum(y * (s.first[j](from_other_end(x)) - (s.V[i] - s.V[k])));
        }
    };

    template <class U, class V_, class W> auto operator()(const U& u, const V_& v, const W& w) const {
        const auto P = [&](int k) { return turned(k, Projector{*this}, u, v, w); };
        const auto missing = [&] { return turned(form.i - 1, Missing{*this, form.j == form.i % 3 + 1}, u, v, w); };
        switch (form.kind) {
            case BbgForm::Kind::convex: return u * P(0) + v * P(1) + w * P(2);
            case BbgForm::Kind::boolean: return P(form.j - 1) + missing();
            case BbgForm::Kind::symmetric: return 0.5 * (P(0) + P(1) + P(2) - (u * V[0] + v * V[1] + w * V[2]));
            case BbgForm::Kind::product: return P(form.i - 1) - missing();
            default: return P(form.i - 1);
        }
    }
};

}  // namespace

Patch make_bbg(const std::array<Curve, 3>& edges, const BbgForm& form) {
    const TriangleEdges t(edges);
    const auto is_projector = [](int i) { return i >= 1 && i <= 3; };
    const bool two = form.kind == BbgForm::Kind::boolean || form.kind == BbgForm::Kind::product;
    if (!is_projector(form.i) || (two && (!is_projector(form.j) || form.i == form.j)))
        throw_input("found the projectors P" + std::to_string(form.i) + " and P" + std::to_string(form.j) + ", expected two different ones of P1, P2, P3");
    const auto differences = [&](CurveEnd end) {
        return std::array<Curve, 3>{divided_difference(t.E[0], end), divided_difference(t.E[1], end), divided_difference(t.E[2], end)};
    };
    return make_patch(Bbg{t.E, differences(CurveEnd::first), differences(CurveEnd::last), t.V, form});
}

}  // namespace isoparm
