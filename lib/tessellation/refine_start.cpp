// refine_start.cpp -- the triangulation that a Refinement begins with: in every cell between breaks rows of vertices, about as dense
// as the tolerance needs, and strips of triangles between them and to sides that other patches cut differently.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "tessellation/patch_builder.h"

namespace isoparm {

/// Rows in the cells of a patch, u-major; of the triangular domain one, with parts of the sides.
struct Refinement::Start {
    std::vector<double> us, vs;
    std::vector<Bends> bends;
    std::vector<DiceGrid> grids;
    int parts = 1;
    double triangles = 0;
    bool too_many = false;  // a cell had more by itself

    /// About how many triangles are needed, whatever their number is.
    double needed(const Patch& patch, double tolerance, Measure measure) const {
        double sum = 0;
        for (const Bends& b : bends) sum += patch.domain() == Domain::triangle ? dice_triangle_triangles(b, tolerance, measure) : dice_triangles(b, tolerance, measure);
        return sum;
    }

    Start() = default;
    /// Single cells when `most` is 0.
    Start(const Patch& patch, double tolerance, Measure measure, double most) : us(patch.lines_u()), vs(patch.lines_v()) {
        for (std::size_t i = 0; i + 1 < us.size(); ++i)
            for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
                const Box box{{us[i], us[i + 1]}, {vs[j], vs[j + 1]}};
                bends.emplace_back(patch, box, measure);
                if (patch.domain() == Domain::triangle) {
                    parts = most > 0 ? dice_triangle(bends.back(), tolerance, measure, most) : 1;
                    triangles += double(parts) * parts;
                    too_many = most > 0 && dice_triangle_triangles(bends.back(), tolerance, measure) > most;
                } else {
                    grids.push_back(most > 0 ? dice(bends.back(), box, tolerance, measure, most) : DiceGrid::single(box));
                    triangles += grids.back().triangles();
                    too_many |= grids.back().too_many;
                }
            }
    }

    /// Where the grids at edge k put vertices: t of the edge, growing, between its ends.
    std::vector<double> on_edge(const Patch& patch, int k) const {
        std::vector<double> list;
        if (patch.domain() == Domain::triangle) {
            for (int i = 1; i < parts; ++i) list.push_back(double(i) / parts);
            return list;
        }
        const std::size_t columns = us.size() - 1, rows = vs.size() - 1;
        const bool along_u = k == 0 || k == 2;
        const double a = along_u ? us.front() : vs.front(), b = along_u ? us.back() : vs.back();
        for (std::size_t i = 0; i < (along_u ? columns : rows); ++i) {
            const DiceGrid& grid = grids[along_u ? i * rows + (k == 0 ? 0 : rows - 1) : (k == 3 ? 0 : columns - 1) * rows + i];
            for (const double x : grid.side(k))
                if (x > a && x < b) list.push_back((x - a) / (b - a));
        }
        return list;
    }
};

void Refinement::start(double most) {
    std::vector<Start> starts(patches_.size());
    const auto make = [&](double limit) {
        tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t m) { starts[m] = Start(surface_[m].patch, tolerance_, measure_, limit); });
        double triangles = 0;
        for (const Start& s : starts) triangles += s.triangles;
        return triangles;
    };
    const bool fits = make(most) <= most;
    if (!fits || std::any_of(starts.begin(), starts.end(), [](const Start& s) { return s.too_many; })) {
        std::vector<double> needed(starts.size());
        tbb::parallel_for(std::size_t(0), starts.size(), [&](std::size_t m) { needed[m] = starts[m].needed(surface_[m].patch, tolerance_, measure_); });
        planned_ = std::accumulate(needed.begin(), needed.end(), 0.0);
    }
    if (!fits) make(0);
    cut_rims(starts);
    tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t m) { build_patch(std::uint32_t(m), starts[m]); });
    number_vertices(std::vector<std::size_t>(patches_.size(), 0), std::vector<std::uint32_t>(patches_.size(), 0));
}

/// A rim is cut as the patch asks that wants the most pieces, among those that have the owner's parametrisation.
void Refinement::cut_rims(const std::vector<Start>& starts) {
    for (std::uint32_t r = 0; r < topology_.rims.size(); ++r) {
        const Rim& rim = topology_.rims[r];
        std::vector<double> cuts;
        for (const RimUse& use : rim.uses) {
            if (!use.affine) continue;
            std::vector<double> here;
            const auto [low, high] = std::minmax(use.t0, use.t1);
            for (const double t : starts[use.member].on_edge(surface_[use.member].patch, use.edge))
                if (t > low + 1e-6 * (high - low) && t < high - 1e-6 * (high - low)) here.push_back((t - use.t0) / (use.t1 - use.t0));
            std::sort(here.begin(), here.end());
            if (here.size() > cuts.size()) cuts = here;
        }
        rim_pieces_.push_back(std::uint32_t(rim_nodes_.size()));
        const RimUse& owner = rim.uses[0];
        RimNode node;
        node.rim = r, node.a = rim.a, node.f0 = 0;
        for (const double f : cuts) {
            const Vec2 p = surface_[owner.member].patch.edge_point(owner.edge, owner.t0 + f * (owner.t1 - owner.t0));
            node.f1 = f, node.b = rim.a;
            if (!rim.collapsed) {
                node.b = std::uint32_t(positions_.size());
                positions_.push_back(surface_[owner.member].patch.point(p.x, p.y));
                shared_.push_back(1);
            }
            rim_nodes_.push_back(node);
            node.f0 = f, node.a = node.b;
        }
        node.f1 = 1, node.b = rim.b;
        rim_nodes_.push_back(node);
    }
    rim_pieces_.push_back(std::uint32_t(rim_nodes_.size()));
}

