#include "patches/three_curves.h"

#include "patch_model.h"
#include "patches/triangle_edges.h"

namespace isoparm {
namespace {

struct ThreeCurves {
    static constexpr Domain domain = Domain::triangle;
    std::array<Curve, 3> E;
    Point A, B, C;

    /// The translational surface of each vertex: one edge that leaves it and one that arrives, moved along each other.
    template <class U, class V, class W> auto operator()(const U& u, const V& v, const W& w) const {
        const auto at_A = E[2](v) + (E[1](from_other_end(w)) - A);
        const auto at_B = E[0](w) + (E[2](from_other_end(u)) - B);
        const auto at_C = E[1](u) + (E[0](from_other_end(v)) - C);
        return u * at_A + v * at_B + w * at_C;
    }
};

}  // namespace

Patch make_three_curves(const std::array<Curve, 3>& edges) {
    const TriangleEdges t(edges);
    return make_patch(ThreeCurves{t.E, t.V[0], t.V[1], t.V[2]});
}

}  // namespace isoparm
