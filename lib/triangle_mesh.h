// triangle_mesh.h -- triangles in space and nothing else: what a mesh file made by anyone holds.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "mesh.h"

namespace isoparm {

struct TriangleMesh {
    std::vector<Point> points;                             // finite, at most 1e50 in size
    std::vector<std::array<std::uint32_t, 3>> triangles;   // indices into points; may be degenerate

    std::array<Point, 3> corners(std::size_t t) const { return {points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]]}; }
};

/// Makes points with exactly equal coordinates (0 and -0 are equal) one, the first of them; points keep their order. Returns how many were dropped.
std::size_t weld_equal_points(TriangleMesh& mesh);

/// The triangles of all parts; the points are the mesh's.
TriangleMesh triangles_of(const Mesh& mesh);

}  // namespace isoparm
