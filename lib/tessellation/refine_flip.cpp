// refine_flip.cpp -- how a Refinement mends triangles without more of them: the other diagonal of a triangle and its neighbour.
#include <algorithm>

#include "tessellation/refine.h"

namespace isoparm {
namespace {

constexpr std::size_t kFlipsTogether = 10;  // triangles whose flips, two by three each at most, are bounded in one go

double twice_area(const Vec2& a, const Vec2& b, const Vec2& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// Lets the edges of triangle i know it, which are known to lie beside i or j.
void claim(PatchMesh& mesh, std::uint32_t i, std::uint32_t j, std::uint32_t diagonal) {
    for (const auto e : mesh.triangles[i].edge) {
        auto& side = mesh.edges[e].side;
        if (e != diagonal) side[side[0] != i && side[0] != j] = i;
    }
}

}  // namespace

/// Cells are u-major.
const BoundCell* PatchMesh::root_of(const std::array<std::uint32_t, 3>& corner) const {
    const auto index = [&](const std::vector<double>& breaks, double Vec2::*axis) {
        const double low = std::min({uv[corner[0]].*axis, uv[corner[1]].*axis, uv[corner[2]].*axis});
        return std::size_t(std::upper_bound(breaks.begin(), breaks.end(), low) - breaks.begin());
    };
    return cells[index(breaks_u, &Vec2::x) * (breaks_v.size() + 1) + index(breaks_v, &Vec2::y)].get();
}

/// A diagonal, and the two triangles beside it if it were the other one.
struct Refinement::Flip {
    std::uint32_t i = kNone, j = kNone, diagonal = kNone, from = 0, to = 0;
    PatchTriangle left, right;
    bool together = false;  // polynomials serve both
};
struct Refinement::Flips {
    std::array<Flip, 3> list;
    std::size_t count = 0;
};

/// Edge k of a triangle, turned into the other diagonal of the quadrilateral around it; false where that cannot be.
bool Refinement::flip_of(const PatchMesh& mesh, std::uint32_t i, int k, Flip& f) const {
    const PatchTriangle& t = mesh.triangles[i];
    const auto diagonal = t.edge[k];
    const PatchEdge& e = mesh.edges[diagonal];
    const auto j = e.side[0] == i ? e.side[1] : e.side[0];
    if (e.rim_node != kNone || e.marked || j == kNone || mesh.on_break(e)) return false;
    const PatchTriangle& o = mesh.triangles[j];
    const int m = (o.edge[1] == diagonal) + 2 * (o.edge[2] == diagonal);
    const auto a = t.corner[k], b = t.corner[(k + 1) % 3], c = t.corner[(k + 2) % 3], d = o.corner[(m + 2) % 3];
    const auto area = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) { return twice_area(mesh.uv[p], mesh.uv[q], mesh.uv[r]); };
    const double thin = 0.02 * (area(a, b, c) + area(b, a, d));  // both triangles have some area: the quadrilateral is convex
    if (!(area(a, d, c) > thin && area(d, b, c) > thin)) return false;
    if (mesh.vertex[c] == mesh.vertex[d] || mesh.left_out(t) || mesh.left_out(o) || mesh.in_fan(t) || mesh.in_fan(o)) return false;
    f.i = i, f.j = j, f.diagonal = diagonal, f.from = c, f.to = d;
    f.left.corner = {a, d, c}, f.left.edge = {o.edge[(m + 1) % 3], diagonal, t.edge[(k + 2) % 3]};
    f.right.corner = {d, b, c}, f.right.edge = {o.edge[(m + 2) % 3], t.edge[(k + 1) % 3], diagonal};
    for (PatchTriangle* n : {&f.left, &f.right}) n->cell = mesh.root_of(n->corner);
    return true;
}

bool Refinement::keeps(const PatchMesh& mesh, const PatchTriangle& t) const {
    return t.proof.own(measure_) + mesh.slack_of(t) <= tolerance_ && turns_little(mesh, t);
}

/// Turns an edge whose new triangles are below the tolerance by themselves; with all their neighbours, these must be as well.
bool Refinement::flip(PatchMesh& mesh, const Flip& f, bool with_neighbours) const {
    const auto i = f.i, j = f.j;
    PatchTriangle &t = mesh.triangles[i], &o = mesh.triangles[j];
    PatchEdge& e = mesh.edges[f.diagonal];
    const PatchTriangle before[2] = {t, o};
    const std::array<std::uint32_t, 2> ends{e.a, e.b};
    const auto put = [&](const PatchTriangle& first, const PatchTriangle& second, std::uint32_t from, std::uint32_t to) {
        t = first, o = second, e.a = from, e.b = to;
        claim(mesh, i, j, f.diagonal), claim(mesh, j, i, f.diagonal);
    };
    const auto any_beside = [&](auto what) {
        for (const auto n : {i, j})
            for (const auto edge : mesh.triangles[n].edge)
                for (const auto beside : mesh.edges[edge].side)
                    if (beside != kNone && what(beside)) return true;
        return false;
    };
    put(f.left, f.right, f.from, f.to);
    if (with_neighbours && any_beside([&](std::uint32_t n) { return !mesh.left_out(mesh.triangles[n]) && !(bound_of(mesh, n) <= tolerance_); })) {
        put(before[0], before[1], ends[0], ends[1]);
        return false;
    }
    any_beside([&](std::uint32_t n) { return mesh.settled[n] = kUnsettled, false; });
    return true;
}

/// Is the surface farther than the tolerance from the middle of the new diagonal? Nothing is proved by that.
bool Refinement::in_vain(const PatchMesh& mesh, std::uint32_t member, const Flip& f) const {
    const Vec2 &p = mesh.uv[f.from], &q = mesh.uv[f.to];
    const Vec2 middle{0.5 * p.x + 0.5 * q.x, 0.5 * p.y + 0.5 * q.y};
    const PolynomialCell& near = f.left.cell->polynomial();
    const Point d = (near.exact() ? near.point(middle) : surface_[member].patch.point(middle.x, middle.y)) - 0.5 * (positions_[mesh.vertex[f.from]] + positions_[mesh.vertex[f.to]]);
    return (measure_ == Measure::parametric ? length(d) : std::fabs(dot(d, mesh.triangles[f.i].proof.normal_of_plane()))) > tolerance_;
}

/// The worst edge first.
void Refinement::flips_of(const PatchMesh& mesh, std::uint32_t member, std::uint32_t i, Flips& found) const {
    const int worst = mesh.triangles[i].proof.worst_edge;
    found.count = 0;
    for (int k = 0; k < 3; ++k) {
        Flip& f = found.list[found.count];
        if (!flip_of(mesh, i, (worst + k) % 3, f)) continue;
        f.together = sharp_cell(mesh, member, f.left) && sharp_cell(mesh, member, f.right);
        found.count += !(f.together && in_vain(mesh, member, f));
    }
}

/// Where polynomials serve, all that can be turned are bounded together.
void Refinement::bound_flips(const PatchMesh& mesh, std::uint32_t member, std::span<Flips> all) const {
    std::array<PatchTriangle*, 6 * kFlipsTogether> together;
    std::size_t count = 0;
    for (Flips& flips : all)
        for (std::size_t k = 0; k < flips.count; ++k)
            if (flips.list[k].together) together[count++] = &flips.list[k].left, together[count++] = &flips.list[k].right;
    bound_together(mesh, member, {together.data(), count}, true);
}

/// The first that helps. Returns it, or nullptr.
const Refinement::Flip* Refinement::flip_first(PatchMesh& mesh, std::uint32_t member, Flips& flips, bool with_neighbours) const {
    for (std::size_t k = 0; k < flips.count; ++k) {
        Flip& f = flips.list[k];
        if (!f.together) {
            bound(mesh, member, f.left, true);
            if (!keeps(mesh, f.left)) continue;
            bound(mesh, member, f.right, true);
        }
        if (keeps(mesh, f.left) && keeps(mesh, f.right) && flip(mesh, f, with_neighbours)) return &f;
    }
    return nullptr;
}

bool Refinement::flip_any(PatchMesh& mesh, std::uint32_t member, std::uint32_t i, bool with_neighbours) const {
    Flips flips;
    flips_of(mesh, member, i, flips);
    bound_flips(mesh, member, {&flips, 1});
    return flip_first(mesh, member, flips, with_neighbours) != nullptr;
}

/// One fresh triangle after the other, some of them bounded ahead: what another flip has touched since is looked at anew, so that the outcome is the same.
void Refinement::flip_fresh(PatchMesh& mesh, std::uint32_t member) const {
    std::array<Flips, kFlipsTogether> ahead;
    std::array<std::uint32_t, kFlipsTogether> of;
    std::array<std::uint32_t, 2 * kFlipsTogether> touched;
    const auto fails = [&](std::uint32_t i) { return !(mesh.triangles[i].proof.own(measure_) + mesh.slack_of(mesh.triangles[i]) <= tolerance_); };
    for (std::size_t next = 0; next < mesh.fresh.size();) {
        std::size_t n = 0, changed = 0;
        for (; next < mesh.fresh.size() && n < kFlipsTogether; ++next)
            if (const auto i = mesh.fresh[next]; fails(i)) of[n] = i, flips_of(mesh, member, i, ahead[n++]);
        bound_flips(mesh, member, {ahead.data(), n});
        const auto is_touched = [&](std::uint32_t i) { return std::find(touched.begin(), touched.begin() + changed, i) != touched.begin() + changed; };
        for (std::size_t k = 0; k < n; ++k) {
            if (!fails(of[k])) continue;  // a flip before has mended it
            bool stale = is_touched(of[k]);
            for (const auto e : mesh.triangles[of[k]].edge) stale = stale || is_touched(mesh.edges[e].side[0]) || is_touched(mesh.edges[e].side[1]);
            if (stale) {
                flips_of(mesh, member, of[k], ahead[k]);
                bound_flips(mesh, member, {&ahead[k], 1});
            }
            if (const Flip* f = flip_first(mesh, member, ahead[k], false)) touched[changed++] = f->i, touched[changed++] = f->j;
        }
    }
}

}  // namespace isoparm
