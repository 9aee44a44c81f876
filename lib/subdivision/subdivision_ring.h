// subdivision_ring.h -- one face of a subdivision cage with the faces around it, which alone decide about the limit surface
// over it, and one step of refinement; internal to subdivision.cpp.
//
// The rules are those of OpenSubdiv (uniform creases; sharpness in floats, from 10 on infinite; triangles of Catmull-Clark
// cages like other faces). Points are Interval, so that they enclose the exact refined ones, or double.
//
// Source: Catmull & Clark 1978; Loop 1987; DeRose, Kass & Truong 1998 (semi-sharp creases); OpenSubdiv 3.5, Sdc.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "cage.h"
#include "scalar/interval.h"

namespace isoparm {

inline constexpr float kInfiniteSharpness = 10;

template <class T> struct Ring {
    struct Crease {
        int a, b;
        float sharpness;
    };
    std::vector<Vec3<T>> points;
    std::vector<float> sharpness;         // of the vertices
    std::vector<std::vector<int>> faces;  // faces[0] is the face; the others share a vertex with it
    std::vector<Crease> creases;          // boundary edges of the cage are infinitely sharp
};

template <class T> class Subdivider {
public:
    /// `ring` must live as long.
    Subdivider(const Ring<T>& ring, Scheme scheme);

    /// Children of a quad or triangle lie in the parameters of the face: 0 to 3 at its corners, in order, the axes kept; of
    /// a triangle 3 is the middle one, turned by half. Children of other faces begin at their own corner of the face.
    Ring<T> child(int k) const;
    /// Is the limit surface over the face a single patch? Then its control points: of Catmull-Clark 16, at 4 i + j, i
    /// along u, those beyond boundaries and creases made up; of Loop 12: the corners; the points across the edges
    /// 0-1, 1-2, 2-0; then for each corner the two of its ring that are left, the one near its next edge first.
    std::optional<std::vector<Vec3<T>>> regular() const;
    /// Is corner k of the face as in a regular mesh?
    bool regular_at(int k) const;

private:
    struct Edge {
        int a, b;
        std::array<int, 2> face{-1, -1};
        float sharpness = 0;
        int other(int v) const { return v == a ? b : a; }
        bool has(int v) const { return v == a || v == b; }
        bool wall() const { return sharpness >= kInfiniteSharpness; }
    };
    const std::vector<int>& face() const { return ring_.faces[0]; }
    int corners() const { return static_cast<int>(face().size()); }
    const Edge& side(int k) const { return edges_[face_edges_[0][k]]; }
    /// The face on the other side of an edge, and the other edge at v of a face.
    static int across(const Edge& e, int f) { return e.face[0] == f ? e.face[1] : e.face[0]; }
    const Edge& other_edge(int f, int v, const Edge& e) const;
    int faces_to_wall(int v, const Edge* e) const;
    Vec3<T> edge_point(const Edge& e) const;
    Vec3<T> vertex_point(int k, float& sharpness) const;
    Vec3<T> smooth_vertex(int v) const;
    std::vector<Vec3<T>> grid() const;
    std::vector<Vec3<T>> twelve() const;

    const Ring<T>& ring_;
    Scheme scheme_;
    std::vector<Edge> edges_;
    std::vector<std::vector<int>> face_edges_;  // edge k joins corners k and k + 1
    std::vector<Vec3<T>> face_points_;
};

}  // namespace isoparm
