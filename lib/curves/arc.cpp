#include "curves/arc.h"

#include "curves/piecewise_bezier.h"
#include "error.h"

namespace isoparm {
namespace {

/// Rational quadratic from center + a to center + b, |a| = |b|, with the half angle's cosine as middle weight.
BezierPiece quarter(const Point& center, const Point& a, const Point& b, double begin, double end) {
    const double cosine = dot(a, b) / (length(a) * length(b));
    return {begin, end, {center + a, center + (a + b) / (1 + cosine), center + b}, {1, std::sqrt((1 + cosine) / 2), 1}};
}

}  // namespace

Curve make_arc(const Point& center, const Point& start, const Point& end) {
    const Point a = start - center, b = end - center;
    const double r = length(a), tolerance = 1e-9 * (r + length(b));
    if (!(r > 0) || !(length(b) > 0)) throw_input("an arc needs a start and an end away from its center");
    if (std::abs(r - length(b)) > tolerance) throw IncompatibleError("arc: start and end are not equally far from the center", std::abs(r - length(b)), tolerance);
    const double chord = length(b - a), across = length(a + b);
    if (!(chord > tolerance)) throw_input("an arc needs a start and an end that differ");
    if (!(across > tolerance)) throw_input("start and end of the arc are opposite: no minor arc; give two arcs");
    if (dot(a, b) >= -1e-12 * r * r) return make_piecewise_bezier({quarter(center, a, b, 0, 1)}, {});
    const Point middle = (r / across) * (a + b);
    return make_piecewise_bezier({quarter(center, a, middle, 0, 0.5), quarter(center, middle, b, 0.5, 1)}, {1});
}

}  // namespace isoparm
