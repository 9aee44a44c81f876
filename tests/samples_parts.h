// samples_parts.h -- what the files of samples.h share. A new row goes into the file of its kind: samples_curves.cpp,
// samples_quads.cpp, samples_networks.cpp or samples_triangles.cpp.
#pragma once
#include "patches/tensor_bezier.h"
#include "samples.h"

namespace isoparm::tests {

const std::vector<PatchType>& quad_types();
const std::vector<PatchType>& network_types();
const std::vector<PatchType>& triangle_types();

std::vector<Point> random_points(Random& r, int count);
std::vector<double> random_weights(Random& r, int count);
Grid<double> random_weights(Random& r, int rows, int columns);
/// An affine map without symmetry, and the offset of the data after it.
Transform random_map(Random& r);

Curve nurbs(Random& r);
Curve cubic_spline(Random& r, const Point& from, const Point& to);
Curve rational_cubic(Random& r, const Point& from, const Point& to);
PatchSample bezier_patch(Random& r);
PatchSample nurbs_patch(Random& r);

}  // namespace isoparm::tests
