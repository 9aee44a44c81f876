#include "meshes/leaf_rims.h"

#include <algorithm>
#include <cmath>

#include "tessellation/refine.h"

namespace isoparm {
namespace {

constexpr double kSame = 1e-9;  // of a rim: nearer requests of two patches are one vertex

/// Parameters of the lattice points on edge k that leaves have as corners, growing.
std::vector<double> requests(const Patch& patch, const Leaves& leaves, int k) {
    std::vector<double> list;
    for (const Leaf& leaf : leaves.list)
        for (int c = 0; c < leaf.sides; ++c)
            if (leaves.on_edge(patch, k, leaf.corner[c])) list.push_back(edge_parameter(patch, k, leaves.at(leaf.corner[c])));
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

double projected(const Composite& surface, const RimUse& use, const Point& p) {
    return nearest_on_edge(surface[use.member].patch, use.edge, p, std::min(use.t0, use.t1), std::max(use.t0, use.t1));
}

}  // namespace

Point on_edge(const Composite& surface, const RimUse& use, double t) {
    const Patch& patch = surface[use.member].patch;
    const Vec2 p = patch.edge_point(use.edge, t);
    return patch.point(p.x, p.y);
}

Rims::Rims(const Composite& surface, const Topology& topology, const std::vector<Leaves>& leaves)
    : surface_(surface), topology_(topology), asked_(surface.size()) {
    for (std::size_t m = 0; m < surface.size(); ++m)
        for (int k = 0; k < surface[m].patch.edges(); ++k) asked_[m][k] = requests(surface[m].patch, leaves[m], k);
}

std::vector<RimVertex> Rims::cut(std::uint32_t r) const {
    const Rim& rim = topology_.rims[r];
    std::vector<RimVertex> all{end_of(rim, 0)};
    for (int u = 0; u < int(rim.uses.size()); ++u)
        for (const double t : inside(rim.uses[u])) all.push_back(both(rim, u, t));
    all.push_back(end_of(rim, 1));
    std::stable_sort(all.begin(), all.end(), [](const RimVertex& a, const RimVertex& b) { return a.f < b.f; });
    std::vector<RimVertex> kept;
    for (const RimVertex& v : all) {
        const auto clash = [&](int u) { return v.lattice[u] && kept.back().lattice[u]; };  // two corners, however near
        if (kept.empty() || v.f - kept.back().f > kSame || clash(0) || clash(1)) {
            kept.push_back(v);
            continue;
        }
        for (int u = 0; u < 2; ++u)
            if (v.lattice[u]) kept.back().lattice[u] = true, kept.back().t[u] = v.t[u];
    }
    return kept;
}

RimVertex Rims::end_of(const Rim& rim, int end) const {
    RimVertex v;
    v.f = end;
    for (std::size_t u = 0; u < rim.uses.size(); ++u) {
        v.t[u] = end ? rim.uses[u].t1 : rim.uses[u].t0;
        for (const double t : asked_[rim.uses[u].member][rim.uses[u].edge])
            if (std::fabs(t - v.t[u]) < kSame) v.t[u] = t, v.lattice[u] = true;
    }
    return v;
}

std::vector<double> Rims::inside(const RimUse& use) const {
    const auto [low, high] = std::minmax(use.t0, use.t1);
    std::vector<double> list;
    for (const double t : asked_[use.member][use.edge])
        if (t - low > kSame && high - t > kSame) list.push_back(t);
    if (use.t1 < use.t0) std::reverse(list.begin(), list.end());
    return list;
}

RimVertex Rims::both(const Rim& rim, int u, double t) const {
    const RimUse& owner = rim.uses[0];
    const auto fraction = [](const RimUse& use, double at) { return (at - use.t0) / (use.t1 - use.t0); };
    RimVertex v;
    v.t[u] = t, v.lattice[u] = true;
    const bool affine = rim.uses.size() < 2 || rim.uses[1].affine;
    v.f = u == 0 || affine ? fraction(rim.uses[u], t) : fraction(owner, projected(surface_, owner, on_edge(surface_, rim.uses[1], t)));
    v.f = std::clamp(v.f, 2 * kSame, 1 - 2 * kSame);
    if (rim.uses.size() < 2) return v;
    const RimUse& other = rim.uses[1 - u];
    v.t[1 - u] = affine || u == 1 ? other.t0 + v.f * (other.t1 - other.t0) : projected(surface_, other, on_edge(surface_, owner, t));
    return v;
}

std::vector<RimPiece> rim_pieces(const Composite& surface, const Topology& topology, const Leaves& leaves, std::uint32_t r, int u) {
    const RimUse& use = topology.rims[r].uses[std::size_t(u)];
    const Patch& patch = surface[use.member].patch;
    std::vector<RimPiece> pieces;
    for (std::uint32_t i = 0; i < leaves.list.size(); ++i) {
        const Leaf& leaf = leaves.list[i];
        for (int c = 0; c < leaf.sides; ++c) {
            const LatticePoint &a = leaf.corner[c], &b = leaf.corner[(c + 1) % leaf.sides];
            if (!leaves.on_edge(patch, use.edge, a) || !leaves.on_edge(patch, use.edge, b)) continue;
            const auto fraction = [&](const LatticePoint& p) {
                const double t = edge_parameter(patch, use.edge, leaves.at(p));
                if (use.affine) return (t - use.t0) / (use.t1 - use.t0);
                const RimUse& owner = topology.rims[r].uses[0];
                return (projected(surface, owner, on_edge(surface, use, t)) - owner.t0) / (owner.t1 - owner.t0);
            };
            const auto [low, high] = std::minmax({fraction(a), fraction(b)});
            if (high > kSame && low < 1 - kSame) pieces.push_back({low, high, i});
        }
    }
    std::sort(pieces.begin(), pieces.end(), [](const RimPiece& a, const RimPiece& b) { return a.f0 < b.f0; });
    return pieces;
}

}  // namespace isoparm
