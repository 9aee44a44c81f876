// curves/quotient.h -- slopes of rational Bezier curves as rational Bezier curves: exact, and without cancellation where a quotient is 0/0.
#pragma once
#include <optional>

#include "curves/difference.h"
#include "curves/piecewise_bezier.h"

namespace isoparm {

/// E'. Of degree 2n over the square of the weights' polynomial (Sederberg and Wang 1987; Floater 1992). Nothing when 2n > max_degree.
std::optional<Curve> rational_derivative(const PiecewiseBezier& c);

/// (E(t) - E(e)) / (t - e). The piece that holds the end keeps its degree and weights, the others gain a degree, as t - e joins their weights.
/// Nothing when that exceeds max_degree.
std::optional<Curve> rational_difference(const PiecewiseBezier& c, CurveEnd end);

}  // namespace isoparm
