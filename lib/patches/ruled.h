// patches/ruled.h -- ruled surface (1-v) c0(u) + v c1(u) (formula sheet A2).
#pragma once
#include "patch.h"

namespace isoparm {
/// Both curves are run over [0,1].
Patch make_ruled(const Curve& c0, const Curve& c1);
}
