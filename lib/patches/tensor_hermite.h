// patches/tensor_hermite.h -- tensor-product bicubic Hermite surface (Ferguson 1964; seed 003 (6.27); formula sheet A11).
#pragma once
#include "patch.h"
#include "patches/tensor_bezier.h"

namespace isoparm {
/// points[i][j] = x(i,j), du = x_u, dv = x_v, duv = x_uv (empty: 0) at the nodes, i = 0..m, j = 0..n; over [0,m] x [0,n], C1.
/// Throws Error(input) for grids of different shape or less than 2 x 2.
Patch make_tensor_hermite(const Grid<Point>& points, const Grid<Point>& du, const Grid<Point>& dv, const Grid<Point>& duv = {});
}
