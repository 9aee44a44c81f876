// tubes.h -- any curve as cubic Bezier pieces, the form in which Embree draws round tubes.
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "composite.h"
#include "curve.h"
#include "patch.h"

namespace isoparm {

using CubicPiece = std::array<Point, 4>;
/// The straight one from a to d.
inline CubicPiece straight(const Point& a, const Point& d) { return {a, a + (1.0 / 3) * (d - a), a + (2.0 / 3) * (d - a), d}; }

/// A curve to draw: position and derivative over [begin, end], smooth between breaks.
struct DrawnCurve {
    double begin = 0, end = 1;
    std::vector<double> breaks;
    std::function<Point(double)> position;
    std::function<Point(double)> derivative;  // need not be finite
};
DrawnCurve drawn(const Curve& curve);
/// Edge k of a patch.
DrawnCurve drawn_edge(const Patch& patch, int k);
/// The edges of all patches, those that patches share (within 1e-7 size) once.
std::vector<DrawnCurve> drawn_edges(const Composite& patches, double size);

/// Pieces within `tolerance` of the curve (checked at inner points of each piece), tangent to it where they join. A
/// cubic comes back as itself; empty when the curve is shorter than the tolerance.
std::vector<CubicPiece> cubic_pieces(const DrawnCurve& curve, double tolerance);

}  // namespace isoparm
