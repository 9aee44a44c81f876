// refine.h -- the triangulation of a composite while it is being refined; internal to tessellate.cpp.
//
// Every patch has its own vertices (parameters), edges and triangles; edges on a rim hang on nodes of that rim, which all
// patches around it share. Edges are bisected, so a mark on an edge is all that neighbours need to know; inside a cell, an edge may
// be turned first where that is enough. Every round touches only what is new: fresh triangles, marked edges and the triangles beside them.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "bounds/bound_cell.h"
#include "bounds/proof.h"
#include "composite.h"
#include "release.h"
#include "scalar/vec.h"
#include "topology.h"

namespace isoparm {

inline constexpr std::uint32_t kNone = UINT32_MAX;
inline constexpr double kUnsettled = -1;

/// A dyadic piece [f0,f1] of a rim between two mesh vertices.
struct RimNode {
    std::uint32_t rim = 0;
    double f0 = 0, f1 = 1;
    std::uint32_t a = 0, b = 0;    // mesh vertices
    std::uint32_t child = kNone;   // children are child and child + 1
    bool marked = false;
    std::array<std::uint32_t, 2> edge{kNone, kNone};  // the patch edge of each use
};

struct PatchEdge {
    std::uint32_t a = 0, b = 0;       // corners
    std::uint32_t child = kNone;      // children are child (a to middle) and child + 1 (middle to b)
    std::uint32_t rim_node = kNone;
    std::uint32_t use : 30 = 0;       // of the rim
    bool reversed : 1 = false;        // a is at the rim node's b
    bool marked : 1 = false;
    std::array<std::uint32_t, 2> side{kNone, kNone};  // the triangles beside it
};
static_assert(sizeof(PatchEdge) == 28, "there are three for every two triangles");

struct PatchTriangle {
    std::array<std::uint32_t, 3> corner{};
    std::array<std::uint32_t, 3> edge{};  // edge k joins corners k and k+1
    const BoundCell* cell = nullptr;
    Proof proof{};                        // slack of the corners not included
};
static_assert(sizeof(PatchTriangle) == 88, "there are millions of them");

struct PatchMesh;

/// The triangles that touch a collapsed edge of a rectangle, which are bounded together.
struct PoleFan {
    int edge = 0;                          // of the domain
    bool along_u = true;                   // v = at there, else u = at
    double at = 0;
    std::vector<std::uint32_t> triangles;  // of the last round
    bool settled = false;                  // that strips are better

    bool on(const Vec2& p) const { return (along_u ? p.y : p.x) == at; }
    bool touches(const PatchMesh& mesh, const PatchTriangle& t) const;
    int apex(const PatchMesh& mesh, const PatchTriangle& t) const;
    bool is_graph(const PatchMesh& mesh) const;
};

struct PatchMesh {
    std::vector<Vec2> uv;
    std::vector<std::uint32_t> vertex;  // mesh vertex of each corner
    std::vector<double> slack;          // at least the distance of the mesh vertex from the exact patch at uv
    std::vector<PatchEdge> edges;
    std::vector<PatchTriangle> triangles;
    double most_slack = 0;              // of all corners
    bool even_slack = false;            // most_slack serves all
    std::vector<RoundedUp> settled;     // the bound of each triangle with the neighbours that it has now, at most the tolerance; kUnsettled: not known
    std::vector<std::uint32_t> fresh;   // triangles not bounded yet
    std::vector<char> doubtful;         // of the fresh ones, when they are bounded: above the tolerance, or left out; they are looked at again
    std::vector<std::uint32_t> marked;  // edges to be bisected, those on rims not included
    std::vector<std::unique_ptr<BoundCell>> cells;
    std::vector<double> breaks_u, breaks_v;  // of the patch
    std::vector<Point> poles;                // its collapsed edges
    std::vector<PoleFan> fans;               // those around which triangles are bounded together
    bool fan_broken = false;                 // one was, and cannot be any more

    std::array<std::uint32_t, 3> vertices(const PatchTriangle& t) const { return {vertex[t.corner[0]], vertex[t.corner[1]], vertex[t.corner[2]]}; }
    /// Triangles that name a mesh vertex twice, at poles and seams, are segments and left out of the mesh.
    bool left_out(const PatchTriangle& t) const {
        const auto [a, b, c] = vertices(t);
        return a == b || b == c || c == a;
    }
    bool in_fan(const PatchTriangle& t) const;
    void find_fans();
    /// Along a break of the patch, where the surface may jump by the rounding of its curves' breaks.
    bool on_break(const PatchEdge& e) const;
    /// The cell between breaks that holds a triangle.
    const BoundCell* root_of(const std::array<std::uint32_t, 3>& corner) const;
    /// At least the distance of a corner of the triangle from the surface; so little that the largest of the patch serves all, mostly.
    double slack_of(const PatchTriangle& t) const { return even_slack ? most_slack : std::max(std::max(slack[t.corner[0]], slack[t.corner[1]]), slack[t.corner[2]]); }
};

/// t of edge_point() at a point of an edge of the domain.
double edge_parameter(const Patch& patch, int edge, const Vec2& p);

class Refinement {
public:
    /// Begins with grids that are about as fine as the tolerance needs; with single cells when those would have more than `most` triangles.
    /// `turn`: the largest tangent of the angle between a triangle and the surface's normals; geometric measure only. TriangleBound::none: any; or unasked.
    /// `fans`: triangles at collapsed edges are bounded together; geometric measure only.
    Refinement(const Composite& surface, const Topology& topology, double tolerance, Measure measure, double most = 1e6,
               double turn = TriangleBound::unasked, bool fans = false);

