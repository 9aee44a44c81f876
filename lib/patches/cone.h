// patches/cone.h -- the cone over a curve: rulings from each of its points to an apex.
#pragma once
#include "patch.h"

namespace isoparm {
/// (1-v) curve(u) + v apex, the curve run over [0,1]; the edge v = 1 is the apex. Throws Error(input).
Patch make_cone(const Curve& curve, const Point& apex);
}
