#include "meshes/leaf_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "meshes/leaf_rims.h"
#include "tessellation/refine.h"

namespace isoparm {
namespace {

constexpr std::uint32_t kInside = UINT32_MAX;

using Chain = std::vector<std::uint32_t>;

/// One patch of the mesh in the making.
class PatchBuilder {
public:
    PatchBuilder(const Composite& surface, const Topology& topology, const Leaves& leaves, std::uint32_t member)
        : patch_(surface[member].patch), leaves_(leaves) {
        part_.name = surface[member].name;
        part_.member = member;
        part_.flipped = topology.flipped[member];
    }

    /// Corners along the edges, then those inside.
    void add_corners(const Topology& topology, const std::vector<std::vector<RimVertex>>& rims) {
        known_.reserve(2 * leaves_.list.size());
        std::array<std::vector<std::uint64_t>, 4> keys;
        for (int k = 0; k < patch_.edges(); ++k) keys[k] = keys_on(k);
        for (int k = 0; k < patch_.edges(); ++k) {
            std::size_t next = 0;
            for (const EdgeRim& er : topology.edges[part_.member][k]) {
                const auto& vertices = rims[er.rim];
                for (std::size_t i = 0; i < vertices.size(); ++i) {
                    const RimVertex& v = vertices[er.reversed ? vertices.size() - 1 - i : i];
                    if (i == 0 && !side_[k].empty()) continue;
                    const Vec2 p = patch_.edge_point(k, v.t[er.use]);
                    const auto c = v.lattice[er.use] ? lattice_corner(keys[k].at(next++), p, v.vertex) : corner(p, v.vertex);
                    place_[k][c] = std::uint32_t(side_[k].size());
                    side_[k].push_back(c);
                }
            }
            if (next != keys[k].size()) throw std::logic_error("a lattice point on an edge is no vertex of it: please report this scene");
        }
        first_inside_ = std::uint32_t(part_.uv.size());
        for (const Leaf& leaf : leaves_.list)
            for (int c = 0; c < leaf.sides; ++c) lattice_corner(leaf.corner[c].key(), leaves_.at(leaf.corner[c]), kInside);
    }

    /// Numbers corners inside the patch from `next` on and returns where the next patch begins.
    std::uint32_t number(std::uint32_t from, std::uint32_t next) {
        for (auto c = from; c < part_.uv.size(); ++c) part_.vertex[c] = next++;
        return next;
    }
    std::uint32_t first_inside() const { return first_inside_; }
    std::uint32_t corners() const { return std::uint32_t(part_.uv.size()); }
    void evaluate(std::uint32_t from, std::vector<Point>& positions) const {
        std::vector<double> u, v;
        for (auto c = from; c < part_.uv.size(); ++c) u.push_back(part_.uv[c].x), v.push_back(part_.uv[c].y);
        if (!u.empty()) patch_.points(u.size(), u.data(), v.data(), positions.data() + part_.vertex[from]);
    }

    void add_triangles(const std::vector<Point>& positions) {
        std::vector<double> u, v;
        for (const Leaf& leaf : leaves_.list) {
            const Vec2 m = centre(leaf);
            u.push_back(m.x), v.push_back(m.y);
        }
        std::vector<Point> middles(u.size());
        patch_.points(u.size(), u.data(), v.data(), middles.data());
        for (std::uint32_t i = 0; i < leaves_.list.size(); ++i) add_leaf(i, middles[i], positions);
        leaf_of_.insert(leaf_of_.end(), leaf_of_left_out_.begin(), leaf_of_left_out_.end());
    }

