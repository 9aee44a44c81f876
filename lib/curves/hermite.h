// curves/hermite.h -- C1 cubic spline through points[i] with tangents[i] at t = i, over [0,n] (Farin 2002, 7.5).
#pragma once
#include <vector>

#include "curve.h"

namespace isoparm {
/// At least two points and as many tangents. Throws Error(input).
Curve make_hermite(const std::vector<Point>& points, const std::vector<Point>& tangents);
}
