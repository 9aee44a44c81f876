// mesh_distance.h -- how far flat triangles are from a mesh at most: proved. docs/certificates.md, "Verify", has the argument.
#pragma once
#include <functional>
#include <vector>

#include "meshes/triangle_tree.h"

namespace isoparm {

/// The farthest of some points from a mesh, as computed; of equals the first.
struct Farthest {
    std::size_t index = 0;
    double distance = -1;
};
Farthest farthest_point(std::size_t count, const std::function<Point(std::size_t)>& point, const TriangleTree& mesh);

/// A convex piece of a triangle.
struct Piece {
    static constexpr int most = 9;
    std::array<Point, most + 3> x;
    int size = 0;
    int cuts = 0;                              // how often what it comes from was cut
    std::uint32_t host = TriangleTree::none;   // the triangle of the mesh along whose sides it was cut out
    std::uint32_t hint = TriangleTree::none;   // one that is likely to be near
    double upper = std::numeric_limits<double>::infinity();
    std::size_t triangle = 0;                  // that it is a piece of

    Piece() = default;
    Piece(const std::array<Point, 3>& corners, std::size_t number) : size(3), triangle(number) { std::copy(corners.begin(), corners.end(), x.begin()); }
};

/// A bound of the distance of pieces from a mesh, and the farthest point of theirs that was seen on the way.
struct Reach {
    double upper = 0;          // proved: no point of any of the pieces is farther from the mesh
    double seen = 0;           // distance of `at`, as computed
    Point at;
    double at_slack = 0;       // at least the distance of `at` from its triangle
    std::size_t triangle = 0;  // of `at`
    bool spent = false;        // the budget of a piece ended before its bound was good
};

struct ReachOptions {
    double good = 0;                       // bounds up to this are good enough
    double gap = 0.01;                     // so are bounds up to (1 + gap) times a distance that was found beside them
    double coordinate = 0;                 // the largest coordinate of the pieces in size
    std::size_t parts = 20'000;            // that a piece may be split into
    std::vector<Piece>* left = nullptr;    // if given, parts with a distance above `good` go there and count for nothing
    std::function<void(double)> progress;  // called from the calling thread with a fraction in [0,1]; may be empty
};

/// Splits every piece where the mesh has its edges, and further, until the bounds are good enough. Does not depend on the number of threads.
Reach reach_of(std::size_t count, const std::function<Piece(std::size_t)>& piece, const TriangleTree& mesh, const ReachOptions& options);

}  // namespace isoparm
