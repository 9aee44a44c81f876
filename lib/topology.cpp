#include "topology.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <unordered_map>

namespace isoparm {
namespace {

constexpr int kSamples = 32;  // intervals an edge is sampled in before a search is refined

Point edge_position(const Patch& patch, int edge, double t) {
    const Vec2 p = patch.edge_point(edge, t);
    return patch.point(p.x, p.y);
}

template <std::size_t N> std::array<Point, N> edge_positions(const Patch& patch, int edge, const std::array<double, N>& t) {
    std::array<double, N> u, v;
    for (std::size_t i = 0; i < N; ++i) {
        const Vec2 p = patch.edge_point(edge, t[i]);
        u[i] = p.x, v[i] = p.y;
    }
    std::array<Point, N> x;
    patch.points(N, u.data(), v.data(), x.data());
    return x;
}
/// At kSamples + 1 parameters from low to high.
std::array<Point, kSamples + 1> edge_positions(const Patch& patch, int edge, double low, double high) {
    std::array<double, kSamples + 1> t;
    for (int i = 0; i <= kSamples; ++i) t[std::size_t(i)] = i == kSamples ? high : low + (high - low) * i / kSamples;
    return edge_positions(patch, edge, t);
}

/// Points closer than the tolerance become one node; the earliest keeps its position.
class NodeTable {
public:
    explicit NodeTable(double tolerance) : tolerance_(tolerance), cell_(std::max(2 * tolerance, 1e-300)) {}

