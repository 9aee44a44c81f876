#include "tessellation/refine.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace isoparm {
namespace {

/// Runs f(member, index) over all items of all patches, in parallel; `count(member)` items each.
template <class Count, class F> void for_all(std::size_t members, Count count, F f, std::size_t grain = 64) {
    std::vector<std::size_t> start(members + 1, 0);
    for (std::size_t m = 0; m < members; ++m) start[m + 1] = start[m] + count(m);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, start.back(), grain), [&](const tbb::blocked_range<std::size_t>& range) {
        std::size_t m = std::upper_bound(start.begin(), start.end(), range.begin()) - start.begin() - 1;
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            while (i >= start[m + 1]) ++m;
            f(m, i - start[m]);
        }
    });
}

/// Tolerances around a pole, where triangles smaller than one turn as they like: to ask for less there takes ever smaller triangles.
constexpr double kAtPole = 4;
/// Slack below this part of the tolerance need not be sharp.
constexpr double kFew = 1e-6;

}  // namespace

Refinement::Refinement(const Composite& surface, const Topology& topology, double tolerance, Measure measure, double most, double turn, bool fans)
    : surface_(surface), topology_(topology), tolerance_(tolerance), measure_(measure), turn_(turn), fans_(fans && measure == Measure::geometric), positions_(topology.nodes), shared_(topology.nodes.size(), 1),
      patches_(surface.size()) {
    start(most);
}

void Refinement::replace(std::vector<PatchMesh> patches, std::vector<RimNode> rim_nodes, std::vector<Point> positions) {
    positions_ = std::move(positions);
    rim_nodes_ = std::move(rim_nodes);
    for (std::size_t m = 0; m < patches_.size(); ++m) {
        patches[m].cells = std::move(patches_[m].cells), patches[m].poles = std::move(patches_[m].poles), patches[m].fans = std::move(patches_[m].fans);
        patches_[m] = std::move(patches[m]);
        patches_[m].settled.assign(patches_[m].triangles.size(), kUnsettled);
        patches_[m].find_fans();
        measure_slack(std::uint32_t(m), 0);
    }
    worst_slack_ = 0;
    collect_slack();
}

void Refinement::collect_slack() {
    for (const PatchMesh& mesh : patches_) worst_slack_ = std::max(worst_slack_, mesh.most_slack);
}

void Refinement::measure_slack(std::uint32_t member, std::size_t first) {
    PatchMesh& mesh = patches_[member];
    mesh.slack.resize(mesh.uv.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first, mesh.uv.size(), 64), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const Vec2& p = mesh.uv[i];
            const Point& x = positions_[mesh.vertex[i]];
            const auto on = [](double t, const std::vector<double>& breaks) { return std::binary_search(breaks.begin(), breaks.end(), t); };
            const auto c = std::uint32_t(i);
            const bool on_line = on(p.x, mesh.breaks_u) || on(p.y, mesh.breaks_v);
            const double quick = on_line ? tolerance_ : mesh.root_of({c, c, c})->quick_slack(p, x);
            mesh.slack[i] = quick <= kFew * tolerance_ ? quick : slack_of(surface_[member].patch, p, x);
        }
    });
    if (first == 0) mesh.most_slack = 0, mesh.even_slack = true;
    for (std::size_t i = first; i < mesh.slack.size(); ++i) {
        mesh.most_slack = std::max(mesh.most_slack, mesh.slack[i]);
        mesh.even_slack = mesh.even_slack && mesh.slack[i] <= kFew * tolerance_;
    }
}

bool Refinement::bound_and_mark() {
    for (PatchMesh& mesh : patches_) mesh.doubtful.resize(mesh.fresh.size());
    for_all(patches_.size(), [&](std::size_t m) { return (patches_[m].fresh.size() + kTogether - 1) / kTogether; }, [&](std::size_t m, std::size_t i) {
        bound_fresh(patches_[m], std::uint32_t(m), i * kTogether, std::min((i + 1) * kTogether, patches_[m].fresh.size()));
    }, 1);
    std::vector<Round> rounds(patches_.size());
    tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t m) {
        const bool strips = !patches_[m].fans.empty();
        bound_fans(std::uint32_t(m));
        keep_doubtful(patches_[m], strips);
        rounds[m] = flip_and_mark(std::uint32_t(m));
    });
    predicted_ = double(all_triangles());
    worst_bound_ = 0, unbounded_ = 0;
    bool done = true;
    for (std::size_t m = 0; m < patches_.size(); ++m) {
        const Round& r = rounds[m];
        predicted_ += r.more, worst_bound_ = std::max(worst_bound_, r.worst), unbounded_ += r.unbounded;
        for (const auto e : r.on_rims) mark(patches_[m], e);
        done = done && r.on_rims.empty() && patches_[m].marked.empty();
    }
    return done;
}

