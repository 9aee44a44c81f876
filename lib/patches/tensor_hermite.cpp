#include "patches/tensor_hermite.h"

#include "error.h"
#include "patches/boolean_sum.h"

namespace isoparm {
namespace {

void require_shape(const char* name, const Grid<Point>& grid, const Grid<Point>& points) {
    bool same = grid.size() == points.size();
    for (std::size_t i = 0; same && i < grid.size(); ++i) same = grid[i].size() == points[0].size();
    if (!same)
        throw_input(std::string(name) + ": found a grid of another shape, expected " + std::to_string(points.size()) + " rows of " + std::to_string(points[0].size()) + " as in points");
    for (const auto& row : grid)
        for (const Point& p : row)
            if (!finite(p)) throw_input(std::string(name) + ": found a number that is not finite");
}

}  // namespace

Patch make_tensor_hermite(const Grid<Point>& points, const Grid<Point>& du, const Grid<Point>& dv, const Grid<Point>& duv) {
    if (points.size() < 2 || points[0].size() < 2) throw_input("points: found a grid smaller than 2 x 2, expected at least two nodes each way");
    require_shape("points", points, points);
    require_shape("du", du, points);
    require_shape("dv", dv, points);
    if (!duv.empty()) require_shape("duv", duv, points);
    const std::size_t m = points.size() - 1, n = points[0].size() - 1;
    // P1 P2 alone: [a0 b0 a1 b1](u) M [a0 b0 a1 b1](v)^T in the cell, M of values and derivatives at its corners.
    Grid<Point> corner(2 * m + 2, std::vector<Point>(2 * n + 2));
    for (std::size_t i = 0; i <= m; ++i)
        for (std::size_t j = 0; j <= n; ++j) {
            corner[2 * i][2 * j] = points[i][j];
            corner[2 * i + 1][2 * j] = du[i][j];
            corner[2 * i][2 * j + 1] = dv[i][j];
            corner[2 * i + 1][2 * j + 1] = duv.empty() ? Point{} : duv[i][j];
        }
    return make_patch(BooleanSum<HermiteBasis>{HermiteBasis(m), HermiteBasis(n), {}, {}, std::move(corner), Part::P1P2, {0, double(m), 0, double(n)}});
}

}  // namespace isoparm
