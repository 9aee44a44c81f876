// refine.h -- the triangulation of a composite while it is being refined; internal to tessellate.cpp.
//
// Every patch has its own vertices (parameters), edges and triangles; edges on a rim hang on nodes of that rim, which all
// patches around it share. Edges are only ever bisected, so a mark on an edge is all that neighbours need to know.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "composite.h"
#include "scalar/vec.h"
#include "topology.h"

namespace isoparm {

inline constexpr std::uint32_t kNone = UINT32_MAX;

/// A dyadic piece [f0,f1] of a rim between two mesh vertices.
struct RimNode {
    std::uint32_t rim = 0;
    double f0 = 0, f1 = 1;
    std::uint32_t a = 0, b = 0;    // mesh vertices
    std::uint32_t child = kNone;   // children are child and child + 1
    bool marked = false;
};

struct PatchEdge {
    std::uint32_t a = 0, b = 0;       // corners
    std::uint32_t child = kNone;      // children are child (a to middle) and child + 1 (middle to b)
    std::uint32_t rim_node = kNone;
    std::uint32_t use = 0;            // of the rim
    bool reversed = false;            // a is at the rim node's b
    bool marked = false;
};

struct PatchTriangle {
    std::array<std::uint32_t, 3> corner{};
    std::array<std::uint32_t, 3> edge{};  // edge k joins corners k and k+1
    double bound = -1;                    // proved, slack of the corners included; negative: not bounded yet
};

struct PatchMesh {
    std::vector<Vec2> uv;
    std::vector<std::uint32_t> vertex;  // mesh vertex of each corner
    std::vector<double> slack;          // at least the distance of the mesh vertex from the exact patch at uv
    std::vector<PatchEdge> edges;
    std::vector<PatchTriangle> triangles;
};

class Refinement {
public:
    Refinement(const Composite& surface, const Topology& topology);

    /// Bounds all triangles that have none and marks the worst edge of those above the tolerance; true when none is.
    /// Also marks edges whose two ends are one vertex without being collapsed.
    bool bound_and_mark(double tolerance);
    /// Bisects all marked edges and the triangles around them.
    void split_marked();
    /// Marks edges where more than two triangles meet that are different edges of the surface; false when there is none.
    bool mark_coincident_edges();
    /// Triangles that name a mesh vertex twice are left out of the mesh: marks those of their edges that no other triangle
    /// has. False when nothing is lost; true without a mark when a whole patch is one vertex that no triangle has.
    bool mark_lost_edges();

    std::size_t triangle_count() const;
    /// About how many triangles the tolerance needs, from the bounds so far.
    double predicted_triangles(double tolerance) const;
    double worst_bound() const;
    /// Triangles over which nothing could be proved yet.
    std::size_t unbounded_count() const;
    /// Largest distance of a mesh vertex from a patch that uses it: no refinement gets below it.
    double worst_slack() const { return worst_slack_; }

    const std::vector<Point>& positions() const { return positions_; }
    const std::vector<PatchMesh>& patches() const { return patches_; }
    /// Mesh edges on rims with one use: where the surface is open.
    std::vector<std::array<std::uint32_t, 2>> open_edges() const;
    bool collapsed(const PatchEdge& e) const { return e.rim_node != kNone && topology_.rims[rim_nodes_[e.rim_node].rim].collapsed; }

private:
    void build_patch(std::uint32_t member);
    void split_rims();
    void split_edges(std::uint32_t member);
    void split_triangles(std::uint32_t member);
    void measure_slack(std::uint32_t member, std::size_t first);
    void collect_slack(const std::vector<std::size_t>& first);
    void mark(PatchEdge& edge);
    Vec2 on_rim(const RimUse& use, double fraction, const Point& position, double low, double high) const;

    const Composite& surface_;
    const Topology& topology_;
    std::vector<Point> positions_;
    std::vector<RimNode> rim_nodes_;           // the first topology.rims.size() are the whole rims
    std::vector<PatchMesh> patches_;
    double worst_slack_ = 0;
};

}  // namespace isoparm