/// Turns edges of fresh triangles of a patch, and marks its inner edges. Touches nothing of other patches.
Refinement::Round Refinement::flip_and_mark(std::uint32_t member) {
    PatchMesh& mesh = patches_[member];
    flip_fresh(mesh, member);
    Round r;
    const auto mark_to_split = [&](std::uint32_t e) {
        if (mesh.edges[e].rim_node != kNone) r.on_rims.push_back(e);
        else mark(mesh, e);
    };
    for (const auto i : mesh.fresh) {
        const PatchTriangle& t = mesh.triangles[i];
        const double bound = rounding::up(t.proof.own(measure_) + mesh.slack_of(t));
        if (!(bound <= tolerance_)) {
            mark_to_split(t.edge[t.proof.worst_edge]);
            r.unbounded += !std::isfinite(bound);
            // Strips are cut across alone: their error falls with the square of their number.
            r.more += std::isfinite(bound) ? (mesh.in_fan(t) ? std::sqrt(bound / tolerance_) : bound / tolerance_) - 1 : 0;
            r.worst = std::max(r.worst, bound);
        } else if (!turns_little(mesh, t)) {
            mark_to_split(t.edge[t.proof.worst_turn]);
            r.more += std::isfinite(t.proof.turn) ? t.proof.turn / turn_ - 1 : 0;
        }
        for (auto e : t.edge)
            if (mesh.vertex[mesh.edges[e].a] == mesh.vertex[mesh.edges[e].b] && !collapsed(mesh.edges[e])) mark_to_split(e);
    }
    mesh.fresh.clear();
    return r;
}

bool Refinement::turns_little(const PatchMesh& mesh, const PatchTriangle& t) const {
    if (turn_ == TriangleBound::unasked || t.proof.turn <= turn_ || !std::isfinite(turn_) || mesh.left_out(t)) return true;
    const auto [a, b, c] = mesh.vertices(t);
    const auto near = [&](const Point& p, const Point& q) { return length(p - q) <= tolerance_; };
    const Point &x = positions_[a], &y = positions_[b], &z = positions_[c];
    if (!(near(x, y) && near(y, z) && near(z, x))) return false;
    return !std::isfinite(t.proof.turn) || std::any_of(mesh.poles.begin(), mesh.poles.end(), [&](const Point& pole) { return std::min({length(pole - x), length(pole - y), length(pole - z)}) <= kAtPole * tolerance_; });
}

bool PatchMesh::on_break(const PatchEdge& e) const {
    return !(breaks_u.empty() && breaks_v.empty()) && along_line(uv[e.a], uv[e.b], breaks_u, breaks_v);
}

double Refinement::bound_of(const PatchMesh& mesh, std::uint32_t triangle) const {
    const PatchTriangle& t = mesh.triangles[triangle];
    double slack = mesh.slack_of(t);
    if (measure_ == Measure::parametric || !t.proof.quiet) return rounding::up(t.proof.parametric + slack);
    std::array<ProvedNeighbour, 3> neighbours;
    for (int k = 0; k < 3; ++k) {
        const PatchEdge& edge = mesh.edges[t.edge[k]];
        const auto beside = edge.side[0] == triangle ? edge.side[1] : edge.side[0];
        if (beside == kNone) continue;
        const PatchTriangle& other = mesh.triangles[beside];
        if (!other.proof.quiet || mesh.on_break(edge)) continue;  // what is left out has no area, and is not quiet
        neighbours[k] = {&other.proof, (other.edge[1] == t.edge[k]) + 2 * (other.edge[2] == t.edge[k])};
        slack = std::max(slack, mesh.slack_of(other));
    }
    return rounding::up(geometric_bound(t.proof, neighbours) + slack);
}

double Refinement::worst_bound_of(std::size_t member) const {
    const PatchMesh& mesh = patches_[member];
    return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, mesh.triangles.size(), 1024), 0.0, [&](const auto& range, double worst) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) worst = std::max(worst, mesh.settled[i] != kUnsettled ? double(mesh.settled[i]) : bound_of(mesh, std::uint32_t(i)));
        return worst;
    }, [](double a, double b) { return std::max(a, b); });
}

bool Refinement::mark_with_neighbours() {
    if (measure_ == Measure::parametric) return false;
    for_all(patches_.size(), [&](std::size_t m) { return patches_[m].settled.size(); }, [&](std::size_t m, std::size_t i) {
        PatchMesh& mesh = patches_[m];
        if (mesh.settled[i] != kUnsettled) return;
        const RoundedUp bound = bound_of(mesh, std::uint32_t(i));
        if (bound <= tolerance_) mesh.settled[i] = bound;
    }, 1024);
    std::vector<std::vector<std::uint32_t>> open(patches_.size());
    tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t m) {
        PatchMesh& mesh = patches_[m];
        for (std::uint32_t i = 0; i < mesh.settled.size(); ++i)
            if (mesh.settled[i] == kUnsettled) open[m].push_back(i);
        // Turning one edge may have mended the next triangle.
        const auto mended = [&](std::uint32_t i) { return mesh.settled[i] != kUnsettled || bound_of(mesh, i) <= tolerance_ || flip_any(mesh, std::uint32_t(m), i, true); };
        open[m].erase(std::remove_if(open[m].begin(), open[m].end(), mended), open[m].end());
    });
    bool any = false;
    for (std::size_t m = 0; m < patches_.size(); ++m)
        for (const auto i : open[m]) {
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

std::size_t Refinement::all_triangles() const {
    std::size_t n = 0;
    for (const auto& p : patches_) n += p.triangles.size();
    return n;
}

std::size_t Refinement::triangle_count() const {
    std::size_t n = 0;
    for (const auto& p : patches_) {
        n += p.triangles.size();
        if (!p.poles.empty()) n -= std::size_t(std::count_if(p.triangles.begin(), p.triangles.end(), [&](const PatchTriangle& t) { return p.left_out(t); }));
    }
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
