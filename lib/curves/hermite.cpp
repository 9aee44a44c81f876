#include "curves/hermite.h"

#include "curves/piecewise_bezier.h"
#include "error.h"

namespace isoparm {

Curve make_hermite(const std::vector<Point>& points, const std::vector<Point>& tangents) {
    if (points.size() < 2) throw_input("found " + std::to_string(points.size()) + " points, expected at least two");
    if (tangents.size() != points.size())
        throw_input("found " + std::to_string(tangents.size()) + " tangents for " + std::to_string(points.size()) + " points, expected one tangent a point");
    std::vector<BezierPiece> pieces;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        pieces.push_back({double(i), double(i + 1), {points[i], points[i] + tangents[i] / 3.0, points[i + 1] - tangents[i + 1] / 3.0, points[i + 1]}, {}});
    return make_piecewise_bezier(std::move(pieces), std::vector<int>(points.size() - 2, 1));
}

}  // namespace isoparm
