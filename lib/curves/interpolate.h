// curves/interpolate.h -- cubic spline through points[i] at t = i, over [0,n] (Farin 2002, ch. 9; Catmull and Rom 1974).
#pragma once
#include <vector>

#include "curve.h"

namespace isoparm {
/// natural: C2, second derivative 0 at the ends. clamped: C2, end tangents by Bessel's rule (the parabola through the
/// first, last three points). catmull_rom: C1, tangents (p[i+1]-p[i-1])/2, one-sided at the ends so that the end
/// segments have no third derivative (the rule of (6.25)).
enum class SplineEnds { natural, clamped, catmull_rom };
Curve make_interpolate(const std::vector<Point>& points, SplineEnds ends);
}
