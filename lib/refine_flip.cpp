// refine_flip.cpp -- how a Refinement mends triangles without more of them: the other diagonal of a triangle and its neighbour.
#include <algorithm>

#include "refine.h"

namespace isoparm {
namespace {

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

/// Turns edge k of a triangle into the other diagonal of the quadrilateral around it, if the two triangles are below the tolerance
/// then: each by itself, or with all their neighbours, which must be as well.
bool Refinement::flip(PatchMesh& mesh, std::uint32_t member, std::uint32_t i, int k, bool with_neighbours) const {
    PatchTriangle& t = mesh.triangles[i];
    const auto diagonal = t.edge[k];
    PatchEdge& e = mesh.edges[diagonal];
    const auto j = e.side[0] == i ? e.side[1] : e.side[0];
    if (e.rim_node != kNone || e.marked || j == kNone || mesh.on_break(e)) return false;
    PatchTriangle& o = mesh.triangles[j];
    const int m = int(std::find(o.edge.begin(), o.edge.end(), diagonal) - o.edge.begin());
    const auto a = t.corner[k], b = t.corner[(k + 1) % 3], c = t.corner[(k + 2) % 3], d = o.corner[(m + 2) % 3];
    if (mesh.vertex[c] == mesh.vertex[d] || mesh.left_out(t) || mesh.left_out(o)) return false;
    const auto area = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) { return twice_area(mesh.uv[p], mesh.uv[q], mesh.uv[r]); };
    const double thin = 0.02 * (area(a, b, c) + area(b, a, d));  // both triangles have some area: the quadrilateral is convex
    if (!(area(a, d, c) > thin && area(d, b, c) > thin)) return false;

    PatchTriangle left, right;
    left.corner = {a, d, c}, left.edge = {o.edge[(m + 1) % 3], diagonal, t.edge[(k + 2) % 3]};
    right.corner = {d, b, c}, right.edge = {o.edge[(m + 2) % 3], t.edge[(k + 1) % 3], diagonal};
    for (PatchTriangle* n : {&left, &right}) {
        n->cell = mesh.root_of(n->corner);
        bound(mesh, member, *n, true);
        if (!(n->proof.own(measure_) + mesh.slack_of(*n) <= tolerance_ && turns_little(mesh, *n))) return false;
    }
    const PatchTriangle before[2] = {t, o};
    const auto put = [&](const PatchTriangle& first, const PatchTriangle& second, std::uint32_t from, std::uint32_t to) {
        t = first, o = second, e.a = from, e.b = to;
        claim(mesh, i, j, diagonal), claim(mesh, j, i, diagonal);
    };
    const auto any_beside = [&](auto f) {
        for (const auto n : {i, j})
            for (const auto edge : mesh.triangles[n].edge)
                for (const auto beside : mesh.edges[edge].side)
                    if (beside != kNone && f(beside)) return true;
        return false;
    };
    put(left, right, c, d);
    if (with_neighbours && any_beside([&](std::uint32_t n) { return !mesh.left_out(mesh.triangles[n]) && !(bound_of(mesh, n) <= tolerance_); })) {
        put(before[0], before[1], a, b);
        return false;
    }
    any_beside([&](std::uint32_t n) { return mesh.triangles[n].settled = false; });
    return true;
}

/// The worst edge first.
bool Refinement::flip_any(PatchMesh& mesh, std::uint32_t member, std::uint32_t i, bool with_neighbours) const {
    const int worst = mesh.triangles[i].proof.worst_edge;
    for (int k = 0; k < 3; ++k)
        if (flip(mesh, member, i, (worst + k) % 3, with_neighbours)) return true;
    return false;
}

}  // namespace isoparm
