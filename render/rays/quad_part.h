// quad_part.h -- the triangles of one patch of a large mesh, in some 27 bytes each instead of 52: all that is kept of them while rays are traced. Pairs that
// share an edge are quads of Embree's, which reads corners and positions where they are here.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "mesh.h"
#include "rays/float_vertices.h"

namespace isoparm {

class QuadPart {
public:
    /// The part loses its triangles, corners and parameters.
    QuadPart(const Mesh& mesh, MeshPart& part, const Point& centre);

    std::size_t triangles() const { return triangles_; }
    /// Corners of quads: the triangles 0, 1, 3 and 2, 3, 1. The second one is only a segment where a triangle has no other to share an edge with.
    const std::vector<std::array<std::uint32_t, 4>>& quads() const { return quads_; }
    const FloatVertices& vertices() const { return vertices_; }
    const Vec2& uv(std::uint32_t corner) const { return uv_[corner]; }

    // Halves of quads: half 2 q + k is triangle k of quad q.
    /// Where Embree has met quad q.
    static std::uint32_t half_at(std::uint32_t quad, double u, double v) { return 2 * quad + (u + v > 1); }
    /// The same, counter-clockwise about the outward side as in the mesh; it may begin with another corner.
    std::array<std::uint32_t, 3> corners(std::uint32_t half) const {
        const auto& q = quads_[half / 2];
        return half % 2 ? std::array{q[2], q[3], q[1]} : std::array{q[0], q[1], q[3]};
    }
    /// Its number in the mesh's part.
    std::uint32_t triangle(std::uint32_t half) const { return number_[half / 2][half % 2]; }

private:
    std::size_t triangles_;
    std::vector<std::array<std::uint32_t, 4>> quads_;
    std::vector<std::array<std::uint32_t, 2>> number_;  // of both triangles; twice the same of one alone
    FloatVertices vertices_;
    std::vector<Vec2> uv_;
};

}  // namespace isoparm
