#include "curves/bezier.h"

#include "curves/piecewise_bezier.h"

namespace isoparm {
Curve make_bezier(std::vector<Point> points, std::vector<double> weights) {
    return make_piecewise_bezier({{0, 1, std::move(points), std::move(weights)}}, {});
}
}  // namespace isoparm
