// refine_start.cpp -- the triangulation that a Refinement begins with: in every cell between breaks rows of vertices, about as dense
// as the tolerance needs, and strips of triangles between them and to sides that other patches cut differently.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>

#include "dice.h"
#include "refine.h"

namespace isoparm {

/// Rows in the cells of a patch, u-major; of the triangular domain one, with parts of the sides.
struct Refinement::Start {
    std::vector<double> us, vs;
    std::vector<Bends> bends;
    std::vector<DiceGrid> grids;
    int parts = 1;
    double triangles = 0;

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
                } else {
                    grids.push_back(most > 0 ? dice(bends.back(), box, tolerance, measure, most) : DiceGrid::single(box));
                    triangles += grids.back().triangles();
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
    if (!(make(most) <= most)) make(0);
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
            if (!use.affine || rim.collapsed) continue;
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
            node.f1 = f, node.b = std::uint32_t(positions_.size());
            positions_.push_back(surface_[owner.member].patch.point(p.x, p.y));
            shared_.push_back(1);
            rim_nodes_.push_back(node);
            node.f0 = f, node.a = node.b;
        }
        node.f1 = 1, node.b = rim.b;
        rim_nodes_.push_back(node);
    }
    rim_pieces_.push_back(std::uint32_t(rim_nodes_.size()));
}

namespace {

using Chain = std::vector<std::uint32_t>;  // corners along a line

/// Makes the corners, edges and triangles of one patch.
class Builder {
public:
    /// About as many triangles are to come.
    Builder(PatchMesh& mesh, double triangles) : mesh_(mesh) {
        const auto most = std::size_t(1.2 * triangles + 64);  // with those that bisection adds
        mesh_.uv.reserve(most / 2), mesh_.vertex.reserve(most / 2), mesh_.slack.reserve(most / 2), first_.reserve(most / 2);
        mesh_.triangles.reserve(most), mesh_.settled.reserve(most), mesh_.fresh.reserve(most), mesh_.edges.reserve(most / 2 * 3), next_.reserve(most / 2 * 3);
    }

    std::uint32_t corner(const Vec2& p, std::uint32_t vertex = kNone) {
        mesh_.uv.push_back(p);
        mesh_.vertex.push_back(vertex);
        first_.push_back(kNone);
        return std::uint32_t(mesh_.uv.size() - 1);
    }
    /// The edge between two corners.
    std::uint32_t edge(std::uint32_t a, std::uint32_t b) {
        const auto [low, high] = std::minmax(a, b);
        for (auto e = first_[low]; e != kNone; e = next_[e])
            if (std::max(mesh_.edges[e].a, mesh_.edges[e].b) == high) return e;
        mesh_.edges.emplace_back();
        mesh_.edges.back().a = a, mesh_.edges.back().b = b;
        next_.push_back(first_[low]);
        return first_[low] = std::uint32_t(mesh_.edges.size() - 1);
    }
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (mirrored_) std::swap(b, c);
        PatchTriangle t;
        t.corner = {a, b, c};
        t.edge = {edge(a, b), edge(b, c), edge(c, a)};
        t.cell = mesh_.cells.back().get();
        const auto index = std::uint32_t(mesh_.triangles.size());
        for (const auto e : t.edge) mesh_.edges[e].side[mesh_.edges[e].side[0] != kNone] = index;
        mesh_.fresh.push_back(index);
        mesh_.triangles.push_back(t);
        mesh_.settled.push_back(kUnsettled);
    }
    /// Turns all triangles over: for chains in exchanged parameters.
    void mirror(bool mirrored) { mirrored_ = mirrored; }
    /// The strip between two chains that run the same way, the inner one to the left.
    void strip(const Chain& outer, const Chain& inner, const Bends& bends) {
        const auto& uv = mesh_.uv;
        const Vec2 from = uv[outer.front()], way{uv[outer.back()].x - from.x, uv[outer.back()].y - from.y};
        const auto reached = [&](const Chain& c, std::size_t i) {
            const Vec2 p{0.5 * uv[c[i]].x + 0.5 * uv[c[i + 1]].x, 0.5 * uv[c[i]].y + 0.5 * uv[c[i + 1]].y};
            return ((p.x - from.x) * way.x + (p.y - from.y) * way.y) / (way.x * way.x + way.y * way.y);
        };
        std::size_t i = 0, j = 0;
        while (i + 1 < outer.size() || j + 1 < inner.size()) {
            bool on_outer = j + 1 == inner.size();
            if (!on_outer && i + 1 < outer.size()) {
                // By the middles of the next pieces; where those are about level, along the diagonal that bends less.
                const double lead = reached(outer, i) - reached(inner, j), level = 0.3 / double(std::max(outer.size(), inner.size()));
                on_outer = std::abs(lead) < level ? !bends.less(uv[outer[i]], uv[inner[j + 1]], uv[outer[i + 1]], uv[inner[j]]) : lead < 0;
            }
            if (on_outer) triangle(outer[i], outer[i + 1], inner[j]), ++i;
            else triangle(outer[i], inner[j + 1], inner[j]), ++j;
        }
    }

private:
    PatchMesh& mesh_;
    bool mirrored_ = false;
    Chain first_, next_;  // edges by their smaller corner
};

