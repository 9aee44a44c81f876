#include "refine.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <unordered_set>

#include "bound.h"

namespace isoparm {
namespace {

/// Runs f(member, index) over all items of all patches, in parallel; `count(member)` items each.
template <class Count, class F> void for_all(std::size_t members, Count count, F f) {
    std::vector<std::size_t> start(members + 1, 0);
    for (std::size_t m = 0; m < members; ++m) start[m + 1] = start[m] + count(m);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, start.back(), 64), [&](const tbb::blocked_range<std::size_t>& range) {
        std::size_t m = std::upper_bound(start.begin(), start.end(), range.begin()) - start.begin() - 1;
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            while (i >= start[m + 1]) ++m;
            f(m, i - start[m]);
        }
    });
}

double edge_parameter(const Patch& patch, int edge, const Vec2& p) {
    if (patch.domain() == Domain::triangle) return edge == 0 ? 1 - p.y : edge == 1 ? p.x : p.y;
    const Rect r = patch.rect();
    return edge == 0 || edge == 2 ? (p.x - r.u0) / (r.u1 - r.u0) : (p.y - r.v0) / (r.v1 - r.v0);
}

/// A name for the mesh edge that an edge of a patch is, the same whichever patch and direction it is seen from.
std::uint64_t mesh_edge(const PatchMesh& mesh, const PatchEdge& e) {
    const auto [a, b] = std::minmax(mesh.vertex[e.a], mesh.vertex[e.b]);
    return (std::uint64_t(a) << 32) | b;
}

/// Does the triangle name a mesh vertex twice? Such triangles are segments and not part of the mesh.
bool left_out(const PatchMesh& mesh, const PatchTriangle& t) {
    const auto a = mesh.vertex[t.corner[0]], b = mesh.vertex[t.corner[1]], c = mesh.vertex[t.corner[2]];
    return a == b || b == c || c == a;
}

}  // namespace

Refinement::Refinement(const Composite& surface, const Topology& topology)
    : surface_(surface), topology_(topology), positions_(topology.nodes), patches_(surface.size()) {
    for (std::uint32_t r = 0; r < topology.rims.size(); ++r) {
        const Rim& rim = topology.rims[r];
        rim_nodes_.push_back({r, 0, 1, rim.a, rim.b, kNone, false});
    }
    // Vertices that breaks make inside a patch are numbered patch by patch, so this loop is serial.
    for (std::uint32_t m = 0; m < surface.size(); ++m) build_patch(m);
    tbb::parallel_for(std::size_t(0), surface.size(), [&](std::size_t m) { measure_slack(std::uint32_t(m), 0); });
    collect_slack(std::vector<std::size_t>(surface.size(), 0));
}

void Refinement::collect_slack(const std::vector<std::size_t>& first) {
    for (std::size_t m = 0; m < patches_.size(); ++m)
        for (std::size_t i = first[m]; i < patches_[m].slack.size(); ++i) worst_slack_ = std::max(worst_slack_, patches_[m].slack[i]);
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
            }
            mesh.vertex.push_back(vertex);
        }
        return it->second;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    const auto edge = [&](std::uint32_t a, std::uint32_t b) {
        const auto [it, fresh] = known.try_emplace(std::minmax(a, b), std::uint32_t(mesh.edges.size()));
        if (fresh) mesh.edges.push_back({a, b});
        return it->second;
    };
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        PatchTriangle t;
        t.corner = {a, b, c};
        t.edge = {edge(a, b), edge(b, c), edge(c, a)};
        mesh.triangles.push_back(t);
    };
    // Rims along the four (three) edges.
    std::array<std::vector<std::uint32_t>, 4> side;  // corners along each edge, in its direction
    for (int k = 0; k < patch.edges(); ++k)
        for (const EdgeRim& er : topology_.edges[member][k]) {
            const Rim& rim = topology_.rims[er.rim];
            const RimUse& use = rim.uses[er.use];
            const auto a = corner(patch.edge_point(k, use.t0), rim.a), b = corner(patch.edge_point(k, use.t1), rim.b);
            PatchEdge e{a, b, kNone, er.rim, er.use, false, false};
            known[std::minmax(a, b)] = std::uint32_t(mesh.edges.size());
            mesh.edges.push_back(e);
            if (side[k].empty()) side[k].push_back(er.reversed ? b : a);
            side[k].push_back(er.reversed ? a : b);
        }
    const auto fan = [&](const std::vector<std::uint32_t>& polygon, const Vec2& centre) {
        const auto c = corner(centre, kNone);
        for (std::size_t i = 0; i < polygon.size(); ++i) triangle(polygon[i], polygon[(i + 1) % polygon.size()], c);
    };
    if (patch.domain() == Domain::triangle) {
        std::vector<std::uint32_t> polygon;  // C -> A -> B -> C
        for (int k : {1, 2, 0}) polygon.insert(polygon.end(), side[k].begin(), side[k].end() - 1);
        if (polygon.size() == 3) triangle(polygon[0], polygon[1], polygon[2]);
        else fan(polygon, {1.0 / 3, 1.0 / 3});
        return;
    }
    const Rect r = patch.rect();
    std::vector<double> us{r.u0}, vs{r.v0};
    for (double b : patch.breaks_u()) us.push_back(b);
    for (double b : patch.breaks_v()) vs.push_back(b);
    us.push_back(r.u1), vs.push_back(r.v1);
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

