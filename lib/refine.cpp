#include "refine.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>


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

/// A name for the mesh edge that an edge of a patch is, the same whichever patch and direction it is seen from.
std::uint64_t mesh_edge(const PatchMesh& mesh, const PatchEdge& e) {
    const auto [a, b] = std::minmax(mesh.vertex[e.a], mesh.vertex[e.b]);
    return (std::uint64_t(a) << 32) | b;
}

}  // namespace

double edge_parameter(const Patch& patch, int edge, const Vec2& p) {
    if (patch.domain() == Domain::triangle) return edge == 0 ? 1 - p.y : edge == 1 ? p.x : p.y;
    const Rect r = patch.rect();
    return edge == 0 || edge == 2 ? (p.x - r.u0) / (r.u1 - r.u0) : (p.y - r.v0) / (r.v1 - r.v0);
}

double PatchMesh::slack_of(const PatchTriangle& t) const { return std::max({slack[t.corner[0]], slack[t.corner[1]], slack[t.corner[2]]}); }

Refinement::Refinement(const Composite& surface, const Topology& topology, double tolerance, Measure measure, double most)
    : surface_(surface), topology_(topology), tolerance_(tolerance), measure_(measure), positions_(topology.nodes), shared_(topology.nodes.size(), 1),
      patches_(surface.size()) {
    start(most);
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

void Refinement::bound(PatchMesh& mesh, std::uint32_t member, PatchTriangle& t) const {
    CornerData data;
    for (int k = 0; k < 3; ++k) data.uv[k] = mesh.uv[t.corner[k]], data.points[k] = positions_[mesh.vertex[t.corner[k]]];
    data.slack = mesh.slack_of(t);
    t.proof = BoundCell::bound(surface_[member].patch, t.cell, data, tolerance_ - data.slack, measure_);
}

bool Refinement::bound_and_mark() {
    for_all(patches_.size(), [&](std::size_t m) { return patches_[m].fresh.size(); }, [&](std::size_t m, std::size_t i) {
        bound(patches_[m], std::uint32_t(m), patches_[m].triangles[patches_[m].fresh[i]]);
    });
    bool done = true;
    predicted_ = double(triangle_count());
    worst_bound_ = 0, unbounded_ = 0;
    for (auto& mesh : patches_) {
        const auto mark_to_split = [&](std::uint32_t e) {
            mark(mesh, e);
            done = false;
        };
        for (const auto i : mesh.fresh) {
            const PatchTriangle& t = mesh.triangles[i];
            const double bound = rounding::up(t.proof.own(measure_) + mesh.slack_of(t));
            if (!(bound <= tolerance_)) {
                mark_to_split(t.edge[t.proof.worst_edge]);
                unbounded_ += !std::isfinite(bound);
                predicted_ += std::isfinite(bound) ? bound / tolerance_ - 1 : 0;
                worst_bound_ = std::max(worst_bound_, bound);
            }
            for (auto e : t.edge)
                if (mesh.vertex[mesh.edges[e].a] == mesh.vertex[mesh.edges[e].b] && !collapsed(mesh.edges[e])) mark_to_split(e);
        }
        mesh.fresh.clear();
    }
    return done;
}

double Refinement::bound_of(const PatchMesh& mesh, std::uint32_t triangle) const {
    const PatchTriangle& t = mesh.triangles[triangle];
    double slack = mesh.slack_of(t);
    if (measure_ == Measure::parametric || !t.proof.quiet) return rounding::up(t.proof.parametric + slack);
    std::array<const TriangleBound*, 3> neighbours{};
    for (int k = 0; k < 3; ++k) {
        const auto& side = mesh.edges[t.edge[k]].side;
        const auto other = side[0] == triangle ? side[1] : side[0];
        if (other == kNone || mesh.left_out(mesh.triangles[other])) continue;
        neighbours[k] = &mesh.triangles[other].proof;
        slack = std::max(slack, mesh.slack_of(mesh.triangles[other]));
    }
    return rounding::up(geometric_bound(t.proof, neighbours) + slack);
}

double Refinement::worst_bound_of(std::size_t member) const {
    const PatchMesh& mesh = patches_[member];
    return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, mesh.triangles.size(), 1024), 0.0, [&](const auto& range, double worst) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) worst = std::max(worst, bound_of(mesh, std::uint32_t(i)));
        return worst;
    }, [](double a, double b) { return std::max(a, b); });
}