Chain backwards(const Chain& c) { return Chain(c.rbegin(), c.rend()); }

/// A cell whose sides, in the direction of growing parameters, are given.
void fill_cell(Builder& build, const Bends& bends, DiceGrid grid, const std::array<Chain, 4>& side) {
    // Rows run from side `first` to side `last`, the lowest is `low`, the uppermost `high`.
    const Chain &low = side[grid.columns ? 3 : 0], &high = side[grid.columns ? 1 : 2], &first = side[grid.columns ? 0 : 3], &last = side[grid.columns ? 2 : 1];
    build.mirror(grid.columns);
    if (grid.lines.size() == 2 && (first.size() > 2 || last.size() > 2)) {  // strips along the sides need something inside
        grid.lines.insert(grid.lines.begin() + 1, 0.5 * grid.lines[0] + 0.5 * grid.lines[1]);
        grid.rows.insert(grid.rows.begin() + 1, grid.rows[0].size() > grid.rows[1].size() ? grid.rows[0] : grid.rows[1]);
    }
    const bool fits_first = first.size() == grid.lines.size(), fits_last = last.size() == grid.lines.size(), fits = fits_first && fits_last;
    const std::size_t n = grid.lines.size() - 1;
    std::vector<Chain> rows{low};
    Chain starts, ends;  // of the rows inside
    for (std::size_t j = 1; j < n; ++j) {
        std::vector<double>& at = grid.rows[j];
        if (!fits && at.size() == 2) at.insert(at.begin() + 1, 0.5 * at[0] + 0.5 * at[1]);
        Chain row;
        if (fits_first) row.push_back(first[j]);
        for (std::size_t i = 1; i + 1 < at.size(); ++i) row.push_back(build.corner(grid.columns ? Vec2{grid.lines[j], at[i]} : Vec2{at[i], grid.lines[j]}));
        if (fits_last) row.push_back(last[j]);
        starts.push_back(row.front()), ends.push_back(row.back());
        rows.push_back(std::move(row));
    }
    rows.push_back(high);
    for (std::size_t j = 0; j < n; ++j) build.strip(rows[j], rows[j + 1], bends);
    if (!fits_first) build.strip(backwards(first), backwards(starts), bends);
    if (!fits_last) build.strip(last, ends, bends);
    build.mirror(false);
}

/// The triangular domain whose sides, counter-clockwise from u = v = 0, are given.
void fill_triangle(Builder& build, const Bends& bends, int n, const std::array<Chain, 3>& sides) {
    const bool fits = std::all_of(sides.begin(), sides.end(), [&](const Chain& c) { return c.size() == std::size_t(n) + 1; });
    if (!fits) n = std::max(n, 3);
    std::vector<Chain> at(std::size_t(n) + 1, Chain(std::size_t(n) + 1, kNone));
    for (int i = 1; i < n; ++i)
        for (int j = 1; i + j < n; ++j) at[i][j] = build.corner({double(i) / n, double(j) / n});
    if (fits)
        for (int i = 0; i <= n; ++i) at[i][0] = sides[0][i], at[n - i][i] = sides[1][i], at[0][n - i] = sides[2][i];
    const int margin = fits ? 0 : 1;
    for (int i = margin; i < n - margin; ++i)
        for (int j = margin; i + j < n - margin; ++j) {
            build.triangle(at[i][j], at[i + 1][j], at[i][j + 1]);
            if (i + j + 1 < n - margin) build.triangle(at[i + 1][j], at[i + 1][j + 1], at[i][j + 1]);
        }
    if (fits) return;
    std::array<Chain, 3> inner;
    for (int i = 1; i <= n - 2; ++i) inner[0].push_back(at[i][1]), inner[1].push_back(at[n - 1 - i][i]), inner[2].push_back(at[1][n - 1 - i]);
    for (int k = 0; k < 3; ++k) build.strip(sides[k], inner[k], bends);
}

}  // namespace

void Refinement::build_patch(std::uint32_t member, const Start& start) {
    const Patch& patch = surface_[member].patch;
    PatchMesh& mesh = patches_[member];
    Builder build(mesh, start.triangles);
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
            const RimUse& use = topology_.rims[er.rim].uses[er.use];
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