    MeshPart take_part() { return std::move(part_); }
    std::vector<std::uint32_t> take_leaves() { return std::move(leaf_of_); }

private:
    std::vector<std::uint64_t> keys_on(int k) const {
        std::vector<std::pair<double, std::uint64_t>> found;
        for (const Leaf& leaf : leaves_.list)
            for (int c = 0; c < leaf.sides; ++c)
                if (leaves_.on_edge(patch_, k, leaf.corner[c]))
                    found.push_back({edge_parameter(patch_, k, leaves_.at(leaf.corner[c])), leaf.corner[c].key()});
        std::sort(found.begin(), found.end());
        std::vector<std::uint64_t> keys;
        for (const auto& [t, key] : found)
            if (keys.empty() || keys.back() != key) keys.push_back(key);
        return keys;
    }
    std::uint32_t corner(const Vec2& p, std::uint32_t vertex) {
        part_.uv.push_back(p);
        part_.vertex.push_back(vertex);
        return std::uint32_t(part_.uv.size() - 1);
    }
    std::uint32_t lattice_corner(std::uint64_t key, const Vec2& p, std::uint32_t vertex) {
        const auto [it, fresh] = known_.try_emplace(key, 0);
        if (fresh) it->second = corner(p, vertex);
        return it->second;
    }
    Vec2 centre(const Leaf& leaf) const {
        Vec2 sum;
        for (int c = 0; c < leaf.sides; ++c) {
            const Vec2 p = leaves_.at(leaf.corner[c]);
            sum.x += p.x / leaf.sides, sum.y += p.y / leaf.sides;
        }
        return sum;
    }
    /// Corners on the way from a to b, a included, b not.
    void walk(const LatticePoint& a, const LatticePoint& b, Chain& chain) const {
        const auto ca = known_.at(a.key()), cb = known_.at(b.key());
        for (int k = 0; k < patch_.edges(); ++k) {
            if (!leaves_.on_edge(patch_, k, a) || !leaves_.on_edge(patch_, k, b)) continue;
            const int from = int(place_[k].at(ca)), to = int(place_[k].at(cb)), step = from < to ? 1 : -1;
            for (int i = from; i != to; i += step) chain.push_back(side_[k][std::size_t(i)]);
            return;
        }
        const bool halves = (a.i + b.i) % 2 == 0 && (a.j + b.j) % 2 == 0;
        const LatticePoint m = middle(a, b);
        if (halves && known_.count(m.key()))
            walk(a, m, chain), walk(m, b, chain);
        else
            chain.push_back(ca);
    }
    void triangle(std::uint32_t leaf, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto va = part_.vertex[a], vb = part_.vertex[b], vc = part_.vertex[c];
        if (va == vb || vb == vc || vc == va) {
            part_.left_out.push_back({a, b, c});
            leaf_of_left_out_.push_back(leaf);
            return;
        }
        if (part_.flipped)
            part_.triangles.push_back({a, c, b});
        else
            part_.triangles.push_back({a, b, c});
        leaf_of_.push_back(leaf);
    }
    void add_leaf(std::uint32_t index, const Point& on_surface, const std::vector<Point>& positions) {
        const Leaf& leaf = leaves_.list[index];
        Chain all;
        std::size_t apex = 0, most = 0;  // a vertex inside a side; the largest number of them on one
        for (int c = 0; c < leaf.sides; ++c) {
            const std::size_t before = all.size();
            walk(leaf.corner[c], leaf.corner[(c + 1) % leaf.sides], all);
            const std::size_t inside = all.size() - before - 1;
            if (inside > 0) apex = before + 1;
            most = std::max(most, inside);
        }
        const std::size_t n = all.size(), extra = n - std::size_t(leaf.sides);
        if (most > 1 || extra > 2) {  // from the middle; its position is the surface's
            const auto m = corner(centre(leaf), kInside);
            for (std::size_t i = 0; i < n; ++i) triangle(index, m, all[i], all[(i + 1) % n]);
            return;
        }
        if (extra == 0 && n == 4) {
            const auto off = [&](int i, int k) {
                return distance(on_surface,
                                0.5 * (positions[part_.vertex[all[std::size_t(i)]]] + positions[part_.vertex[all[std::size_t(k)]]]));
            };
            apex = off(1, 3) < off(0, 2) ? 1 : 0;
        }
        for (std::size_t i = 1; i + 1 < n; ++i) triangle(index, all[apex], all[(apex + i) % n], all[(apex + i + 1) % n]);
    }

