#include "patches/side_vertex.h"

#include <limits>

#include "patch_model.h"
#include "patches/triangle_edges.h"
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
    SideVertexPart part;

    template <class U, class V, class W> auto operator()(const U& u, const V& v, const W& w) const {
        return form == SideVertexForm::delta ? delta(u, v, w) : seed(u, v, w);
    }
    template <class U, class V, class W> auto delta(const U& u, const V& v, const W& w) const {
        const auto plane = u * A + v * B + w * C;
        const auto bent1 = [&] { return cone(H, Bulge{E[0], B, C}, w, v); };
        const auto bent2 = [&] { return cone(H, Bulge{E[1], C, A}, u, w); };
        const auto bent3 = [&] { return cone(H, Bulge{E[2], A, B}, v, u); };
        switch (part) {
            case SideVertexPart::s1: return plane + bent2();
            case SideVertexPart::s2: return plane + bent3();
            case SideVertexPart::s3: return plane + bent1();
            case SideVertexPart::s4: return plane;
            default: return plane + bent1() + bent2() + bent3();
        }
    }
    template <class U, class V, class W> auto seed(const U& u, const V& v, const W& w) const {
        using Sum = decltype(u * A + v * B + w * C);
        switch (part) {
            case SideVertexPart::s1: return Sum(cone(H, E[1], u, w) + H(v) * B);
            case SideVertexPart::s2: return Sum(cone(H, E[2], v, u) + H(w) * C);
            case SideVertexPart::s3: return Sum(cone(H, E[0], w, v) + H(u) * A);
            case SideVertexPart::s4: return Sum(H(u) * A + H(v) * B + H(w) * C);
            default: return Sum(cone(H, E[1], u, w) + cone(H, E[2], v, u) + cone(H, E[0], w, v) - (H(u) * A + H(v) * B + H(w) * C));
        }
    }
};

}  // namespace

Patch make_side_vertex(const std::array<Curve, 3>& edges, const Function& H, SideVertexForm form, SideVertexPart part) {
    const TriangleEdges t(edges);
    // No rounding here: H(0) is how far the surface is torn at a vertex, and cone() takes it for 0.
    constexpr double nothing = std::numeric_limits<double>::min();
    if (const double gap = std::abs(H(0)); !(gap <= nothing)) throw IncompatibleError("H(0) = 0", gap, nothing);
    // Nor may H jump there: next to 0 it is as small as the interval shows it to be.
    Interval near;
    H.taylor(Interval(0, 1e-300), 0, &near);
    if (const double gap = mag(near); !(gap <= 1e-12)) throw IncompatibleError("H(t) -> 0 for t -> 0", gap, 1e-12);
    if (const double gap = std::abs(H(1) - 1); !(gap <= 1e-12)) throw IncompatibleError("H(1) = 1", gap, 1e-12);
    return make_patch(SideVertex{t.E, t.V[0], t.V[1], t.V[2], H, form, part});
}

}  // namespace isoparm
