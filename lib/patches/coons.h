// patches/coons.h -- Coons patch with the blend H: (1-H)(u) x(0,v) + H(u) x(1,v) (+) the same in v; C0 at its boundary
// (Coons 1967; Farin 2002, 22.1-22.3; formula sheet A2, A3). Cubic H = 3t^2 - 2t^3 gives the partially bicubic patch.
#pragma once
#include <optional>

#include "patch.h"
#include "patches/boolean_sum.h"

namespace isoparm {
struct CoonsCurves {
    Curve c0, c1, d0, d1;  // x(u,0), x(u,1), x(0,v), x(1,v); each is run over [0,1] whatever its own domain
};
/// The four curves run over [0,1]. Throws IncompatibleError when they do not meet at a corner within 1e-9 of their size.
CoonsCurves closed_frame(const CoonsCurves& curves);

/// `blend` empty: linear. Throws IncompatibleError when curves do not meet, and when the blend does not take 0 to 0 and 1 to 1.
Patch make_coons(const CoonsCurves& curves, const std::optional<Function>& blend = {}, Part part = Part::sum);
/// 3t^2 - 2t^3
Function cubic_blend();
}
