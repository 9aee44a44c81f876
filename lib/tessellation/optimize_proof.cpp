// optimize_proof.cpp -- how a FreePatch proves what it changed. Refinement::bound_of has the last word on the whole mesh.
#include <algorithm>

#include "tessellation/optimize_patch.h"

namespace isoparm {

bool FreePatch::prove(std::uint32_t i) {
    FreeTriangle& t = triangles_[i];
    const Places p = places(t.corner);
    const BoundCell* cell = t.root;
    t.proof = BoundCell::bound(patch_, cell, p.corners(), tolerance_ - p.slack, measure_, TriangleBound::unasked);
    if (cell->model().bounded) t.cell = cell;
    t.proved = true, t.sharp = false;
    return t.proof.own(measure_) <= tolerance_;
}

/// A proof says no more than it had to, but the neighbours may need more.
void FreePatch::sharpen(std::uint32_t i) {
    if (triangles_[i].sharp || triangles_[i].left_out || !triangles_[i].proof.quiet) return;
    touch(i);
    FreeTriangle& t = triangles_[i];
    t.sharp = true;
    const Places p = places(t.corner);
    const TriangleBound b = bound_triangle(t.root->model_of(patch_, box_of(p.uv), SecondDerivatives::pieces), p.corners(), measure_);
    if (!b.quiet) return;
    t.proof.parametric = std::min(t.proof.parametric, b.parametric), t.proof.normal = std::min(t.proof.normal, b.normal);
    for (int k = 0; k < 3; ++k) t.proof.across[k] = std::min(t.proof.across[k], b.across[k]), t.proof.beside[k] = std::min(t.proof.beside[k], b.beside[k]);
}

bool FreePatch::holds(std::uint32_t i) const {
    const FreeTriangle& t = triangles_[i];
    double slack = places(t.corner).slack;
    std::array<Neighbour, 3> neighbours;
    for (int k = 0; k < 3; ++k) {
        const auto j = t.beside[k];
        if (!behind(t, j)) continue;
        const auto& back = triangles_[j].beside;
        neighbours[k] = {&triangles_[j].proof, int(std::find(back.begin(), back.end(), i) - back.begin())};
        slack = std::max(slack, places(triangles_[j].corner).slack);
    }
    const double bound = measure_ == Measure::geometric ? geometric_bound(t.proof, neighbours) : t.proof.parametric;
    return rounding::up(bound + slack) <= tolerance_;
}

bool FreePatch::holds_sharply(std::uint32_t i) {
    if (triangles_[i].left_out || holds(i)) return true;
    sharpen(i);
    if (holds(i)) return true;
    for (const auto j : triangles_[i].beside)
        if (j != kNone) sharpen(j);
    return holds(i);
}

bool FreePatch::certify() {
    for (const auto& [c, old] : old_corners_) {
        FreeCorner& corner = corners_[c];
        if (!corner.live() || (corner.uv.x == old.uv.x && corner.uv.y == old.uv.y && corner.slack == old.slack)) continue;
        corner.slack = slack_of(patch_, corner.uv, corner.x);
    }
    for (const auto& [i, old] : old_triangles_) {
        const FreeTriangle& t = triangles_[i];
        if (t.live && !t.left_out && !t.proved && !prove(i)) return false;
    }
    // Sharper proofs are added to the list, and only lower the bounds of those before.
    for (std::size_t k = 0, n = old_triangles_.size(); k < n; ++k) {
        const auto i = old_triangles_[k].first;
        if (!triangles_[i].live) continue;
        if (!holds_sharply(i)) return false;
        for (const auto j : triangles_[i].beside)
            if (j != kNone && !holds_sharply(j)) return false;
    }
    return true;
}

}  // namespace isoparm
