// patches/translational.h -- translational surface c(u) + d(v) - a, and the convex combination of the four of a frame (Farin 2002,
// 22.6; formula sheet A9).
#pragma once
#include "patch.h"
#include "patches/coons.h"

namespace isoparm {
/// c and d, each run over [0,1], start at the same point. Throws IncompatibleError.
Patch make_translational(const Curve& c, const Curve& d);
/// [1-u u] [t_ij] [1-v v]^T with the translational surfaces t_ij of the frame's corners; equal to its bilinearly blended Coons patch.
Patch make_translational_blend(const CoonsCurves& curves);
}
