// patches/triangle_edges.h -- three curves that close to a triangle: what every surface over them begins with.
#pragma once
#include <array>

#include "patches/compatibility.h"
#include "scalar/polynomial.h"

namespace isoparm {

struct TriangleEdges {
    std::array<Curve, 3> E;  // E1: B to C, E2: C to A, E3: A to B, each over [0,1]
    std::array<Point, 3> V;  // A, B, C
    double size;             // what gaps between positions are relative to

    /// Throws IncompatibleError, naming the vertex, when the edges do not close.
    explicit TriangleEdges(const std::array<Curve, 3>& edges)
        : E{reparametrized(edges[0], 0, 1), reparametrized(edges[1], 0, 1), reparametrized(edges[2], 0, 1)},
          V{E[2](0), E[0](0), E[1](0)},
          size(size_of({&E[0], &E[1], &E[2]})) {
        require_equal("E1(1) = E2(0) (vertex C)", E[0](1), E[1](0), size);
        require_equal("E2(1) = E3(0) (vertex A)", E[1](1), E[2](0), size);
        require_equal("E3(1) = E1(0) (vertex B)", E[2](1), E[0](0), size);
    }
};

/// 1 - t, kept inside [0,1] where rounding outward would leave it.
template <class T, int I, int J, int N> Jet<T, I, J, N> from_other_end(const Jet<T, I, J, N>& t) { return kept_in(1.0 - t, 0, 1); }
inline Polynomial from_other_end(const Polynomial& t) { return Polynomial(1) - t; }

/// f(k, x, y, z) for k = 0, 1, 2 with the barycentric coordinates turned so that x belongs to vertex k. f returns the same type for all k.
template <class F, class U, class V, class W> auto turned(int k, const F& f, const U& u, const V& v, const W& w) {
    return k == 0 ? f(0, u, v, w) : k == 1 ? f(1, v, w, u) : f(2, w, u, v);
}

}  // namespace isoparm