void Refinement::measure_slack(std::uint32_t member, std::size_t first) {
    PatchMesh& mesh = patches_[member];
    mesh.slack.resize(mesh.uv.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first, mesh.uv.size(), 64), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const auto s = surface_[member].patch.enclose_point(mesh.uv[i].x, mesh.uv[i].y);
            const Point& x = positions_[mesh.vertex[i]];
            mesh.slack[i] = rounding::length_up(mag(Interval(x.x) - s.x), mag(Interval(x.y) - s.y), mag(Interval(x.z) - s.z));
        }
    });
}

bool Refinement::bound_and_mark(double tolerance) {
    std::vector<std::vector<std::uint32_t>> open(patches_.size());
    for (std::size_t m = 0; m < patches_.size(); ++m)
        for (std::uint32_t i = 0; i < patches_[m].triangles.size(); ++i)
            if (patches_[m].triangles[i].bound < 0) open[m].push_back(i);
    std::vector<std::vector<char>> worst(patches_.size());
    for (std::size_t m = 0; m < open.size(); ++m) worst[m].assign(open[m].size(), 0);
    for_all(patches_.size(), [&](std::size_t m) { return open[m].size(); }, [&](std::size_t m, std::size_t i) {
        PatchMesh& mesh = patches_[m];
        PatchTriangle& t = mesh.triangles[open[m][i]];
        std::array<Vec2, 3> uv;
        std::array<Point, 3> points;
        double slack = 0;
        for (int k = 0; k < 3; ++k) {
            uv[k] = mesh.uv[t.corner[k]];
            points[k] = positions_[mesh.vertex[t.corner[k]]];
            slack = std::max(slack, mesh.slack[t.corner[k]]);
        }
        const TriangleBound b = bound_triangle(surface_[m].patch, uv, points);
        t.bound = rounding::up(b.parametric + slack);
        worst[m][i] = char(b.worst_edge);
    });
    bool done = true;
    for (std::size_t m = 0; m < patches_.size(); ++m) {
        PatchMesh& mesh = patches_[m];
        const auto mark_to_split = [&](std::uint32_t e) {
            mark(mesh.edges[e]);
            done = false;
        };
        for (std::size_t i = 0; i < open[m].size(); ++i) {
            const PatchTriangle& t = mesh.triangles[open[m][i]];
            if (!(t.bound <= tolerance)) mark_to_split(t.edge[worst[m][i]]);
            for (auto e : t.edge)
                if (mesh.vertex[mesh.edges[e].a] == mesh.vertex[mesh.edges[e].b] && !collapsed(mesh.edges[e])) mark_to_split(e);
        }
    }
    return done;
}

void Refinement::split_rims() {
    const std::size_t n = rim_nodes_.size();
    for (std::size_t i = 0; i < n; ++i) {
        if (!rim_nodes_[i].marked || rim_nodes_[i].child != kNone) continue;
        const RimNode node = rim_nodes_[i];
        const Rim& rim = topology_.rims[node.rim];
        const double f = 0.5 * node.f0 + 0.5 * node.f1;
        std::uint32_t middle = node.a;
        if (!rim.collapsed) {
            const RimUse& owner = rim.uses[0];
            const Vec2 p = surface_[owner.member].patch.edge_point(owner.edge, owner.t0 + f * (owner.t1 - owner.t0));
            middle = std::uint32_t(positions_.size());
            positions_.push_back(surface_[owner.member].patch.point(p.x, p.y));
        }
        rim_nodes_[i].child = std::uint32_t(rim_nodes_.size());
        rim_nodes_.push_back({node.rim, node.f0, f, node.a, middle, kNone, false});
        rim_nodes_.push_back({node.rim, f, node.f1, middle, node.b, kNone, false});
    }
}