    std::uint32_t node_at(const Point& p) {
        std::uint32_t best = UINT32_MAX;
        for (int dx = -1; dx <= 1; ++dx)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dz = -1; dz <= 1; ++dz) {
                    const auto found = cells_.find(key(p, dx, dy, dz));
                    if (found == cells_.end()) continue;
                    for (const auto k : found->second)
                        if (distance(points[k], p) <= tolerance_) best = std::min(best, k);
                }
        if (best != UINT32_MAX) return best;
        points.push_back(p);
        cells_[key(p, 0, 0, 0)].push_back(std::uint32_t(points.size() - 1));
        return std::uint32_t(points.size() - 1);
    }
    std::vector<Point> points;

private:
    struct Hash {
        std::size_t operator()(const std::array<double, 3>& k) const {
            std::size_t h = 0;
            for (double x : k) h = h * 1099511628211u + std::hash<double>{}(x);
            return h;
        }
    };
    std::array<double, 3> key(const Point& p, int dx, int dy, int dz) const {
        return {std::floor(p.x / cell_) + dx + 0.0, std::floor(p.y / cell_) + dy + 0.0, std::floor(p.z / cell_) + dz + 0.0};
    }
    double tolerance_, cell_;
    std::unordered_map<std::array<double, 3>, std::vector<std::uint32_t>, Hash> cells_;
};

struct NodeOnEdge {
    double t;
    std::uint32_t node;
};

struct EdgeShape {
    std::array<Point, kSamples + 1> samples;
    Point low, high;
    double step = 0;  // the longest between samples
    bool collapsed = true;
    std::vector<NodeOnEdge> nodes;
};

EdgeShape sample_edge(const Patch& patch, int edge, double tolerance) {
    EdgeShape s;
    s.samples = edge_positions(patch, edge, 0, 1);
    s.low = s.high = s.samples[0];
    for (std::size_t i = 0; i < kSamples; ++i) s.step = std::max(s.step, distance(s.samples[i], s.samples[i + 1]));
    for (const auto& p : s.samples) {
        s.collapsed = s.collapsed && distance(p, s.samples[0]) <= tolerance;
        for (int axis = 0; axis < 3; ++axis) s.low[axis] = std::min(s.low[axis], p[axis]), s.high[axis] = std::max(s.high[axis], p[axis]);
    }
    const double margin = tolerance + 0.25 * distance(s.low, s.high);  // the curve between the samples
    for (int axis = 0; axis < 3; ++axis) s.low[axis] -= margin, s.high[axis] += margin;
    return s;
}

/// Do the two pieces coincide, b taken forwards or backwards? Returns false, or sets t0, t1 and affine of `use`.
bool coincide(const Composite& surface, const RimUse& owner, RimUse& use, bool backwards, double tolerance) {
    const Patch &pa = surface[owner.member].patch, &pb = surface[use.member].patch;
    if (backwards) std::swap(use.t0, use.t1);
    constexpr int n = 8;
    bool affine = true;
    double last = use.t0;
    for (int i = 1; i < n; ++i) {
        const double f = double(i) / n;
        const Point a = edge_position(pa, owner.edge, owner.t0 + f * (owner.t1 - owner.t0));
        affine = affine && distance(a, edge_position(pb, use.edge, use.t0 + f * (use.t1 - use.t0))) <= tolerance;
        if (affine) continue;
        const double t = nearest_on_edge(pb, use.edge, a, std::min(use.t0, use.t1), std::max(use.t0, use.t1));
        const bool monotone = use.t1 > use.t0 ? t > last : t < last;
        if (!monotone || distance(a, edge_position(pb, use.edge, t)) > tolerance) {
            if (backwards) std::swap(use.t0, use.t1);
            return false;
        }
        last = t;
    }
    use.affine = affine;
    return true;
}

/// Direction in which the boundary of the domain, counter-clockwise, runs along an edge.
bool along_boundary(const Patch& patch, int edge) { return patch.domain() == Domain::triangle || edge < 2; }

/// Unit vector in the surface at the middle of a use, across the edge, into the patch.
Point conormal(const Composite& surface, const RimUse& use) {
    const Patch& patch = surface[use.member].patch;
    const double t = 0.5 * use.t0 + 0.5 * use.t1;
    const Vec2 p = patch.edge_point(use.edge, t), q = patch.edge_point(use.edge, use.t1);
    const Rect r = patch.rect();
    const Vec2 centre = patch.domain() == Domain::triangle ? Vec2{1.0 / 3, 1.0 / 3} : Vec2{0.5 * r.u0 + 0.5 * r.u1, 0.5 * r.v0 + 0.5 * r.v1};
    const PointJet x = patch.jet(p.x, p.y);
    const Point su{x.x.coefficient(1, 0), x.y.coefficient(1, 0), x.z.coefficient(1, 0)}, sv{x.x.coefficient(0, 1), x.y.coefficient(0, 1), x.z.coefficient(0, 1)};
    const Point edge = (q.x - p.x) * su + (q.y - p.y) * sv, inward = (centre.x - p.x) * su + (centre.y - p.y) * sv;
    const Point n = inward - (dot(inward, edge) / dot(edge, edge)) * edge;
    return n / length(n);
}

/// Where more than two patches meet along one rim, several sheets touch there: each patch is paired with the one that
/// continues it most smoothly, and every pair gets a rim of its own, so that the mesh is a manifold. The last of an odd
/// number has an open edge there.
void separate_sheets(const Composite& surface, Topology& topology, double tolerance) {
    const std::size_t count = topology.rims.size();
    for (std::uint32_t r = 0; r < count; ++r) {
        if (topology.rims[r].uses.size() < 3) continue;
        std::vector<RimUse> left = std::move(topology.rims[r].uses);
        topology.rims[r].uses.clear();
        std::vector<Point> across;
        for (const auto& use : left) across.push_back(conormal(surface, use));
        for (bool first = true; !left.empty(); first = false) {
            std::size_t a = 0, b = 1;
            for (std::size_t i = 0; i < left.size(); ++i)
                for (std::size_t j = i + 1; j < left.size(); ++j)
                    if (dot(across[i], across[j]) < dot(across[a], across[b]) - 1e-6) a = i, b = j;
            const std::uint32_t to = first ? r : std::uint32_t(topology.rims.size());
            if (!first) {
                Rim copy = topology.rims[r];
                copy.uses.clear();
                topology.rims.push_back(copy);
            }
            left[a].affine = true;  // it owns the rim now
            const bool paired = left.size() > 1;
            if (!paired) topology.rims[to].beside = r;
            if (paired && !coincide(surface, left[a], left[b], false, 2 * tolerance)) left[b].affine = false;
            for (const std::size_t i : paired ? std::vector<std::size_t>{a, b} : std::vector<std::size_t>{a}) {
                for (auto& er : topology.edges[left[i].member][left[i].edge])
                    if (er.rim == r && std::min(left[i].t0, left[i].t1) == std::min(er.t0, er.t1)) er.rim = to, er.use = std::uint32_t(topology.rims[to].uses.size());
                topology.rims[to].uses.push_back(left[i]);
            }
            if (paired) left.erase(left.begin() + b), across.erase(across.begin() + b);
            left.erase(left.begin() + a), across.erase(across.begin() + a);
        }
    }
}

/// Neighbours agree when they run along a shared rim in opposite directions; spread that from the first patch of each
/// connected piece. A surface with one side only (a Moebius band) keeps one rim where this cannot hold.
std::vector<char> orient(const Composite& surface, const Topology& topology) {
    std::vector<std::vector<std::pair<std::uint32_t, bool>>> neighbours(surface.size());
    for (const auto& rim : topology.rims) {
        if (rim.collapsed || rim.uses.size() != 2) continue;
        const auto forward = [&](const RimUse& use) { return (use.t1 > use.t0) == along_boundary(surface[use.member].patch, use.edge); };
        const bool same = forward(rim.uses[0]) == forward(rim.uses[1]);
        neighbours[rim.uses[0].member].push_back({rim.uses[1].member, same});
        neighbours[rim.uses[1].member].push_back({rim.uses[0].member, same});
    }
    std::vector<char> flipped(surface.size(), 0), seen(surface.size(), 0);
    for (std::uint32_t start = 0; start < surface.size(); ++start) {
        if (seen[start]) continue;
        std::queue<std::uint32_t> todo;
        todo.push(start);
        seen[start] = 1;
        while (!todo.empty()) {
            const auto m = todo.front();
            todo.pop();
            for (const auto& [other, same] : neighbours[m]) {
                if (seen[other]) continue;
                seen[other] = 1;
                flipped[other] = char(flipped[m] != same);
                todo.push(other);
            }
        }
    }
    return flipped;
}

}  // namespace

