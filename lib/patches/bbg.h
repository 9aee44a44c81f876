// patches/bbg.h -- Barnhill, Birkhoff and Gordon's interpolants on a triangle by lines parallel to its edges: C0 (1973; formula
// sheet B3) and C1 (B5).
#pragma once
#include <array>

#include "patch.h"
#include "patches/triangle_part.h"

namespace isoparm {
/// convex: u P1 + v P2 + w P3; boolean: Pi (+) Pj = Pi + Pj - Pi Pj (the order matters); symmetric: (P1 + P2 + P3 - L) / 2;
/// projector: Pi alone; product: Pi Pj, which is Pi with the edge that Pj misses replaced by its chord.
struct BbgForm {
    enum class Kind { convex, boolean, symmetric, projector, product } kind = Kind::convex;
    int i = 1, j = 2;  // which projectors, 1 to 3
};
/// edges E1: B to C, E2: C to A, E3: A to B, each run over [0,1]. Interpolates them (a projector: two of them). Throws IncompatibleError.
Patch make_bbg(const std::array<Curve, 3>& edges, const BbgForm& form);

/// cross[k] = D_k: derivative of the surface along E_k in the direction of the median, from the middle of the edge to the vertex
/// opposite. The sum is the combination of the projectors with the weights u^2 (3 - 2u + 6vw).
/// C1 with any twists; second derivatives at vertices depend on the direction. Edges must be C1: Error(input) otherwise.
/// Throws IncompatibleError when edges do not close or D_k(0), D_k(1) contradict the tangents of the neighbouring edges.
Patch make_bbg_c1(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& cross, TrianglePart part = TrianglePart::sum);
}
