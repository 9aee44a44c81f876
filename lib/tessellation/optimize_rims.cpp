#include "tessellation/optimize_rims.h"

#include <algorithm>

namespace isoparm {

FreeComposite::FreeComposite(const Refinement& refinement, const Composite& surface, const Topology& topology, double tolerance, Measure measure)
    : refinement_(refinement), surface_(surface), topology_(topology) {
    for (std::size_t m = 0; m < surface.size(); ++m) patches_.emplace_back(surface[m].patch, refinement.patches()[m], refinement.positions(), tolerance, measure);
    // Leaves of the rims, in order, are the pieces between points.
    std::vector<std::vector<std::uint32_t>> pieces(topology.rims.size());
    const auto& nodes = refinement.rim_nodes();
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].child == kNone) pieces[nodes[i].rim].push_back(i);
    for (std::uint32_t r = 0; r < pieces.size(); ++r) {
        auto& list = pieces[r];
        std::sort(list.begin(), list.end(), [&](auto a, auto b) { return nodes[a].f0 < nodes[b].f0; });
        const Rim& rim = topology.rims[r];
        for (std::size_t i = 0; i <= list.size(); ++i) {
            const RimNode& node = nodes[list[std::min(i, list.size() - 1)]];
            const bool end = i == list.size();
            RimPoint p;
            p.rim = r, p.vertex = end ? node.b : node.a, p.f = end ? node.f1 : node.f0;
            p.x = refinement.positions()[p.vertex];
            const auto index = std::uint32_t(points_.size());
            const bool inner = i > 0 && !end;
            if (i > 0) p.before = index - 1;
            if (!end) p.after = index + 1;
            for (std::size_t use = 0; use < rim.uses.size(); ++use) {
                const PatchEdge& e = refinement.patches()[rim.uses[use].member].edges[node.edge[use]];
                p.corner[use] = e.reversed != end ? e.b : e.a;
                FreePatch& patch = patches_[rim.uses[use].member];
                const bool free = inner && !rim.collapsed && patch.corners()[p.corner[use]].freedom == Freedom::inside;
                patch.set_freedom(p.corner[use], free ? Freedom::rim : Freedom::fixed, free ? index : kNone);
            }
            points_.push_back(p);
        }
    }
}

void FreeComposite::place(const RimPoint& p, double f, Point& x, std::array<Vec2, 2>& uv) const {
    const Rim& rim = topology_.rims[p.rim];
    const RimUse& owner = rim.uses[0];
    const Vec2 at = surface_[owner.member].patch.edge_point(owner.edge, owner.t0 + f * (owner.t1 - owner.t0));
    x = surface_[owner.member].patch.point(at.x, at.y);
    for (std::size_t use = 0; use < rim.uses.size(); ++use) {
        const RimUse& u = rim.uses[use];
        const auto parameter = [&](std::uint32_t point) {
            return edge_parameter(surface_[u.member].patch, u.edge, patches_[u.member].corners()[points_[point].corner[use]].uv);
        };
        const auto [low, high] = std::minmax({parameter(p.before), parameter(p.after)});
        uv[use] = refinement_.on_rim(u, f, x, low, high);
    }
}

std::size_t FreeComposite::count() const {
    std::size_t n = 0;
    for (const auto& p : patches_) n += p.count();
    return n;
}

PatchMesh FreeComposite::mesh_of(std::size_t member, std::vector<RimNode>& nodes, const std::vector<std::uint32_t>& node_of) const {
    const FreePatch& patch = patches_[member];
    PatchMesh mesh;
    mesh.breaks_u = surface_[member].patch.breaks_u(), mesh.breaks_v = surface_[member].patch.breaks_v();
    std::vector<std::uint32_t> number(patch.corners().size(), kNone);
    std::vector<std::uint32_t> first(patch.corners().size(), kNone), next;  // edges by their smaller corner
    for (std::size_t i = 0; i < number.size(); ++i) {
        const FreeCorner& c = patch.corners()[i];
        if (!c.live()) continue;
        number[i] = std::uint32_t(mesh.uv.size());
        mesh.uv.push_back(c.uv), mesh.vertex.push_back(c.vertex);
    }
    const auto edge = [&](std::uint32_t a, std::uint32_t b) {
        const auto [low, high] = std::minmax(number[a], number[b]);
        for (auto e = first[low]; e != kNone; e = next[e])
            if (std::max(mesh.edges[e].a, mesh.edges[e].b) == high) return e;
        mesh.edges.emplace_back();
        mesh.edges.back().a = number[a], mesh.edges.back().b = number[b];
        next.push_back(first[low]);
        return first[low] = std::uint32_t(mesh.edges.size() - 1);
    };
    for (const FreeTriangle& from : patch.triangles()) {
        if (!from.live) continue;
        PatchTriangle t;
        const auto index = std::uint32_t(mesh.triangles.size());
        for (int k = 0; k < 3; ++k) {
            t.corner[k] = number[from.corner[k]], t.edge[k] = edge(from.corner[k], from.corner[(k + 1) % 3]);
            auto& side = mesh.edges[t.edge[k]].side;
            side[side[0] != kNone] = index;
        }
        t.cell = from.root, t.proof = from.proof;
        if (!from.proved) mesh.fresh.push_back(index);
        mesh.triangles.push_back(t);
    }
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        const RimPoint& p = points_[i];
        if (!p.live || p.after == kNone) continue;
        const Rim& rim = topology_.rims[p.rim];
        for (std::uint32_t use = 0; use < rim.uses.size(); ++use) {
            if (rim.uses[use].member != member) continue;
            const auto e = edge(p.corner[use], points_[p.after].corner[use]);
            PatchEdge& found = mesh.edges[e];
            found.rim_node = node_of[i], found.use = use, found.reversed = found.a != number[p.corner[use]];
            nodes[node_of[i]].edge[use] = e;
        }
    }
    return mesh;
}

void FreeComposite::write(Refinement& refinement) const {
    std::vector<RimNode> nodes;
    std::vector<std::uint32_t> node_of(points_.size(), kNone);
    std::vector<Point> positions = refinement_.positions();
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const RimPoint& p = points_[i];
        if (!p.live || p.after == kNone) continue;
        node_of[i] = std::uint32_t(nodes.size());
        RimNode node;
        node.rim = p.rim, node.f0 = p.f, node.f1 = points_[p.after].f, node.a = p.vertex, node.b = points_[p.after].vertex;
        nodes.push_back(node);
    }
    for (const FreePatch& p : patches_)
        for (const FreeCorner& c : p.corners())
            if (c.live()) positions[c.vertex] = c.x;
    std::vector<PatchMesh> meshes(patches_.size());
    for (std::size_t m = 0; m < patches_.size(); ++m) meshes[m] = mesh_of(m, nodes, node_of);
    refinement.replace(std::move(meshes), std::move(nodes), std::move(positions));
}

}  // namespace isoparm