double nearest_on_edge(const Patch& patch, int edge, const Point& target, double low, double high) {
    const auto far = [&](double t) { return distance(edge_position(patch, edge, t), target); };
    const auto samples = edge_positions(patch, edge, low, high);
    double best = low, least = distance(samples[0], target);
    for (int i = 1; i <= kSamples; ++i)
        if (const double d = distance(samples[std::size_t(i)], target); d < least) best = i == kSamples ? high : low + (high - low) * i / kSamples, least = d;
    // Gauss-Newton on the edge, by central differences of step h, kept inside the bracket of the best sample.
    const double step = (high - low) / kSamples, a = std::max(low, best - step), b = std::min(high, best + step);
    for (int i = 0; i < 40; ++i) {
        const double h = 1e-6 * (high - low), left = std::max(a, best - h), right = std::min(b, best + h);
        const auto [before, here, after] = edge_positions<3>(patch, edge, {left, best, right});
        const Point d = (after - before) / (right - left);
        const double dd = dot(d, d);
        if (!(dd > 0)) break;
        const double next = std::clamp(best + dot(target - here, d) / dd, a, b), moved = std::fabs(next - best);
        if (const double d = far(next); d <= least) best = next, least = d;
        if (moved <= 1e-16 * (1 + std::fabs(best))) break;
    }
    return best;
}

