// mesh.h -- a triangle mesh that knows where on which patch each of its vertices lies.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scalar/vec.h"

namespace isoparm {

/// The triangles of one patch. Corners index `uv` and `vertex`; vertex[i] is the mesh vertex of corner i. Several corners
/// may be one mesh vertex (poles, apexes, seams), but no triangle names a mesh vertex twice.
struct MeshPart {
    std::string name;
    std::size_t member = 0;                             // index of the patch in its composite
    std::vector<Vec2> uv;                               // parameters of each corner, on this patch
    std::vector<std::uint32_t> vertex;                  // mesh vertex of each corner
    std::vector<std::array<std::uint32_t, 3>> triangles;  // corners, counter-clockwise about the outward side
    /// Corners, counter-clockwise in the domain, of triangles that would name a mesh vertex twice: segments, edges of other triangles.
    std::vector<std::array<std::uint32_t, 3>> left_out;
    std::vector<double> bounds;                         // proved of each triangle, then of each left out; empty unless asked for
    bool flipped = false;                               // triangles wind against S_u x S_v
    double certified_error = 0;
};

struct Mesh {
    std::vector<Point> positions;
    std::vector<MeshPart> parts;

    std::size_t triangle_count() const {
        std::size_t n = 0;
        for (const auto& p : parts) n += p.triangles.size();
        return n;
    }
};

/// From p to the nearest point of the triangle a, b, c, which may be a segment or a point.
double distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c);

/// Counted with integers: what must hold for the mesh to be watertight.
struct MeshTopology {
    std::size_t boundary_edges = 0, boundary_loops = 0, non_manifold_edges = 0, t_junctions = 0, degenerate_triangles = 0;
};
/// Boundary edges are those of one triangle only. A T-junction is a boundary edge of the mesh that is no piece of an
/// open edge of the surface: the other side of a shared edge was split differently. `open_edges` are the mesh edges that
/// tessellate() placed on open edges, as sorted pairs of vertices.
MeshTopology analyse(const Mesh& mesh, const std::vector<std::array<std::uint32_t, 2>>& open_edges);

}  // namespace isoparm