    const Patch& patch_;
    const Leaves& leaves_;
    MeshPart part_;
    std::array<Chain, 4> side_;                                              // corners along each edge, in its direction
    std::array<std::unordered_map<std::uint32_t, std::uint32_t>, 4> place_;  // of a corner on an edge
    std::unordered_map<std::uint64_t, std::uint32_t, LatticeHash> known_;    // corners by lattice point
    std::uint32_t first_inside_ = 0;
    std::vector<std::uint32_t> leaf_of_, leaf_of_left_out_;
};

}  // namespace

Leaves::Leaves(const Patch& patch, std::uint32_t n) : us(patch.lines_u()), vs(patch.lines_v()), steps(n) {
    if (patch.domain() == Domain::triangle) {
        us = vs = {0, 1};
        list.push_back({{LatticePoint{0, 0}, {n, 0}, {0, n}, {0, 0}}, 3});
        return;
    }
    for (std::uint32_t i = 0; i + 1 < us.size(); ++i)
        for (std::uint32_t j = 0; j + 1 < vs.size(); ++j)
            list.push_back({{LatticePoint{i * n, j * n}, {(i + 1) * n, j * n}, {(i + 1) * n, (j + 1) * n}, {i * n, (j + 1) * n}}, 4});
}

Vec2 Leaves::at(const LatticePoint& p) const {
    const auto along = [this](const std::vector<double>& lines, std::uint32_t i) {
        const std::uint32_t cell = i / steps, rest = i % steps;
        return rest == 0 ? lines[cell] : lines[cell] + (lines[cell + 1] - lines[cell]) * (double(rest) / steps);
    };
    return {along(us, p.i), along(vs, p.j)};
}

bool Leaves::on_edge(const Patch& patch, int k, const LatticePoint& p) const {
    if (patch.domain() == Domain::triangle) return k == 0 ? p.i == 0 : k == 1 ? p.j == 0 : p.i + p.j == steps;
    return k == 0 ? p.j == 0 : k == 1 ? p.i == steps * (us.size() - 1) : k == 2 ? p.j == steps * (vs.size() - 1) : p.i == 0;
}

LeafMesh mesh_of(const Composite& surface, const Topology& topology, const std::vector<Leaves>& leaves) {
    LeafMesh result;
    std::vector<Point>& positions = result.mesh.positions;
    positions = topology.nodes;
    const Rims cuts(surface, topology, leaves);
    std::vector<std::vector<RimVertex>> rims(topology.rims.size());
    for (std::uint32_t r = 0; r < rims.size(); ++r) {
        const Rim& rim = topology.rims[r];
        rims[r] = cuts.cut(r);
        for (RimVertex& v : rims[r]) {
            v.vertex = rim.collapsed || v.f == 0 ? rim.a : v.f == 1 ? rim.b : std::uint32_t(positions.size());
            if (v.vertex == positions.size())
                positions.push_back(on_edge(surface, rim.uses[0], rim.uses[0].t0 + v.f * (rim.uses[0].t1 - rim.uses[0].t0)));
        }
        for (std::size_t i = 0; !rim.collapsed && rim.uses.size() == 1 && i + 1 < rims[r].size(); ++i)
            result.open_edges.push_back({rims[r][i].vertex, rims[r][i + 1].vertex});
    }
    std::vector<PatchBuilder> builders;
    for (std::uint32_t m = 0; m < surface.size(); ++m) builders.emplace_back(surface, topology, leaves[m], m);
    const auto each = [&](auto f) { tbb::parallel_for(std::size_t(0), builders.size(), [&](std::size_t m) { f(builders[m], m); }); };
    each([&](PatchBuilder& b, std::size_t) { b.add_corners(topology, rims); });
    const auto place = [&](const std::vector<std::uint32_t>& from) {
        auto next = std::uint32_t(positions.size());
        for (std::size_t m = 0; m < builders.size(); ++m) next = builders[m].number(from[m], next);
        positions.resize(next);
        each([&](PatchBuilder& b, std::size_t m) { b.evaluate(from[m], positions); });
    };
    std::vector<std::uint32_t> from;
    for (const PatchBuilder& b : builders) from.push_back(b.first_inside());
    place(from);
    for (std::size_t m = 0; m < builders.size(); ++m) from[m] = builders[m].corners();
    each([&](PatchBuilder& b, std::size_t) { b.add_triangles(positions); });
    place(from);  // middles of leaves
    for (PatchBuilder& b : builders) {
        result.leaf.push_back(b.take_leaves());
        result.mesh.parts.push_back(b.take_part());
    }
    return result;
}

}  // namespace isoparm