Topology find_topology(const Composite& surface, double tolerance) {
    // Nodes: corners and breaks of every edge.
    NodeTable table(tolerance);
    std::vector<std::array<EdgeShape, 4>> shapes(surface.size());
    tbb::parallel_for(std::size_t(0), surface.size(), [&](std::size_t m) {
        for (int k = 0; k < surface[m].patch.edges(); ++k) shapes[m][k] = sample_edge(surface[m].patch, k, tolerance);
    });
    for (std::size_t m = 0; m < surface.size(); ++m) {
        const Patch& patch = surface[m].patch;
        for (int k = 0; k < patch.edges(); ++k) {
            EdgeShape& s = shapes[m][k];
            std::vector<double> t{0};
            for (double b : patch.edge_breaks(k)) t.push_back(b);
            t.push_back(1);
            for (double x : t) s.nodes.push_back({x, table.node_at(edge_position(patch, k, x))});
            if (s.collapsed)
                for (auto& n : s.nodes) n.node = s.nodes[0].node;
        }
    }
    // Nodes of other edges that lie inside an edge.
    std::vector<std::uint32_t> by_x(table.points.size());
    for (std::uint32_t i = 0; i < by_x.size(); ++i) by_x[i] = i;
    std::sort(by_x.begin(), by_x.end(), [&](auto a, auto b) { return table.points[a].x < table.points[b].x; });
    tbb::parallel_for(std::size_t(0), surface.size(), [&](std::size_t m) {
        for (int k = 0; k < surface[m].patch.edges(); ++k) {
            EdgeShape& s = shapes[m][k];
            if (s.collapsed) continue;
            auto it = std::lower_bound(by_x.begin(), by_x.end(), s.low.x, [&](auto n, double x) { return table.points[n].x < x; });
            for (; it != by_x.end() && table.points[*it].x <= s.high.x; ++it) {
                const Point& p = table.points[*it];
                if (p.y < s.low.y || p.y > s.high.y || p.z < s.low.z || p.z > s.high.z) continue;
                if (std::any_of(s.nodes.begin(), s.nodes.end(), [&](const NodeOnEdge& n) { return n.node == *it; })) continue;
                double near = HUGE_VAL;  // a sample is no farther than the node's distance plus the sampled step, twice to be safe
                for (const auto& q : s.samples) near = std::min(near, distance(p, q));
                if (near > tolerance + 2 * s.step) continue;
                const double t = nearest_on_edge(surface[m].patch, k, p, 0, 1);
                if (t > 1e-7 && t < 1 - 1e-7 && distance(edge_position(surface[m].patch, k, t), p) <= tolerance) s.nodes.push_back({t, *it});
            }
            std::sort(s.nodes.begin(), s.nodes.end(), [](const NodeOnEdge& a, const NodeOnEdge& b) { return a.t < b.t; });
        }
    });
    // Rims: pieces with the same two nodes that coincide in between.
    Topology result;
    result.nodes = std::move(table.points);
    result.edges.resize(surface.size());
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> between;
    for (std::uint32_t m = 0; m < surface.size(); ++m)
        for (int k = 0; k < surface[m].patch.edges(); ++k) {
            const EdgeShape& s = shapes[m][k];
            for (std::size_t i = 0; i + 1 < s.nodes.size(); ++i) {
                RimUse use{m, k, s.nodes[i].t, s.nodes[i + 1].t};
                const auto a = s.nodes[i].node, b = s.nodes[i + 1].node;
                auto& candidates = between[std::minmax(a, b)];
                bool found = false;
                for (std::uint32_t r : candidates) {
                    Rim& rim = result.rims[r];
                    if (s.collapsed || rim.collapsed) continue;
                    for (const bool backwards : {false, true}) {
                        if (!(backwards ? a == rim.b && b == rim.a : a == rim.a && b == rim.b)) continue;
                        if (!coincide(surface, rim.uses[0], use, backwards, tolerance)) continue;
                        rim.uses.push_back(use);
                        result.edges[m][k].push_back({r, std::uint32_t(rim.uses.size() - 1), backwards, s.nodes[i].t, s.nodes[i + 1].t});
                        found = true;
                        break;
                    }
                    if (found) break;
                }
                if (found) continue;
                const auto r = std::uint32_t(result.rims.size());
                result.rims.push_back({a, b, s.collapsed, {use}});
                if (!s.collapsed) candidates.push_back(r);
                result.edges[m][k].push_back({r, 0, false, s.nodes[i].t, s.nodes[i + 1].t});
            }
        }
    separate_sheets(surface, result, tolerance);
    result.flipped = orient(surface, result);
    return result;
}

}  // namespace isoparm
