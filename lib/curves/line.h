// curves/line.h -- straight segment p0 + t (p1 - p0), t in [0,1].
#pragma once
#include "curve.h"

namespace isoparm {
Curve make_line(const Point& p0, const Point& p1);
}
