// patches/control_net.h -- the surface of a discrete Coons net: control points between four control polygons (Farin 2002, 22.7;
// formula sheet A10).
#pragma once
#include <vector>

#include "patch.h"
#include "patches/tensor_bezier.h"

namespace isoparm {
/// A polynomial spline by its control points; a Bezier curve has the knots 0 (degree + 1 times), 1 (degree + 1 times).
struct SplineCurve {
    int degree = 0;
    std::vector<double> knots;
    std::vector<Point> points;
};
struct ControlFrame {
    SplineCurve c0, c1, d0, d1;
};
/// Net between the polygons, blended at the Greville abscissae, so that its surface is the bilinear Coons patch of the curves.
/// Opposite curves have the same degree and knots; the surface is over [0,1]^2. Throws IncompatibleError, Error(input).
Grid<Point> coons_net(const ControlFrame& frame);
Patch make_control_net(const ControlFrame& frame);
}