/// Bisects the marked edges of a patch. Vertices inside it stay kNone here: split_marked() numbers them.
void Refinement::split_edges(std::uint32_t member) {
    PatchMesh& mesh = patches_[member];
    const Patch& patch = surface_[member].patch;
    const std::uint32_t n = std::uint32_t(mesh.edges.size());
    for (std::uint32_t i = 0; i < n; ++i) {
        const PatchEdge e = mesh.edges[i];
        const RimNode* node = e.rim_node == kNone ? nullptr : &rim_nodes_[e.rim_node];
        if (e.child != kNone || !(node ? node->child != kNone : e.marked)) continue;
        const auto middle = std::uint32_t(mesh.uv.size());
        PatchEdge low{e.a, middle, kNone, kNone, e.use, e.reversed, false}, high{middle, e.b, kNone, kNone, e.use, e.reversed, false};
        if (node) {
            const RimUse& use = topology_.rims[node->rim].uses[e.use];
            const double ta = edge_parameter(patch, use.edge, mesh.uv[e.a]), tb = edge_parameter(patch, use.edge, mesh.uv[e.b]);
            const std::uint32_t vertex = rim_nodes_[node->child].b;
            mesh.uv.push_back(on_rim(use, 0.5 * node->f0 + 0.5 * node->f1, positions_[vertex], std::min(ta, tb), std::max(ta, tb)));
            mesh.vertex.push_back(vertex);
            low.rim_node = e.reversed ? node->child + 1 : node->child;
            high.rim_node = e.reversed ? node->child : node->child + 1;
        } else {
            const Vec2 &a = mesh.uv[e.a], &b = mesh.uv[e.b];
            mesh.uv.push_back({0.5 * a.x + 0.5 * b.x, 0.5 * a.y + 0.5 * b.y});
            mesh.vertex.push_back(kNone);
        }
        mesh.edges[i].child = std::uint32_t(mesh.edges.size());
        mesh.edges.push_back(low);
        mesh.edges.push_back(high);
    }
}

void Refinement::split_triangles(std::uint32_t member) {
    PatchMesh& mesh = patches_[member];
    const std::size_t n = mesh.triangles.size();
    // The half of edge e that starts at corner c.
    const auto half = [&](std::uint32_t e, std::uint32_t c) { return mesh.edges[e].a == c ? mesh.edges[e].child : mesh.edges[e].child + 1; };
    const auto middle = [&](std::uint32_t e) { return mesh.edges[mesh.edges[e].child].b; };
    const auto add_edge = [&](std::uint32_t a, std::uint32_t b) {
        mesh.edges.push_back({a, b});
        return std::uint32_t(mesh.edges.size() - 1);
    };
    const auto at = [&](std::uint32_t c) { return positions_[mesh.vertex[c]]; };
    for (std::size_t i = 0; i < n; ++i) {
        PatchTriangle t = mesh.triangles[i];
        int cut = 0;
        for (auto e : t.edge) cut += mesh.edges[e].child != kNone;
        if (cut == 0) continue;
        auto put = [&, first = true](std::array<std::uint32_t, 3> c, std::array<std::uint32_t, 3> e) mutable {
            PatchTriangle fresh;
            fresh.corner = c, fresh.edge = e;
            if (first) mesh.triangles[i] = fresh;
            else mesh.triangles.push_back(fresh);
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
    tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t m) {
        first_corner[m] = patches_[m].uv.size();
        split_edges(std::uint32_t(m));
    });
    // New vertices inside the patches are numbered in the order of patches and edges, whatever thread made them.
    std::vector<std::size_t> first_vertex(patches_.size() + 1, positions_.size());
    for (std::size_t m = 0; m < patches_.size(); ++m) {
        std::size_t count = 0;
        for (std::size_t i = first_corner[m]; i < patches_[m].uv.size(); ++i) count += patches_[m].vertex[i] == kNone;
        first_vertex[m + 1] = first_vertex[m] + count;
    }
    positions_.resize(first_vertex.back());
    tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t m) {
        PatchMesh& mesh = patches_[m];
        std::vector<double> u, v;
        std::size_t next = first_vertex[m];
        for (std::size_t i = first_corner[m]; i < mesh.uv.size(); ++i) {
            if (mesh.vertex[i] != kNone) continue;
            mesh.vertex[i] = std::uint32_t(next++);
            u.push_back(mesh.uv[i].x);
            v.push_back(mesh.uv[i].y);
        }
        surface_[m].patch.points(u.size(), u.data(), v.data(), positions_.data() + first_vertex[m]);
        measure_slack(std::uint32_t(m), first_corner[m]);
        split_triangles(std::uint32_t(m));
    });
    collect_slack(first_corner);
}

