// refine_split.cpp -- how a Refinement bisects its marked edges.
#include <tbb/parallel_for.h>

#include <algorithm>

#include "tessellation/refine.h"

namespace isoparm {

double edge_parameter(const Patch& patch, int edge, const Vec2& p) {
    if (patch.domain() == Domain::triangle) return edge == 0 ? 1 - p.y : edge == 1 ? p.x : p.y;
    const Rect r = patch.rect();
    return edge == 0 || edge == 2 ? (p.x - r.u0) / (r.u1 - r.u0) : (p.y - r.v0) / (r.v1 - r.v0);
}

Vec2 Refinement::on_rim(const RimUse& use, double fraction, const Point& position, double low, double high) const {
    const Patch& patch = surface_[use.member].patch;
    double t = use.t0 + fraction * (use.t1 - use.t0);
    if (fraction == 0) t = use.t0;
    if (fraction == 1) t = use.t1;
    if (!use.affine && fraction > 0 && fraction < 1) {
        t = nearest_on_edge(patch, use.edge, position, low, high);
        // Parameters along a rim must stay in order; a point at the end of its bracket is put inside it.
        const double margin = 1e-3 * (high - low);
        t = std::clamp(t, low + margin, high - margin);
    }
    return patch.edge_point(use.edge, t);
}

void Refinement::split_rims() {
    std::sort(marked_rims_.begin(), marked_rims_.end());
    for (const auto i : marked_rims_) {
        const RimNode node = rim_nodes_[i];
        const Rim& rim = topology_.rims[node.rim];
        const double f = 0.5 * node.f0 + 0.5 * node.f1;
        std::uint32_t middle = node.a;
        if (!rim.collapsed) {
            const RimUse& owner = rim.uses[0];
            const Vec2 p = surface_[owner.member].patch.edge_point(owner.edge, owner.t0 + f * (owner.t1 - owner.t0));
            middle = std::uint32_t(positions_.size());
            positions_.push_back(surface_[owner.member].patch.point(p.x, p.y));
            shared_.push_back(1);
        }
        rim_nodes_[i].child = std::uint32_t(rim_nodes_.size());
        RimNode low, high;
        low.rim = high.rim = node.rim;
        low.f0 = node.f0, low.f1 = high.f0 = f, high.f1 = node.f1;
        low.a = node.a, low.b = high.a = middle, high.b = node.b;
        rim_nodes_.push_back(low);
        rim_nodes_.push_back(high);
        for (std::size_t use = 0; use < rim.uses.size(); ++use) patches_[rim.uses[use].member].marked.push_back(node.edge[use]);
    }
    marked_rims_.clear();
}

/// Bisects the marked edges of a patch. Vertices inside it stay kNone here: split_marked() numbers them.
void Refinement::split_edges(std::uint32_t member) {
    PatchMesh& mesh = patches_[member];
    const Patch& patch = surface_[member].patch;
    std::sort(mesh.marked.begin(), mesh.marked.end());
    for (const auto i : mesh.marked) {
        const PatchEdge e = mesh.edges[i];
        const auto middle = std::uint32_t(mesh.uv.size()), child = std::uint32_t(mesh.edges.size());
        PatchEdge low, high;
        low.a = e.a, low.b = high.a = middle, high.b = e.b;
        low.use = high.use = e.use, low.reversed = high.reversed = e.reversed;
        if (e.rim_node != kNone) {
            const RimNode& node = rim_nodes_[e.rim_node];
            const RimUse& use = topology_.rims[node.rim].uses[e.use];
            const double ta = edge_parameter(patch, use.edge, mesh.uv[e.a]), tb = edge_parameter(patch, use.edge, mesh.uv[e.b]);
            const std::uint32_t vertex = rim_nodes_[node.child].b;
            mesh.uv.push_back(on_rim(use, 0.5 * node.f0 + 0.5 * node.f1, positions_[vertex], std::min(ta, tb), std::max(ta, tb)));
            mesh.vertex.push_back(vertex);
            low.rim_node = e.reversed ? node.child + 1 : node.child;
            high.rim_node = e.reversed ? node.child : node.child + 1;
            rim_nodes_[low.rim_node].edge[e.use] = child, rim_nodes_[high.rim_node].edge[e.use] = child + 1;
        } else {
            const Vec2 &a = mesh.uv[e.a], &b = mesh.uv[e.b];
            mesh.uv.push_back({0.5 * a.x + 0.5 * b.x, 0.5 * a.y + 0.5 * b.y});
            mesh.vertex.push_back(kNone);
        }
        mesh.edges[i].child = child;
        mesh.edges.push_back(low);
        mesh.edges.push_back(high);
    }
}

/// Replaces the triangles beside marked edges by two, three or four; edges from first_edge on are new in this round.
void Refinement::split_triangles(std::uint32_t member, std::uint32_t first_edge) {
    PatchMesh& mesh = patches_[member];
    // The half of edge e that starts at corner c.
    const auto half = [&](std::uint32_t e, std::uint32_t c) { return mesh.edges[e].a == c ? mesh.edges[e].child : mesh.edges[e].child + 1; };
    const auto middle = [&](std::uint32_t e) { return mesh.edges[mesh.edges[e].child].b; };
    const auto add_edge = [&](std::uint32_t a, std::uint32_t b) {
        mesh.edges.emplace_back();
        mesh.edges.back().a = a, mesh.edges.back().b = b;
        return std::uint32_t(mesh.edges.size() - 1);
    };
    const auto at = [&](std::uint32_t c) { return positions_[mesh.vertex[c]]; };
    std::vector<std::uint32_t> beside;
    for (const auto e : mesh.marked)
        for (const auto t : mesh.edges[e].side)
            if (t != kNone) beside.push_back(t);
    std::sort(beside.begin(), beside.end());
    beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
    for (const auto i : beside) {
        PatchTriangle t = mesh.triangles[i];
        int cut = 0;
        for (auto e : t.edge) cut += mesh.edges[e].child != kNone;
        auto put = [&, first = true](std::array<std::uint32_t, 3> c, std::array<std::uint32_t, 3> e) mutable {
            PatchTriangle part;
            part.corner = c, part.edge = e, part.cell = t.cell;
            const auto index = first ? i : std::uint32_t(mesh.triangles.size());
            for (const auto k : e) {
                auto& side = mesh.edges[k].side;
                side[k < first_edge ? side[0] != i : side[0] != kNone] = index;
                for (const auto beside : side)
                    if (beside < mesh.settled.size()) mesh.settled[beside] = kUnsettled;
            }
            if (first) mesh.triangles[i] = part;
            else mesh.triangles.push_back(part), mesh.settled.push_back(kUnsettled);
            mesh.fresh.push_back(index);
            first = false;
        };
        // Turn the triangle so that edge 0 is cut, and with two cuts edge 1 too.
        const auto is_cut = [&](int k) { return mesh.edges[t.edge[k % 3]].child != kNone; };
        int turn = 0;
        while (!is_cut(turn) || (cut == 2 && !is_cut(turn + 1))) ++turn;
        std::rotate(t.corner.begin(), t.corner.begin() + turn, t.corner.end());
        std::rotate(t.edge.begin(), t.edge.begin() + turn, t.edge.end());
        const auto [a, b, c] = t.corner;
        const auto [ab, bc, ca] = t.edge;
        const auto m = middle(ab);
        if (cut == 1) {
            const auto mc = add_edge(m, c);
            put({a, m, c}, {half(ab, a), mc, ca});
            put({m, b, c}, {half(ab, b), bc, mc});
            continue;
        }
        const auto k = middle(bc);
        const auto mk = add_edge(m, k);
        put({m, b, k}, {half(ab, b), half(bc, b), mk});
        if (cut == 2) {  // the quadrangle a m k c, along its shorter diagonal
            if (distance(at(a), at(k)) <= distance(at(m), at(c)) * (1 + 1e-9)) {
                const auto ak = add_edge(a, k);
                put({a, m, k}, {half(ab, a), mk, ak});
                put({a, k, c}, {ak, half(bc, c), ca});
            } else {
                const auto mc = add_edge(m, c);
                put({a, m, c}, {half(ab, a), mc, ca});
                put({m, k, c}, {mk, half(bc, c), mc});
            }
            continue;
        }
        const auto l = middle(ca);
        const auto kl = add_edge(k, l), lm = add_edge(l, m);
        put({a, m, l}, {half(ab, a), lm, half(ca, a)});
        put({l, k, c}, {kl, half(bc, c), half(ca, c)});
        put({m, k, l}, {mk, kl, lm});
    }
}

void Refinement::split_marked() {
    split_rims();
    std::vector<std::size_t> first_corner(patches_.size());
    std::vector<std::uint32_t> first_edge(patches_.size());
    tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t m) {
        first_corner[m] = patches_[m].uv.size();
        first_edge[m] = std::uint32_t(patches_[m].edges.size());
        split_edges(std::uint32_t(m));
    });
    number_vertices(first_corner, first_edge);
}

