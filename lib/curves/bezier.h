// curves/bezier.h -- Bezier curve of degree points-1 over [0,1], rational when weights are given (Farin 2002, ch. 5, 13).
#pragma once
#include <vector>

#include "curve.h"

namespace isoparm {
/// 1 to 33 points; no weights, or one positive weight a point. Throws Error(input).
Curve make_bezier(std::vector<Point> points, std::vector<double> weights = {});
}