    /// Bounds all triangles that have no bound and marks the worst edge of those above the tolerance, unless turning an edge mends them;
    /// true when none is.
    /// Also marks edges whose two ends are one vertex without being collapsed.
    bool bound_and_mark();
    /// Geometric bounds need the neighbours: marks triangles that are above the tolerance with them. False when there is none.
    bool mark_with_neighbours();
    /// Bisects all marked edges and the triangles around them.
    void split_marked();
    /// Marks edges where more than two triangles meet that are different edges of the surface; false when there is none.
    bool mark_coincident_edges();
    /// Marks those edges of the triangles left out that no other triangle has. False when nothing is lost; true without a
    /// mark when a whole patch is one vertex that no triangle has.
    bool mark_lost_edges();

    /// Was a fan given up in the middle? What was cut for its strips is a bad start for triangles that are bounded each for itself.
    bool fans_broken() const {
        return std::any_of(patches_.begin(), patches_.end(), [](const PatchMesh& mesh) { return mesh.fan_broken; });
    }
    bool has_fans() const {
        return std::any_of(patches_.begin(), patches_.end(), [](const PatchMesh& mesh) { return !mesh.fans.empty(); });
    }
    void break_fans() { patches_[0].fan_broken = true; }

    /// About how many triangles the grids to begin with would have ended with, where those had more than `most`; else 0.
    double planned_triangles() const { return planned_; }

    /// Those at poles that are left out of the mesh not included.
    std::size_t triangle_count() const;
    /// Is that more than `most`? Mostly told without a look at the triangles.
    bool more_triangles_than(std::size_t most) const { return all_triangles() > most && triangle_count() > most; }
    /// What the last bound_and_mark() found: about how many triangles the tolerance needs, the largest bound above it, and
    /// over how many triangles nothing could be proved.
    double predicted_triangles() const { return predicted_; }
    double worst_bound() const { return worst_bound_; }
    std::size_t unbounded_count() const { return unbounded_; }
    /// Largest distance of a mesh vertex from a patch that uses it: no refinement gets below it.
    double worst_slack() const { return worst_slack_; }

    /// What is proved about a triangle, the slack of all corners that count included.
    double bound_of(const PatchMesh& mesh, std::uint32_t triangle) const;

    /// Does the triangle keep the limit of `turn`, or is it smaller than the tolerance and at a pole, or without a bound, so that the search for one was given up?
    bool turns_little(const PatchMesh& mesh, const PatchTriangle& t) const;

    /// The largest of a patch, triangles that are left out included.
    double worst_bound_of(std::size_t member) const;

    /// The largest distance seen, in the measure, at the middles of all triangles and edges: from the surface's point to the
    /// mesh's point of the same parameters, or to the nearest of the triangle, or two triangles, there.
    double sampled_error() const;

