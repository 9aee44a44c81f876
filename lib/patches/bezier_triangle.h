// patches/bezier_triangle.h -- triangular Bezier patch, polynomial or rational (Farin 2002, ch. 17).
#pragma once
#include <vector>

#include "patch.h"

namespace isoparm {
/// (n+1)(n+2)/2 points in rows from the edge w=0 (A to B) towards C, each row from A towards B: row k has the points
/// b_(n-k-j, j, k). Weights empty or positive. Throws Error(input).
Patch make_bezier_triangle(int degree, const std::vector<Point>& points, const std::vector<double>& weights = {});
}
