// curves/bspline.h -- B-spline or NURBS curve over [knots[degree], knots[n]] (Piegl and Tiller 1997, ch. 3-5).
#pragma once
#include <vector>

#include "curve.h"
#include "curves/piecewise_bezier.h"

namespace isoparm {
/// n points, n + degree + 1 knots that do not decrease, no interior knot more than `degree` times; weights empty or one
/// positive number a point. Converted once to Bezier pieces by knot insertion (Boehm 1980). Throws Error(input).
Curve make_bspline(int degree, const std::vector<double>& knots, const std::vector<Point>& points, const std::vector<double>& weights = {});

/// Throws Error(input) unless the knot vector fits; `what` names it in the message.
void check_knots(int degree, const std::vector<double>& knots, std::size_t points, const std::string& what);

/// Knot insertion to Bezier form: row-wise linear map that both curves and surfaces use. Spans with begin < end only.
struct BezierSpan {
    double begin, end;
    int continuity_after;                          // at `end`; meaningless for the last span
    std::vector<std::vector<double>> rows;         // Bezier point i = sum_k rows[i][k] * control[first + k]
    int first = 0;
};
std::vector<BezierSpan> bezier_spans(int degree, const std::vector<double>& knots, std::size_t points);
}
