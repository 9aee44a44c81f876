// refine_bound.cpp -- how a Refinement bounds triangles: those of one sharp cell eight at a time, others one by one.
#include <algorithm>
#include <utility>

#include "tessellation/refine.h"

namespace isoparm {
namespace {

/// Do three numbers and three others have the same range?
bool same_range(double a, double b, double c, double d, double e, double f) {
    return std::min(std::min(a, b), c) == std::min(std::min(d, e), f) && std::max(std::max(a, b), c) == std::max(std::max(d, e), f);
}

/// Triangles to be bounded eight at a time, in two sets: one alone in the first, or two that share their box, as those of a quadrilateral mostly do.
struct LanesOf {
    std::array<TriangleLanes, 2> sets;
    std::array<std::array<PatchTriangle*, TriangleLanes::size>, 2> of;
    std::size_t count = 0, n = 0;  // sets; triangles of each

    explicit LanesOf(std::size_t sets_used) : count(sets_used) {}
    bool full() const { return n == TriangleLanes::size; }
    std::span<const TriangleLanes> used() const { return {sets.data(), count}; }
};

}  // namespace

CornerData Refinement::corners_of(const PatchMesh& mesh, const PatchTriangle& t) const {
    CornerData data;
    for (int k = 0; k < 3; ++k) data.uv[k] = mesh.uv[t.corner[k]], data.points[k] = positions_[mesh.vertex[t.corner[k]]];
    data.slack = mesh.slack_of(t);
    return data;
}

void Refinement::bound(const PatchMesh& mesh, std::uint32_t member, PatchTriangle& t, bool decide) const {
    const CornerData data = corners_of(mesh, t);
    t.proof = BoundCell::bound(surface_[member].patch, t.cell, data, tolerance_ - data.slack, measure_, turn_, decide);
}

/// Those of one sharp cell after the other go together.
void Refinement::bound_fresh(PatchMesh& mesh, std::uint32_t member, std::size_t first, std::size_t last) const {
    std::array<PatchTriangle*, kTogether> all;
    for (std::size_t i = first; i < last; ++i) all[i - first] = &mesh.triangles[mesh.fresh[i]];
    bound_together(mesh, member, {all.data(), last - first}, false);
    for (std::size_t i = first; i < last; ++i) mesh.doubtful[i] = is_doubtful(mesh, mesh.triangles[mesh.fresh[i]]);
}

/// Must flip_and_mark() look at it?
bool Refinement::is_doubtful(const PatchMesh& mesh, const PatchTriangle& t) const {
    return !(rounding::up(t.proof.own(measure_) + mesh.slack_of(t)) <= tolerance_) || !turns_little(mesh, t) || mesh.left_out(t);
}

/// Of the fresh triangles, now bounded; `strips`: some of them anew since.
void Refinement::keep_doubtful(PatchMesh& mesh, bool strips) const {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh.fresh.size(); ++i)
        if (strips ? is_doubtful(mesh, mesh.triangles[mesh.fresh[i]]) : mesh.doubtful[i] != 0) mesh.fresh[kept++] = mesh.fresh[i];
    mesh.fresh.resize(kept), mesh.fresh.shrink_to_fit();
    release(mesh.doubtful);
}

void Refinement::bound_together(const PatchMesh& mesh, std::uint32_t member, std::span<PatchTriangle*> triangles, bool quick) const {
    const Patch& patch = surface_[member].patch;
    std::array<PatchTriangle*, kTogether> here;
    for (PatchTriangle*& t : triangles) {
        if (t->cell->polynomial().exact()) continue;
        if (const BoundCell* cell = sharp_cell(mesh, member, *t)) t->cell = cell;
        else bound(mesh, member, *t, quick), t = nullptr;
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (!triangles[i]) continue;
        const BoundCell* cell = triangles[i]->cell;
        std::size_t n = 0;
        for (std::size_t k = i; k < triangles.size(); ++k)
            if (triangles[k] && triangles[k]->cell == cell) here[n++] = std::exchange(triangles[k], nullptr);
        bound_in(*cell, mesh, patch, {here.data(), n}, quick);
    }
}

/// BoundCell::bound_all() without copies of what passes at once, which is almost everything.
void Refinement::bound_in(const BoundCell& cell, const PatchMesh& mesh, const Patch& patch, std::span<PatchTriangle* const> triangles, bool quick) const {
    const LanesAsked asked{measure_, 1, false, turn_ != TriangleBound::unasked};
    std::array<TriangleBound, 2 * TriangleLanes::size> bounds;
    std::vector<CornerData> data;  // of those above the tolerance
    std::vector<TriangleBound> above;
    std::vector<PatchTriangle*> of;
    const auto put = [&](LanesOf& to, std::size_t set, std::size_t lane, PatchTriangle& t) {
        for (std::size_t k = 0; k < 3; ++k) to.sets[set].set(lane, k, mesh.uv[t.corner[k]], positions_[mesh.vertex[t.corner[k]]]);
        to.sets[set].slack[lane] = mesh.slack_of(t);
        to.of[set][lane] = &t;
    };
    const auto bound = [&](LanesOf& all) {
        for (std::size_t set = 0; set < all.count; ++set)
            for (std::size_t i = all.n; i < TriangleLanes::size; ++i) put(all, set, i, *all.of[set][0]);
        bound_lanes(cell.polynomial(), all.used(), int(all.n), asked, bounds.data());
        for (std::size_t set = 0; set < all.count; ++set)
            for (std::size_t i = 0; i < all.n; ++i) {
                PatchTriangle& t = *all.of[set][i];
                const TriangleBound& b = bounds[set * TriangleLanes::size + i];
                t.proof = b;
                if (quick || b.own(measure_) <= tolerance_ - all.sets[set].slack[i]) continue;
                of.push_back(&t), above.push_back(b), data.push_back(corners_of(mesh, t));
            }
        all.n = 0;
    };
    const auto share_box = [&](const PatchTriangle& t, const PatchTriangle& o) {
        const Vec2 &a = mesh.uv[t.corner[0]], &b = mesh.uv[t.corner[1]], &c = mesh.uv[t.corner[2]], &d = mesh.uv[o.corner[0]], &e = mesh.uv[o.corner[1]], &f = mesh.uv[o.corner[2]];
        return same_range(a.x, b.x, c.x, d.x, e.x, f.x) && same_range(a.y, b.y, c.y, d.y, e.y, f.y);
    };
    LanesOf alone(1), pairs(2);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const bool pair = i + 1 < triangles.size() && share_box(*triangles[i], *triangles[i + 1]);
        LanesOf& to = pair ? pairs : alone;
        put(to, 0, to.n, *triangles[i]);
        if (pair) put(to, 1, to.n, *triangles[++i]);
        if (++to.n; to.full()) bound(to);
    }
    for (LanesOf* rest : {&alone, &pairs})
        if (rest->n > 0) bound(*rest);
    if (of.empty()) return;
    cell.sharpen(patch, data, tolerance_, measure_, turn_, above.data());
    for (std::size_t i = 0; i < of.size(); ++i) of[i]->proof = above[i];
}

const BoundCell* Refinement::sharp_cell(const PatchMesh& mesh, std::uint32_t member, const PatchTriangle& t) const {
    return t.cell->sharp_cell(surface_[member].patch, box_of({mesh.uv[t.corner[0]], mesh.uv[t.corner[1]], mesh.uv[t.corner[2]]}));
}

}  // namespace isoparm
