// mesh_defects.h -- what may be wrong with a mesh by itself: holes, junctions, folds, needles.
//
// Two triangles share an edge when they name the same two vertices; that is counted with integers. Nothing here depends on the number
// of threads.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "triangle_mesh.h"

namespace isoparm {

struct MeshDefects {
    using Edge = std::array<std::uint32_t, 2>;  // vertices, the smaller one first
    std::size_t unused_vertices = 0;
    std::size_t equal_vertices = 0;          // with the coordinates of a vertex before them, and yet another one
    std::size_t degenerate_triangles = 0;    // name a vertex twice, or have no area as computed
    std::size_t duplicate_triangles = 0;     // have the three vertices of a triangle before them
    std::size_t components = 0;              // pieces that hang together by edges
    std::vector<Edge> open_edges;            // of one triangle
    std::vector<std::size_t> loop;           // of each open edge: the number of the piece of boundary it belongs to
    std::size_t boundary_loops = 0;          // such pieces
    std::size_t non_manifold_edges = 0;      // of more than two triangles
    std::size_t non_manifold_vertices = 0;   // where fans of triangles meet that share no edge
    std::size_t inconsistent_edges = 0;      // of two triangles that run along it the same way: one of them is upside down
    struct Junction {
        std::uint32_t vertex;
        Edge edge;
    };
    std::vector<Junction> t_junctions;       // vertices of open edges that lie inside another open edge, within the distance; each once
};
MeshDefects find_defects(const TriangleMesh& mesh, double junction_distance);

/// Open edges that are no piece of a border: an end or the middle is farther than `distance` from all of its segments. Returns how many
/// pieces of boundary have such edges.
std::size_t count_holes(const TriangleMesh& mesh, const MeshDefects& defects, const std::vector<std::array<Point, 2>>& border, double distance);

/// Over triangles that have an area. Angles in degrees; the aspect ratio is the longest side over the inradius, divided
/// by 2 sqrt 3, so 1 for equal sides.
struct TriangleShapes {
    double least_angle = 0, angle_1 = 0, angle_5 = 0, angle_50 = 0;       // least angles: of all, and quantiles in percent
    double aspect_50 = 0, aspect_95 = 0, aspect_99 = 0, most_aspect = 0;
    std::size_t thinnest = 0;                                             // the triangle of least_angle
};
TriangleShapes measure_shapes(const TriangleMesh& mesh);

}  // namespace isoparm
