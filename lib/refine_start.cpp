// refine_start.cpp -- the triangulation that a Refinement begins with.
#include <map>

#include "refine.h"

namespace isoparm {

/// The first triangulation: the cells between breaks, each cut along its shorter diagonal, or into a fan about its middle
/// when other patches put nodes on its sides.
void Refinement::build_patch(std::uint32_t member) {
    const Patch& patch = surface_[member].patch;
    PatchMesh& mesh = patches_[member];
    std::map<std::pair<double, double>, std::uint32_t> corners;
    const auto corner = [&](const Vec2& p, std::uint32_t vertex) {
        const auto [it, fresh] = corners.try_emplace({p.x, p.y}, std::uint32_t(mesh.uv.size()));
        if (fresh) {
            mesh.uv.push_back(p);
            if (vertex == kNone) {
                vertex = std::uint32_t(positions_.size());
                positions_.push_back(patch.point(p.x, p.y));
                shared_.push_back(0);
            }
            mesh.vertex.push_back(vertex);
        }
        return it->second;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    const auto edge = [&](std::uint32_t a, std::uint32_t b) {
        const auto [it, fresh] = known.try_emplace(std::minmax(a, b), std::uint32_t(mesh.edges.size()));
        if (fresh) {
            mesh.edges.emplace_back();
            mesh.edges.back().a = a, mesh.edges.back().b = b;
        }
        return it->second;
    };
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        PatchTriangle t;
        t.corner = {a, b, c};
        t.edge = {edge(a, b), edge(b, c), edge(c, a)};
        t.cell = mesh.cells.back().get();
        const auto index = std::uint32_t(mesh.triangles.size());
        for (const auto e : t.edge) mesh.edges[e].side[mesh.edges[e].side[0] != kNone] = index;
        mesh.fresh.push_back(index);
        mesh.triangles.push_back(t);
    };
    // Rims along the four (three) edges.
    std::array<std::vector<std::uint32_t>, 4> side;  // corners along each edge, in its direction
    for (int k = 0; k < patch.edges(); ++k)
        for (const EdgeRim& er : topology_.edges[member][k]) {
            const Rim& rim = topology_.rims[er.rim];
            const RimUse& use = rim.uses[er.use];
            const auto a = corner(patch.edge_point(k, use.t0), rim.a), b = corner(patch.edge_point(k, use.t1), rim.b);
            PatchEdge e;
            e.a = a, e.b = b, e.rim_node = er.rim, e.use = er.use;
            known[std::minmax(a, b)] = rim_nodes_[er.rim].edge[er.use] = std::uint32_t(mesh.edges.size());
            mesh.edges.push_back(e);
            if (side[k].empty()) side[k].push_back(er.reversed ? b : a);
            side[k].push_back(er.reversed ? a : b);
        }
    const auto fan = [&](const std::vector<std::uint32_t>& polygon, const Vec2& centre) {
        const auto c = corner(centre, kNone);
        for (std::size_t i = 0; i < polygon.size(); ++i) triangle(polygon[i], polygon[(i + 1) % polygon.size()], c);
    };
    if (patch.domain() == Domain::triangle) {
        mesh.cells.push_back(std::make_unique<BoundCell>(patch, Box{{0, 1}, {0, 1}}));
        std::vector<std::uint32_t> polygon;  // C -> A -> B -> C
        for (int k : {1, 2, 0}) polygon.insert(polygon.end(), side[k].begin(), side[k].end() - 1);
        if (polygon.size() == 3) triangle(polygon[0], polygon[1], polygon[2]);
        else fan(polygon, {1.0 / 3, 1.0 / 3});
        return;
    }
    const std::vector<double> us = patch.lines_u(), vs = patch.lines_v();
    // Corners of side k from parameter `from` to `to` (of u or v), both included, in that direction.
    const auto piece = [&](int k, double from, double to, std::vector<std::uint32_t>& out) {
        std::vector<std::uint32_t> found;
        for (auto c : side[k]) {
            const double t = k == 0 || k == 2 ? mesh.uv[c].x : mesh.uv[c].y;
            if (t >= std::min(from, to) && t <= std::max(from, to)) found.push_back(c);
        }
        if (from > to) std::reverse(found.begin(), found.end());
        out.insert(out.end(), found.begin(), found.end() - 1);
    };
    for (std::size_t i = 0; i + 1 < us.size(); ++i)
        for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
            const double u0 = us[i], u1 = us[i + 1], v0 = vs[j], v1 = vs[j + 1];
            mesh.cells.push_back(std::make_unique<BoundCell>(patch, Box{{u0, u1}, {v0, v1}}));
            std::vector<std::uint32_t> polygon;
            if (j == 0) piece(0, u0, u1, polygon);
            else polygon.push_back(corner({u0, v0}, kNone));
            if (i + 2 == us.size()) piece(1, v0, v1, polygon);
            else polygon.push_back(corner({u1, v0}, kNone));
            if (j + 2 == vs.size()) piece(2, u1, u0, polygon);
            else polygon.push_back(corner({u1, v1}, kNone));
            if (i == 0) piece(3, v1, v0, polygon);
            else polygon.push_back(corner({u0, v1}, kNone));
            if (polygon.size() != 4) {
                fan(polygon, {0.5 * u0 + 0.5 * u1, 0.5 * v0 + 0.5 * v1});
                continue;
            }
            const auto at = [&](int k) { return positions_[mesh.vertex[polygon[k]]]; };
            if (distance(at(0), at(2)) <= distance(at(1), at(3)) * (1 + 1e-9)) {
                triangle(polygon[0], polygon[1], polygon[2]);
                triangle(polygon[0], polygon[2], polygon[3]);
            } else {
                triangle(polygon[1], polygon[2], polygon[3]);
                triangle(polygon[1], polygon[3], polygon[0]);
            }
        }
}

}  // namespace isoparm
