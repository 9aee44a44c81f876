// limit_spline.h -- a patch over a rectangle as the limit of a cage: the uniform bicubic B-spline through a grid of its points is the Catmull-Clark limit of its control points.
//
// Source: de Boor, A Practical Guide to Splines, 1978 (complete spline interpolation: error O(h^4)); Catmull & Clark 1978.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "cage.h"
#include "composite.h"

namespace isoparm {

/// m x n cells: (m + 3) x (n + 3) control points, point (i,j) at (m + 3) j + i, of the spline that has the patch's points at the corners of the cells, its
/// derivatives across the boundary there, and its twists at the four corners. The outer faces of the cage have no limit (Boundary::none); face (i,j), at (m + 2) j + i,
/// is over cell (i - 1, j - 1). Throws Error(input) for a patch on a triangle, and where these derivatives do not exist. m, n >= 1.
Cage interpolating_cage(const Patch& patch, int m, int n);

struct SplineLevel {
    int m, n;
    double deviation;                      // at equal parameters; sampled
    std::optional<double> normal_degrees;
    std::optional<double> ratio;           // of the deviation before to this one: 16 in the limit where the patch has four continuous derivatives
};
struct SplineReport {
    std::string name, refused;
    std::vector<SplineLevel> levels;  // the patch's own cells (where its breaks are evenly spaced, else one), then ever twice as many each way
    Cage finest;                      // of the last level
};
/// OpenSubdiv's limit of the cages against the patch, at `samples` x `samples` points a cell. At most 4096 cells but for the first level.
SplineReport compare_with_spline(const Member& member, int levels = 5, int samples = 5);

}  // namespace isoparm