/// New vertices inside the patches are numbered in the order of patches and corners, whatever thread made them.
void Refinement::number_vertices(const std::vector<std::size_t>& first_corner, const std::vector<std::uint32_t>& first_edge) {
    std::vector<std::size_t> first_vertex(patches_.size() + 1, positions_.size());
    for (std::size_t m = 0; m < patches_.size(); ++m) {
        std::size_t count = 0;
        for (std::size_t i = first_corner[m]; i < patches_[m].uv.size(); ++i) count += patches_[m].vertex[i] == kNone;
        first_vertex[m + 1] = first_vertex[m] + count;
    }
    positions_.resize(first_vertex.back());
    shared_.resize(first_vertex.back(), 0);
    tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t m) {
        place_vertices(std::uint32_t(m), first_corner[m], std::uint32_t(first_vertex[m]));
        measure_slack(std::uint32_t(m), first_corner[m]);
        split_triangles(std::uint32_t(m), first_edge[m]);
        patches_[m].marked.clear();
    });
    collect_slack();
}

void Refinement::place_vertices(std::uint32_t member, std::size_t first_corner, std::uint32_t first_vertex) {
    PatchMesh& mesh = patches_[member];
    std::vector<double> u, v;
    std::uint32_t next = first_vertex;
    for (std::size_t i = first_corner; i < mesh.uv.size(); ++i) {
        if (mesh.vertex[i] != kNone) continue;
        mesh.vertex[i] = next++;
        u.push_back(mesh.uv[i].x);
        v.push_back(mesh.uv[i].y);
    }
    surface_[member].patch.points(u.size(), u.data(), v.data(), positions_.data() + first_vertex);
}

}  // namespace isoparm
