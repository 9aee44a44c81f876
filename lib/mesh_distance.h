// mesh_distance.h -- how far flat triangles are from a mesh at most: proved. docs/certificates.md, "Verify", has the argument.
#pragma once
#include <functional>

#include "triangle_tree.h"

namespace isoparm {

/// The farthest of some points from a mesh, as computed; of equals the first.
struct Farthest {
    std::size_t index = 0;
    double distance = -1;
};
Farthest farthest_point(std::size_t count, const std::function<Point(std::size_t)>& point, const TriangleTree& mesh);

/// A bound of the distance of triangles from a mesh, and the farthest point of theirs that was seen on the way.
struct Reach {
    double upper = 0;     // proved: no point of any of the triangles is farther from the mesh
    double seen = 0;      // distance of `at`, as computed
    Point at;
    double at_slack = 0;  // at least the distance of `at` from its triangle
    std::size_t triangle = 0;
    bool spent = false;   // the budget of a triangle ended before its bound was within the gap
};

struct ReachOptions {
    double known = 0;      // a distance that occurs: bounds up to (1 + gap) times that are good enough
    double gap = 0.01;     // so are bounds up to (1 + gap) times a distance that was found beside them
    double coordinate = 0; // the largest coordinate of the triangles in size
    std::size_t pieces = 20'000;           // of one triangle, at most
    std::function<void(double)> progress;  // called from the calling thread with a fraction in [0,1]; may be empty
};

/// Splits every triangle where the mesh has its edges, and further, until the bounds are good enough. Does not depend on the number
/// of threads.
Reach reach_of(std::size_t count, const std::function<std::array<Point, 3>(std::size_t)>& triangle, const TriangleTree& mesh, const ReachOptions& options);

}  // namespace isoparm
