// patches/tensor_bezier.h -- tensor product Bezier and B-spline patches, polynomial or rational (Farin 2002, ch. 14-16).
#pragma once
#include <vector>

#include "patch.h"

namespace isoparm {
template <class T> using Grid = std::vector<std::vector<T>>;  // grid[i][j], i along u

/// points[i][j], i along u, degree (rows-1, columns-1); weights empty or positive of the same shape. Throws Error(input).
Patch make_bezier_patch(const Grid<Point>& points, const Grid<double>& weights = {});

/// Over [knots_u[p], knots_u[m]] x [knots_v[q], knots_v[n]]; knots as in make_bspline. Throws Error(input).
Patch make_bspline_patch(int degree_u, int degree_v, const std::vector<double>& knots_u, const std::vector<double>& knots_v,
                         const Grid<Point>& points, const Grid<double>& weights = {});
}
