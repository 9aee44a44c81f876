#include "patches/side_vertex.h"

#include <limits>

#include "patch_model.h"
#include "patches/compatibility.h"
#include "scalar/cone.h"

namespace isoparm {
namespace {

/// E(t) - chord(t): what an edge adds to its chord.
struct Bulge {
    const Curve& edge;
    const Point &from, &to;
    template <class S> auto operator()(const S& t) const { return edge(t) - ((1.0 - t) * from + t * to); }
    double size() const { return length(from) + length(to); }  // of the terms, whose difference may vanish
};

struct SideVertex {
    static constexpr Domain domain = Domain::triangle;
    std::array<Curve, 3> E;
    Point A, B, C;
    Function H;
    SideVertexForm form;

    template <class U, class V, class W> auto operator()(const U& u, const V& v, const W& w) const {
        if (form == SideVertexForm::delta)
            return (u * A + v * B + w * C) + cone(H, Bulge{E[0], B, C}, w, v) + cone(H, Bulge{E[1], C, A}, u, w) + cone(H, Bulge{E[2], A, B}, v, u);
        return cone(H, E[1], u, w) + cone(H, E[2], v, u) + cone(H, E[0], w, v) - (H(u) * A + H(v) * B + H(w) * C);
    }
};

}  // namespace

Patch make_side_vertex(const std::array<Curve, 3>& edges, const Function& H, SideVertexForm form) {
    const std::array<Curve, 3> E{reparametrized(edges[0], 0, 1), reparametrized(edges[1], 0, 1), reparametrized(edges[2], 0, 1)};
    const double size = size_of({&E[0], &E[1], &E[2]});
    require_equal("E1(1) = E2(0) (vertex C)", E[0](1), E[1](0), size);
    require_equal("E2(1) = E3(0) (vertex A)", E[1](1), E[2](0), size);
    require_equal("E3(1) = E1(0) (vertex B)", E[2](1), E[0](0), size);
    // No rounding here: H(0) is how far the surface is torn at a vertex, and cone() takes it for 0.
    constexpr double nothing = std::numeric_limits<double>::min();
    if (const double gap = std::abs(H(0)); !(gap <= nothing)) throw IncompatibleError("H(0) = 0", gap, nothing);
    if (const double gap = std::abs(H(1) - 1); !(gap <= 1e-12)) throw IncompatibleError("H(1) = 1", gap, 1e-12);
    return make_patch(SideVertex{E, E[2](0), E[0](0), E[1](0), H, form});
}

}  // namespace isoparm