void Refinement::build_patch(std::uint32_t member, const Start& start) {
    const Patch& patch = surface_[member].patch;
    PatchMesh& mesh = patches_[member];
    PatchBuilder build(mesh, start.triangles);
    std::map<std::pair<double, double>, std::uint32_t> known;  // on the boundary, and where breaks cross
    const auto corner = [&](const Vec2& p, std::uint32_t vertex) {
        const auto [it, fresh] = known.try_emplace({p.x, p.y}, 0);
        if (fresh) it->second = build.corner(p, vertex);
        return it->second;
    };
    // Rims along the four (three) edges.
    std::array<Chain, 4> side;  // corners along each edge, in its direction
    for (int k = 0; k < patch.edges(); ++k)
        for (const EdgeRim& er : topology_.edges[member][k]) {
            const Rim& rim = topology_.rims[er.rim];
            const RimUse& use = rim.uses[er.use];
            if (rim.collapsed) mesh.poles.push_back(positions_[rim.a]);
            if (rim.collapsed && fans_ && patch.domain() == Domain::quad && topology_.edges[member][k].size() == 1) {
                const Vec2 p = patch.edge_point(k, 0);
                const bool along_u = k == 0 || k == 2;
                mesh.fans.push_back({k, along_u, along_u ? p.y : p.x, {}});
            }
            Chain along;
            double reached = use.t0;
            for (auto i = rim_pieces_[er.rim]; i < rim_pieces_[er.rim + 1]; ++i) {
                RimNode& node = rim_nodes_[i];
                if (along.empty()) along.push_back(corner(patch.edge_point(k, use.t0), node.a));
                const Vec2 p = node.f1 == 1 ? patch.edge_point(k, use.t1) : on_rim(use, node.f1, positions_[node.b], std::min(reached, use.t1), std::max(reached, use.t1));
                if (!use.affine) reached = edge_parameter(patch, k, p);
                along.push_back(corner(p, node.b));
                const auto e = node.edge[er.use] = build.edge(along[along.size() - 2], along.back());
                mesh.edges[e].rim_node = i, mesh.edges[e].use = er.use;
            }
            if (er.reversed) std::reverse(along.begin(), along.end());
            side[k].insert(side[k].end(), along.begin() + (side[k].empty() ? 0 : 1), along.end());
        }
    if (patch.domain() == Domain::triangle) {
        mesh.cells.push_back(std::make_unique<BoundCell>(patch, Box{{0, 1}, {0, 1}}));
        return fill_triangle(build, start.bends[0], start.parts, {side[1], side[2], side[0]});  // C to A to B to C
    }
    mesh.breaks_u = patch.breaks_u(), mesh.breaks_v = patch.breaks_v();
    const std::vector<double>&us = start.us, &vs = start.vs;
    const std::size_t columns = us.size() - 1, rows = vs.size() - 1;
    // Corners of a side from parameter `from` to `to`, both included.
    const auto piece = [&](int k, double from, double to) {
        Chain found;
        for (auto c : side[k]) {
            const double t = k == 0 || k == 2 ? mesh.uv[c].x : mesh.uv[c].y;
            if (t >= from && t <= to) found.push_back(c);
        }
        return found;
    };
    // Lines inside the patch take the vertices of the cell beside them that has more.
    const auto denser = [](const std::vector<double>& a, const std::vector<double>& b) -> const std::vector<double>& { return a.size() >= b.size() ? a : b; };
    std::vector<std::vector<Chain>> along_u(columns, std::vector<Chain>(rows + 1)), along_v(columns + 1, std::vector<Chain>(rows));
    for (std::size_t i = 0; i < columns; ++i)
        for (std::size_t j = 0; j <= rows; ++j) {
            Chain& chain = along_u[i][j];
            if (j == 0 || j == rows) chain = piece(j == 0 ? 0 : 2, us[i], us[i + 1]);
            else
                for (const double u : denser(start.grids[i * rows + j - 1].side(2), start.grids[i * rows + j].side(0))) chain.push_back(corner({u, vs[j]}, kNone));
        }
    for (std::size_t i = 0; i <= columns; ++i)
        for (std::size_t j = 0; j < rows; ++j) {
            Chain& chain = along_v[i][j];
            if (i == 0 || i == columns) chain = piece(i == 0 ? 3 : 1, vs[j], vs[j + 1]);
            else
                for (const double v : denser(start.grids[(i - 1) * rows + j].side(1), start.grids[i * rows + j].side(3))) chain.push_back(corner({us[i], v}, kNone));
        }
    for (std::size_t i = 0; i < columns; ++i)
        for (std::size_t j = 0; j < rows; ++j) {
            mesh.cells.push_back(std::make_unique<BoundCell>(patch, Box{{us[i], us[i + 1]}, {vs[j], vs[j + 1]}}));
            fill_cell(build, start.bends[i * rows + j], start.grids[i * rows + j], {along_u[i][j], along_v[i + 1][j], along_u[i][j + 1], along_v[i][j]});
        }
}

}  // namespace isoparm
