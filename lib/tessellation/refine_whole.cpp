// refine_whole.cpp -- what a Refinement looks at in the end, so that the mesh is the whole surface and a manifold: edges that several pairs of
// triangles have, and edges that none has.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <unordered_set>

#include "tessellation/refine.h"

namespace isoparm {
namespace {

/// A name for the mesh edge that an edge of a patch is, the same whichever patch and direction it is seen from.
std::uint64_t mesh_edge(const PatchMesh& mesh, const PatchEdge& e) {
    const auto [a, b] = std::minmax(mesh.vertex[e.a], mesh.vertex[e.b]);
    return (std::uint64_t(a) << 32) | b;
}

}  // namespace

bool Refinement::mark_coincident_edges() {
    // In the plane of parameters two corners are joined by one edge at most. So are two mesh vertices, unless one of them
    // is several corners, which only vertices on rims can be.
    const auto each = [&](PatchMesh& mesh, auto f) {
        for (std::uint32_t i = 0; i < mesh.edges.size(); ++i) {
            const PatchEdge& e = mesh.edges[i];
            if (e.child != kNone || !(shared_[mesh.vertex[e.a]] || shared_[mesh.vertex[e.b]])) continue;
            int beside = 0;
            for (const auto t : e.side) beside += t != kNone && !mesh.left_out(mesh.triangles[t]);
            if (beside > 0) f(i, mesh_edge(mesh, e), beside);
        }
    };
    std::vector<std::vector<std::uint64_t>> of(patches_.size());  // each edge once for every triangle beside it
    tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t m) {
        each(patches_[m], [&](std::uint32_t, std::uint64_t key, int beside) { of[m].insert(of[m].end(), std::size_t(beside), key); });
    });
    std::vector<std::uint64_t> sides;
    for (const auto& keys : of) sides.insert(sides.end(), keys.begin(), keys.end());
    std::sort(sides.begin(), sides.end());
    std::vector<std::uint64_t> crowded;
    for (std::size_t i = 2; i < sides.size(); ++i)
        if (sides[i] == sides[i - 2] && (crowded.empty() || crowded.back() != sides[i])) crowded.push_back(sides[i]);
    if (crowded.empty()) return false;
    bool any = false;
    for (auto& mesh : patches_)
        each(mesh, [&](std::uint32_t edge, std::uint64_t key, int) {
            if (!std::binary_search(crowded.begin(), crowded.end(), key)) return;
            mark(mesh, edge);
            any = true;
        });
    return any;
}

/// Is there a triangle left out that not all of its long sides' neighbours keep? Two of its corners are one vertex, on rims then.
bool Refinement::may_lose(const PatchMesh& mesh) const {
    std::vector<std::uint32_t> shared;
    for (const auto v : mesh.vertex)
        if (shared_[v]) shared.push_back(v);
    std::sort(shared.begin(), shared.end());
    if (std::adjacent_find(shared.begin(), shared.end()) == shared.end()) return false;
    return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const PatchTriangle& t) {
        if (!mesh.left_out(t)) return false;
        int sides = 0, kept = 0;
        for (const auto e : t.edge) {
            if (mesh.vertex[mesh.edges[e].a] == mesh.vertex[mesh.edges[e].b]) continue;  // a point, kept with the sides
            ++sides;
            const auto& beside = mesh.edges[e].side;
            kept += std::any_of(beside.begin(), beside.end(), [&](std::uint32_t o) { return o != kNone && !mesh.left_out(mesh.triangles[o]); });
        }
        return sides == 0 || kept < sides;
    });
}

bool Refinement::mark_lost_edges() {
    std::vector<char> lost(patches_.size());
    tbb::parallel_for(std::size_t(0), lost.size(), [&](std::size_t m) { lost[m] = may_lose(patches_[m]); });
    if (std::find(lost.begin(), lost.end(), char(true)) == lost.end()) return false;
    // A segment that is left out joins two vertices that it shares with other triangles, or is the whole of a patch.
    std::unordered_set<std::uint64_t> kept;
    std::vector<char> named(positions_.size(), 0);
    for (const auto& mesh : patches_)
        for (const auto& t : mesh.triangles) {
            if (mesh.left_out(t)) continue;
            for (const auto e : t.edge)
                if (shared_[mesh.vertex[mesh.edges[e].a]] || shared_[mesh.vertex[mesh.edges[e].b]]) kept.insert(mesh_edge(mesh, mesh.edges[e]));
            for (const auto v : mesh.vertices(t)) named[v] = 1;
        }
    bool any = false;
    for (auto& mesh : patches_)
        for (const auto& t : mesh.triangles) {
            if (!mesh.left_out(t)) continue;
            for (const auto e : t.edge) {
                const PatchEdge& edge = mesh.edges[e];
                const bool point = mesh.vertex[edge.a] == mesh.vertex[edge.b];
                if (point ? named[mesh.vertex[edge.a]] : kept.count(mesh_edge(mesh, edge)) > 0) continue;
                if (!point) mark(mesh, e);
                any = true;
            }
        }
    return any;
}

}  // namespace isoparm
