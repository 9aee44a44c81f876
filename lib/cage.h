// cage.h -- the control cage of a subdivision surface, as a value.
#pragma once
#include <string>
#include <vector>

#include "scalar/vec.h"

namespace isoparm {

enum class Scheme { catmull_clark, loop, bilinear };

/// Vertices are named by their index, from 0. Faces list theirs in order, all turning the same way.
struct Cage {
    /// What happens at a boundary: no limit surface in its faces; smooth corners; corners of one face interpolated.
    enum class Boundary { none, edge_only, edge_and_corner };
    struct Crease {
        int a, b;          // the ends of an edge
        double sharpness;  // from 10 on: infinitely sharp
    };
    struct Corner {
        int vertex;
        double sharpness;
    };

    std::vector<Point> positions;
    std::vector<std::vector<int>> faces;
    std::vector<Crease> creases;
    std::vector<Corner> corners;
    std::vector<int> holes;  // faces without surface
    Boundary boundary = Boundary::edge_and_corner;
    std::vector<int> face_lines;  // where each face was read, for messages; or empty
};

/// Of the vertices that faces have, for cages that check_cage() takes: others are no part of the surface, and may be far away. The bounding box's
/// diagonal; the largest distance from the origin. Neither loses a size that a double can hold.
double diagonal(const Cage& cage);
double reach(const Cage& cage);
/// "face 3 (line 12)", for messages.
std::string face_name(const Cage& cage, std::size_t face);
/// Throws Error(input) when there is no face, indices are out of range, a face is degenerate or of a size that the scheme does not know, a position is
/// not finite, a sharpness negative, or (Loop) a vertex inside of valence 2: of its two triangles refinement makes edges that have the same ends.
void check_cage(const Cage& cage, Scheme scheme);

}  // namespace isoparm