    const std::vector<Point>& positions() const { return positions_; }
    const std::vector<PatchMesh>& patches() const { return patches_; }
    const std::vector<RimNode>& rim_nodes() const { return rim_nodes_; }
    /// A point of a rim in the parameters of one of its uses; between `low` and `high` on the edge.
    Vec2 on_rim(const RimUse& use, double fraction, const Point& position, double low, double high) const;
    /// Other triangulations of the same patches: all their triangles are fresh, their slack is measured here. The vertices 0 to
    /// nodes of the topology, and all those of rims, have to be where they were, or on their rims.
    void replace(std::vector<PatchMesh> patches, std::vector<RimNode> rim_nodes, std::vector<Point> positions);
    /// Leaves nothing of a patch but its corners.
    void drop_triangles(std::size_t member) {
        PatchMesh& p = patches_[member];
        release(p.triangles), release(p.edges), release(p.settled), release(p.fresh), release(p.doubtful), release(p.slack);
    }
    /// The corners of a patch, which are then no longer here.
    void move_corners(std::size_t member, std::vector<Vec2>& uv, std::vector<std::uint32_t>& vertex) { uv = std::move(patches_[member].uv), vertex = std::move(patches_[member].vertex); }
    /// All positions, which are then no longer here.
    std::vector<Point> move_positions() { return std::move(positions_); }
    /// Mesh edges on rims with one use: where the surface is open.
    std::vector<std::array<std::uint32_t, 2>> open_edges() const;
    bool collapsed(const PatchEdge& e) const { return e.rim_node != kNone && topology_.rims[rim_nodes_[e.rim_node].rim].collapsed; }

private:
    struct Start;  // of one patch
    void start(double most);
    void cut_rims(const std::vector<Start>& starts);
    void build_patch(std::uint32_t member, const Start& start);
    void number_vertices(const std::vector<std::size_t>& first_corner, const std::vector<std::uint32_t>& first_edge);
    void split_rims();
    void split_edges(std::uint32_t member);
    void split_triangles(std::uint32_t member, std::uint32_t first_edge);
    void place_vertices(std::uint32_t member, std::size_t first_corner, std::uint32_t first_vertex);
    void measure_slack(std::uint32_t member, std::size_t first);
    void collect_slack();
    CornerData corners_of(const PatchMesh& mesh, const PatchTriangle& t) const;
    void bound(const PatchMesh& mesh, std::uint32_t member, PatchTriangle& t, bool decide = false) const;
    /// kTogether at most: eight at once where polynomials serve; `quick`: less sharply. Uses the list up.
    void bound_together(const PatchMesh& mesh, std::uint32_t member, std::span<PatchTriangle*> triangles, bool quick) const;
    const BoundCell* sharp_cell(const PatchMesh& mesh, std::uint32_t member, const PatchTriangle& t) const;
    void bound_in(const BoundCell& cell, const PatchMesh& mesh, const Patch& patch, std::span<PatchTriangle* const> triangles, bool quick) const;
    static constexpr std::size_t kTogether = 64;  // triangles that are bounded in one go
    bool is_doubtful(const PatchMesh& mesh, const PatchTriangle& t) const;
    std::size_t all_triangles() const;
    void bound_fresh(PatchMesh& mesh, std::uint32_t member, std::size_t first, std::size_t last) const;
    TriangleBound bound_strip(const PatchMesh& mesh, std::uint32_t member, const PoleFan& fan, const PatchTriangle& t) const;
    bool sides_bend(const PatchMesh& mesh, std::uint32_t member, const PoleFan& fan) const;
    std::vector<TriangleBound> better_strips(const PatchMesh& mesh, std::uint32_t member, const PoleFan& fan) const;
    void bound_fans(std::uint32_t member);
    struct Round {  // what a patch asks for
        std::vector<std::uint32_t> on_rims;  // edges to be marked
        double more = 0, worst = 0;          // triangles that will come of those above the tolerance; their largest bound
        std::size_t unbounded = 0;
    };
    void keep_doubtful(PatchMesh& mesh, bool strips) const;
    Round flip_and_mark(std::uint32_t member);
    bool may_lose(const PatchMesh& mesh) const;
    bool keeps(const PatchMesh& mesh, const PatchTriangle& t) const;
    struct Flip;
    struct Flips;  // of one triangle
    void flips_of(const PatchMesh& mesh, std::uint32_t member, std::uint32_t triangle, Flips& flips) const;
    void bound_flips(const PatchMesh& mesh, std::uint32_t member, std::span<Flips> all) const;
    const Flip* flip_first(PatchMesh& mesh, std::uint32_t member, Flips& flips, bool with_neighbours) const;
    void flip_fresh(PatchMesh& mesh, std::uint32_t member) const;
    bool flip_of(const PatchMesh& mesh, std::uint32_t triangle, int edge, Flip& f) const;
    bool in_vain(const PatchMesh& mesh, std::uint32_t member, const Flip& f) const;
    bool flip(PatchMesh& mesh, const Flip& f, bool with_neighbours) const;
    bool flip_any(PatchMesh& mesh, std::uint32_t member, std::uint32_t triangle, bool with_neighbours) const;
    void mark(PatchMesh& mesh, std::uint32_t edge);

    const Composite& surface_;
    const Topology& topology_;
    const double tolerance_;
    const Measure measure_;
    const double turn_;
    const bool fans_;
    std::vector<Point> positions_;
    std::vector<char> shared_;                 // by mesh vertex: on a rim, so that several corners may be it
    std::vector<RimNode> rim_nodes_;
    std::vector<std::uint32_t> rim_pieces_;    // rim r begins as the nodes [rim_pieces_[r], rim_pieces_[r + 1])
    std::vector<std::uint32_t> marked_rims_;
    std::vector<PatchMesh> patches_;
    double worst_slack_ = 0, predicted_ = 0, planned_ = 0, worst_bound_ = 0;
    std::size_t unbounded_ = 0;
};

}  // namespace isoparm
