// patches/three_curves.h -- triangle over three curves: the convex combination of its vertices' translational surfaces (seed 003
// (6.28); formula sheet B2).
#pragma once
#include <array>

#include "patch.h"

namespace isoparm {
/// edges E1: B to C, E2: C to A, E3: A to B, each run over [0,1]. Interpolates them; polynomial when they are. Throws IncompatibleError.
Patch make_three_curves(const std::array<Curve, 3>& edges);
}