bool Refinement::mark_with_neighbours() {
    if (measure_ == Measure::parametric) return false;
    std::vector<std::vector<char>> fails(patches_.size());
    for (std::size_t m = 0; m < patches_.size(); ++m) fails[m].assign(patches_[m].triangles.size(), 0);
    for_all(patches_.size(), [&](std::size_t m) { return fails[m].size(); }, [&](std::size_t m, std::size_t i) {
        PatchTriangle& t = patches_[m].triangles[i];
        t.settled = t.settled || bound_of(patches_[m], std::uint32_t(i)) <= tolerance_;
        fails[m][i] = !t.settled;
    });
    bool any = false;
    for (std::size_t m = 0; m < patches_.size(); ++m)
        for (std::size_t i = 0; i < fails[m].size(); ++i)
            if (fails[m][i]) {
                PatchMesh& mesh = patches_[m];
                const PatchTriangle* worst = &mesh.triangles[i];
                // Mostly it is a neighbour that is near the tolerance by itself: the one with the largest bound is split.
                if (worst->proof.quiet)
                    for (const auto e : mesh.triangles[i].edge)
                        for (const auto other : mesh.edges[e].side)
                            if (other != kNone && mesh.triangles[other].proof.quiet && mesh.triangles[other].proof.normal > worst->proof.normal) worst = &mesh.triangles[other];
                mark(mesh, worst->edge[worst->proof.quiet ? worst->proof.worst_edge : worst->proof.worst_across]);
                any = true;
            }
    return any;
}

void Refinement::mark(PatchMesh& mesh, std::uint32_t edge) {
    PatchEdge& e = mesh.edges[edge];
    if (e.rim_node == kNone) {
        if (!e.marked) mesh.marked.push_back(edge);
        e.marked = true;
    } else if (!rim_nodes_[e.rim_node].marked) {
        rim_nodes_[e.rim_node].marked = true;
        marked_rims_.push_back(e.rim_node);
    }
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
                    if (beside < mesh.triangles.size()) mesh.triangles[beside].settled = false;
            }
            if (first) mesh.triangles[i] = part;
            else mesh.triangles.push_back(part);
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
    collect_slack(first_corner);
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

bool Refinement::mark_coincident_edges() {
    // In the plane of parameters two corners are joined by one edge at most. So are two mesh vertices, unless one of them
    // is several corners, which only vertices on rims can be.
    std::unordered_map<std::uint64_t, int> count;
    const auto each = [&](auto f) {
        for (auto& mesh : patches_)
            for (std::uint32_t i = 0; i < mesh.edges.size(); ++i) {
                const PatchEdge& e = mesh.edges[i];
                if (e.child != kNone || !(shared_[mesh.vertex[e.a]] || shared_[mesh.vertex[e.b]])) continue;
                int beside = 0;
                for (const auto t : e.side) beside += t != kNone && !mesh.left_out(mesh.triangles[t]);
                if (beside > 0) f(mesh, i, mesh_edge(mesh, e), beside);
            }
    };
    each([&](PatchMesh&, std::uint32_t, std::uint64_t key, int beside) { count[key] += beside; });
    bool any = false;
    each([&](PatchMesh& mesh, std::uint32_t edge, std::uint64_t key, int) {
        if (count[key] <= 2) return;
        mark(mesh, edge);
        any = true;
    });
    return any;
}

bool Refinement::mark_lost_edges() {
    const auto any_left_out = [](const PatchMesh& mesh) {
        return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const PatchTriangle& t) { return mesh.left_out(t); });
    };
    if (std::none_of(patches_.begin(), patches_.end(), any_left_out)) return false;
    // A segment that is left out joins two vertices that it shares with other triangles, or is the whole of a patch.
    std::unordered_set<std::uint64_t> kept;
    std::vector<char> named(positions_.size(), 0);
    for (const auto& mesh : patches_)
        for (const auto& t : mesh.triangles) {
            if (mesh.left_out(t)) continue;
            for (const auto e : t.edge)
                if (shared_[mesh.vertex[mesh.edges[e].a]] || shared_[mesh.vertex[mesh.edges[e].b]]) kept.insert(mesh_edge(mesh, mesh.edges[e]));
            for (const auto v : mesh.vertices(t)) named[v] = 1;
        }
    bool any = false;
    for (auto& mesh : patches_)
        for (const auto& t : mesh.triangles) {
            if (!mesh.left_out(t)) continue;
            for (const auto e : t.edge) {
                const PatchEdge& edge = mesh.edges[e];
                const bool point = mesh.vertex[edge.a] == mesh.vertex[edge.b];
                if (point ? named[mesh.vertex[edge.a]] : kept.count(mesh_edge(mesh, edge)) > 0) continue;
                if (!point) mark(mesh, e);
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

std::vector<std::array<std::uint32_t, 2>> Refinement::open_edges() const {
    std::vector<std::array<std::uint32_t, 2>> list;
    for (const auto& n : rim_nodes_) {
        const Rim& rim = topology_.rims[n.rim];
        if (n.child == kNone && !rim.collapsed && rim.uses.size() == 1) list.push_back({std::min(n.a, n.b), std::max(n.a, n.b)});
    }
    return list;
}

}  // namespace isoparm
