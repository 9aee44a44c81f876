// patches/side_vertex.h -- side-vertex Coons surface on a triangle (Nielson 1979; seed 000 (3); formula sheet B1).
#pragma once
#include <array>

#include "patch.h"

namespace isoparm {
/// delta: uA + vB + wC + sum H(1-u_k) (E_k - chord_k), affine invariant for every H. seed: equation (3) as printed,
/// affine invariant only when H(t) - t is symmetric; the two agree when H is quadratic.
enum class SideVertexForm { delta, seed };

/// edges E1: B to C, E2: C to A, E3: A to B, each run over [0,1]. H(0) = 0 exactly, H(1) = 1 within 1e-12. C1 at the vertices when H'(0) = 0,
/// otherwise a cone point there. Throws IncompatibleError when the edges do not close or H has other end values.
Patch make_side_vertex(const std::array<Curve, 3>& edges, const Function& H, SideVertexForm form = SideVertexForm::delta);
}
