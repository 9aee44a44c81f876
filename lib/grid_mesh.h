// grid_mesh.h -- every patch on one grid, without cracks: fast, and nothing is proved of it.
#pragma once
#include "meshes/leaf_mesh.h"

namespace isoparm {

/// Every cell between breaks cut into n x n rectangles; the triangular domain into n x n triangles.
Leaves grid_leaves(const Patch& patch, std::uint32_t n);

struct GridMesh {
    Mesh mesh;
    std::vector<double> sampled_error;  // of each part: the largest distance of a triangle's middle from the patch at the same parameters
};
/// Edges nearer than `join` are one. Does not depend on the number of threads.
GridMesh grid_mesh(const Composite& surface, std::uint32_t n, double join);

}  // namespace isoparm
