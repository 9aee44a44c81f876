// patches/side_vertex.h -- side-vertex Coons surface on a triangle (Nielson 1979; seed 000 (3); formula sheet B1).
#pragma once
#include <array>

#include "patch.h"

namespace isoparm {
/// delta: uA + vB + wC + sum H(1-u_k) (E_k - chord_k), affine invariant for every H. seed: equation (3) as printed,
/// affine invariant only when H(t) - t is symmetric; the two agree when H is quadratic.
enum class SideVertexForm { delta, seed };

/// The surface is s1 + s2 + s3 - 2 s4. form seed: s1 = H(1-v) E2(tau2) + H(v) B, s2 and s3 the same over E3 and E1 (the order of the
/// source), s4 = H(u) A + H(v) B + H(w) C; with H = t these are the ruled surfaces and the plane triangle of seed 000. form delta:
/// s4 = uA + vB + wC, s1 = s4 + H(1-v) (E2 - chord): the plane triangle with one edge bent. The forms have the same parts when H = t.
enum class SideVertexPart { sum, s1, s2, s3, s4 };

/// edges E1: B to C, E2: C to A, E3: A to B, each run over [0,1]. H(0) = 0 exactly and without a jump, H(1) = 1 within 1e-12. C1 at the vertices when H'(0) = 0,
/// otherwise a cone point there. Interpolates the edges; s1 the edge E2, s2 E3, s3 E1.
/// Throws IncompatibleError when the edges do not close or H has other end values.
Patch make_side_vertex(const std::array<Curve, 3>& edges, const Function& H, SideVertexForm form = SideVertexForm::delta,
                       SideVertexPart part = SideVertexPart::sum);
}
