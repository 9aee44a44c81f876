// curves/arc.h -- the minor circular arc from start to end about center, exact as a rational quadratic, over [0,1].
#pragma once
#include "curve.h"

namespace isoparm {
/// Weights (1, cos(half angle), 1); arcs of more than 90 degrees have two such pieces. Throws IncompatibleError when the
/// two radii differ and Error(input) when start and end are opposite (no minor arc) or coincide.
Curve make_arc(const Point& center, const Point& start, const Point& end);
}