void Refinement::mark(PatchEdge& edge) {
    edge.marked = true;
    if (edge.rim_node != kNone) rim_nodes_[edge.rim_node].marked = true;
}

bool Refinement::mark_coincident_edges() {
    std::unordered_map<std::uint64_t, int> count;
    const auto each = [&](auto f) {
        for (auto& mesh : patches_)
            for (const auto& t : mesh.triangles) {
                if (left_out(mesh, t)) continue;
                for (const auto e : t.edge) f(mesh.edges[e], mesh_edge(mesh, mesh.edges[e]));
            }
    };
    each([&](const PatchEdge&, std::uint64_t key) { ++count[key]; });
    bool any = false;
    each([&](PatchEdge& edge, std::uint64_t key) {
        if (count[key] <= 2) return;
        mark(edge);
        any = true;
    });
    return any;
}

bool Refinement::mark_lost_edges() {
    const auto any_left_out = [](const PatchMesh& mesh) {
        return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const PatchTriangle& t) { return left_out(mesh, t); });
    };
    if (std::none_of(patches_.begin(), patches_.end(), any_left_out)) return false;
    std::unordered_set<std::uint64_t> kept;
    std::vector<char> named(positions_.size(), 0);
    for (const auto& mesh : patches_)
        for (const auto& t : mesh.triangles) {
            if (left_out(mesh, t)) continue;
            for (const auto e : t.edge) kept.insert(mesh_edge(mesh, mesh.edges[e]));
            for (const auto c : t.corner) named[mesh.vertex[c]] = 1;
        }
    bool any = false;
    for (auto& mesh : patches_)
        for (const auto& t : mesh.triangles) {
            if (!left_out(mesh, t)) continue;
            for (const auto e : t.edge) {
                PatchEdge& edge = mesh.edges[e];
                const bool point = mesh.vertex[edge.a] == mesh.vertex[edge.b];
                if (point ? named[mesh.vertex[edge.a]] : kept.count(mesh_edge(mesh, edge)) > 0) continue;
                if (!point) mark(edge);
                any = true;
            }
        }
    return any;
}

std::size_t Refinement::triangle_count() const {
    std::size_t n = 0;
    for (const auto& p : patches_) n += p.triangles.size();
    return n;
}

double Refinement::predicted_triangles(double tolerance) const {
    double sum = 0;
    for (const auto& p : patches_)
        for (const auto& t : p.triangles) sum += std::isfinite(t.bound) ? std::max(1.0, t.bound / tolerance) : 1;
    return sum;
}

std::size_t Refinement::unbounded_count() const {
    std::size_t n = 0;
    for (const auto& p : patches_)
        for (const auto& t : p.triangles) n += !std::isfinite(t.bound);
    return n;
}

double Refinement::worst_bound() const {
    double worst = 0;
    for (const auto& p : patches_)
        for (const auto& t : p.triangles) worst = std::max(worst, t.bound);
    return worst;
}

std::vector<std::array<std::uint32_t, 2>> Refinement::open_edges() const {
    std::vector<std::array<std::uint32_t, 2>> list;
    for (const auto& n : rim_nodes_) {
        const Rim& rim = topology_.rims[n.rim];
        if (n.child == kNone && !rim.collapsed && rim.uses.size() == 1) list.push_back({std::min(n.a, n.b), std::max(n.a, n.b)});
    }
    return list;
}

}  // namespace isoparm
