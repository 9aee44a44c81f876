// triangle_tree.h -- the nearest point of a mesh, by a tree of boxes over its triangles.
//
// Distances carry their rounding: see docs/certificates.md, "Verify". Safe to call from several threads. The tree, and what it
// answers, does not depend on how many built it.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "triangle_mesh.h"

namespace isoparm {

/// A point of the triangle a, b, c, which may be a segment or a point, that is nearest to p up to rounding: it lies in the triangle up
/// to 32 u times the largest coordinate.
Point nearest_of_triangle(const Point& p, const std::array<Point, 3>& triangle);

class TriangleTree {
public:
    static constexpr std::uint32_t none = UINT32_MAX;
    struct Nearest {
        std::uint32_t triangle = none;
        Point point;
        double distance = std::numeric_limits<double>::infinity();  // as computed
    };

    /// At least one triangle.
    explicit TriangleTree(const TriangleMesh& mesh);

    /// Of triangles at equal distance any one, always the same for equal `hint`: a triangle that is likely to be near.
    Nearest nearest(const Point& p, std::uint32_t hint = none) const;
    /// At most the distance of the exact p from the mesh: every triangle that may be nearest is shown to lie behind a plane.
    double distance_down(const Point& p) const;
    /// Is a triangle nearer than `distance`, as computed?
    bool any_within(const Point& p, double distance) const;
    /// f(triangle) for those whose boxes are no farther than `distance`, as computed.
    template <class F> void each_near(const Point& p, double distance, F f) const {
        visit(p, [&] { return distance * distance; }, [&](std::uint32_t slot) { f(number_[slot]); });
    }

    const std::array<Point, 3>& corners(std::uint32_t triangle) const { return corners_[slot_[triangle]]; }
    /// The largest coordinate of the mesh in size.
    double size() const { return size_; }

private:
    static constexpr std::size_t kLeaf = 4;
    struct Node {
        Point low, high;
        std::uint32_t first = 0;  // of a leaf: its first slot; else the right child, the left one follows the node
        std::uint32_t count = 0;  // triangles of a leaf; 0: no leaf
        /// Never more than the exact one.
        double square_distance(const Point& p) const {
            const auto out = [](double low, double high, double x) { return std::max(std::max(low - x, x - high), 0.0); };
            const double x = out(low.x, high.x, p.x), y = out(low.y, high.y, p.y), z = out(low.z, high.z, p.z);
            return (x * x + y * y + z * z) * (1 - 1e-14);
        }
    };
    void build(const std::vector<Point>& centres, std::size_t node, std::size_t begin, std::size_t end);

    /// Leaves in the order of their distance, as far as two children tell; f(slot) for triangles in boxes not beyond limit().
    template <class Limit, class F> void visit(const Point& p, Limit limit, F f) const {
        std::array<std::pair<std::uint32_t, double>, 64> stack;
        int top = 0;
        stack[top++] = {0, nodes_[0].square_distance(p)};
        while (top > 0) {
            const auto [at, away] = stack[--top];
            if (away > limit()) continue;
            const Node& node = nodes_[at];
            if (node.count > 0) {
                for (std::uint32_t k = 0; k < node.count; ++k) f(node.first + k);
                continue;
            }
            const double left = nodes_[at + 1].square_distance(p), right = nodes_[node.first].square_distance(p);
            const bool left_first = left <= right;
            stack[top++] = left_first ? std::pair{node.first, right} : std::pair{at + 1, left};
            stack[top++] = left_first ? std::pair{at + 1, left} : std::pair{node.first, right};
        }
    }

    std::vector<Node> nodes_;
    std::vector<std::array<Point, 3>> corners_;  // by slot: in the order of the leaves
    std::vector<std::uint32_t> number_, slot_;   // triangle of a slot, slot of a triangle
    double size_ = 0;
};

}  // namespace isoparm
