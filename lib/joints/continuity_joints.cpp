#include "joints/continuity_joints.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "error.h"
#include "topology.h"

namespace isoparm {
namespace {

constexpr int kSamples = 16;
constexpr double kSnap = 1e-9;  // parameters of an edge nearer than this are one
constexpr std::size_t kMostPairs = 2'000'000;  // of open edges that are compared

using Side = Joint::Side;

Point position(const Composite& surface, const Side& side, double s) {
    const Vec2 p = surface[side.member].patch.edge_point(side.edge, side.t0 + s * (side.t1 - side.t0));
    return surface[side.member].patch.point(p.x, p.y);
}
double nearest(const Composite& surface, const Side& side, const Point& p) {
    return nearest_on_edge(surface[side.member].patch, side.edge, p, std::min(side.t0, side.t1), std::max(side.t0, side.t1));
}

/// Largest distances from points of a to b: to the point at the same place of the run, and to the nearest.
struct Apart {
    double in_step = 0, nearest = 0;
};
Apart apart(const Composite& surface, const Side& a, const Side& b) {
    Apart d;
    const Patch& patch = surface[b.member].patch;
    for (int k = 0; k <= kSamples; ++k) {
        const double s = k / double(kSamples);
        const Point p = position(surface, a, s);
        const double here = distance(p, position(surface, b, s));
        d.in_step = std::max(d.in_step, here);
        if (here <= d.nearest) continue;
        const Vec2 q = patch.edge_point(b.edge, nearest(surface, b, p));
        d.nearest = std::max(d.nearest, std::min(here, distance(p, patch.point(q.x, q.y))));
    }
    return d;
}

double length_between(const Composite& surface, const Side& s) {
    double sum = 0;
    for (int k = 0; k < kSamples; ++k) sum += distance(position(surface, s, k / double(kSamples)), position(surface, s, (k + 1) / double(kSamples)));
    return sum;
}
/// Of an edge, in its parameter: what is nearer to its end than four times the distance within which vertices are one belongs to the end. Where two edges are apart by just that distance,
/// a vertex may be too far from a vertex, and near enough to the edge beside it.
double near_end(const Composite& surface, std::uint32_t member, int edge, double within) {
    const double length = length_between(surface, {member, edge, 0, 1, 0});
    return length > 0 ? std::min(1e-3, 4 * within / length) : 0;
}

/// Places of T-joints were found as the nearest to a vertex, up to rounding. Most are halves, quarters ...: there the two patches have common parts, on which both are exact.
double snapped(double t, double near) {
    if (t <= near || t >= 1 - near) return t <= near ? 0 : 1;
    const double dyadic = std::round(t * 0x1p10) * 0x1p-10;
    return std::fabs(t - dyadic) <= 1e-13 ? dyadic : t;
}

bool whole(const Side& s) { return std::min(s.t0, s.t1) <= kSnap && std::max(s.t0, s.t1) >= 1 - kSnap; }

/// Does a second patch use it, or a pair of others run along it?
bool joined(const Rim& rim) { return rim.uses.size() == 2 || rim.beside != UINT32_MAX; }

/// One joint of all rims that two edges share in one direction.
std::vector<FoundJoint> joints_of(const Composite& surface, const Topology& topology, double size, double within) {
    std::map<std::tuple<std::uint32_t, int, std::uint32_t, int, bool>, std::vector<std::pair<RimUse, RimUse>>> groups;
    for (const Rim& rim : topology.rims) {
        if (rim.collapsed || !joined(rim)) continue;
        RimUse a = rim.uses[0], b = rim.uses.size() == 2 ? rim.uses[1] : topology.rims[rim.beside].uses[0];
        if (std::tie(b.member, b.edge) < std::tie(a.member, a.edge)) std::swap(a, b);
        if (a.t1 < a.t0) std::swap(a.t0, a.t1), std::swap(b.t0, b.t1);
        groups[{a.member, a.edge, b.member, b.edge, b.t1 < b.t0}].push_back({a, b});
    }
    std::vector<FoundJoint> found;
    for (auto& [key, rims] : groups) {
        std::sort(rims.begin(), rims.end(), [](const auto& x, const auto& y) { return x.first.t0 < y.first.t0; });
        const double near_a = near_end(surface, std::get<0>(key), std::get<1>(key), within), near_b = near_end(surface, std::get<2>(key), std::get<3>(key), within);
        for (auto [a, b] : rims) {
            for (double* t : {&a.t0, &a.t1}) *t = snapped(*t, near_a);
            for (double* t : {&b.t0, &b.t1}) *t = snapped(*t, near_b);
            if (a.t0 == a.t1 || b.t0 == b.t1) continue;
            const Side sa{a.member, a.edge, a.t0, a.t1, 0}, sb{b.member, b.edge, b.t0, b.t1, 0};
            const Apart d = apart(surface, sa, sb);
            const bool affine = !(d.in_step > 1e-12 * size && d.nearest < 0.1 * d.in_step);
            const bool continues = !found.empty() && found.back().joint.a.member == a.member && found.back().joint.a.edge == a.edge && found.back().joint.b.member == b.member &&
                                   found.back().joint.b.edge == b.edge && std::fabs(found.back().joint.a.t1 - a.t0) <= kSnap && std::fabs(found.back().joint.b.t1 - b.t0) <= kSnap;
            if (!continues) found.push_back({{Joint::Kind::shared, sa, sb, true, {}}, {}});
            FoundJoint& f = found.back();
            f.joint.a.t1 = a.t1, f.joint.b.t1 = b.t1;
            f.joint.affine = f.joint.affine && affine;
            f.parts.push_back({a.t0, a.t1, b.t0, b.t1});
        }
    }
    for (FoundJoint& f : found)
        f.joint.kind = !whole(f.joint.a) || !whole(f.joint.b) ? Joint::Kind::t_joint : f.joint.a.member == f.joint.b.member ? Joint::Kind::seam : Joint::Kind::shared;
    return found;
}

/// Runs of rims that no second patch uses.
std::vector<Side> open_runs(const Composite& surface, const Topology& topology, double within) {
    std::vector<Side> runs;
    for (std::uint32_t m = 0; m < surface.size(); ++m)
        for (int k = 0; k < surface[m].patch.edges(); ++k) {
            bool before = false;
            for (const EdgeRim& r : topology.edges[m][std::size_t(k)]) {
                const Rim& rim = topology.rims[r.rim];
                const bool open = !joined(rim) && !rim.collapsed;
                if (open && before) runs.back().t1 = r.t1;
                else if (open) runs.push_back({m, k, r.t0, r.t1, 0});
                before = open;
            }
        }
    for (Side& s : runs) {
        const double near = s.t0 < 1e-3 || s.t1 > 1 - 1e-3 ? near_end(surface, s.member, s.edge, within) : 0;
        s.t0 = snapped(s.t0, near), s.t1 = snapped(s.t1, near);
    }
    std::erase_if(runs, [](const Side& s) { return s.t0 == s.t1; });
    return runs;
}

struct Run {
    Side side;
    Point low, high, first, last;
    double length = 0, reach = 0;
};
/// Unit vector across an edge, in the surface, into the patch.
Point inward(const Composite& surface, const Side& side) {
    const Patch& patch = surface[side.member].patch;
    const ParameterLine line = edge_line(patch, side.edge, std::min(side.t0, side.t1), std::max(side.t0, side.t1));
    const Vec2 along{line.to.x - line.from.x, line.to.y - line.from.y}, at = patch.edge_point(side.edge, 0.5 * (side.t0 + side.t1));
    const PointFrame f = patch.frame(at.x, at.y);
    const auto derivative = [&](const Vec2& d) {
        Point p;
        for (int axis = 0; axis < 3; ++axis) p[axis] = f[axis].coefficient(1, 0) * d.x + f[axis].coefficient(0, 1) * d.y;
        return p;
    };
    const Point t = derivative(along), c = derivative(line.cross);
    return normalized(c - (dot(c, t) / dot(t, t)) * t);
}
Run run_of(const Composite& surface, const Side& side, double capture) {
    Run r{side, {}, {}, position(surface, side, 0), position(surface, side, 1), 0, 0};
    r.low = r.high = r.first;
    Point before = r.first;
    for (int k = 1; k <= kSamples; ++k) {
        const Point p = position(surface, side, k / double(kSamples));
        for (int axis = 0; axis < 3; ++axis) r.low[axis] = std::min(r.low[axis], p[axis]), r.high[axis] = std::max(r.high[axis], p[axis]);
        r.length += distance(p, before), before = p;
    }
    // A neighbour is nearer than what is across the patch: the edges of a narrow strip are not each other's neighbours.
    r.reach = std::min(capture, 0.1 * r.length);
    const int edges = surface[side.member].patch.edges();
    for (const int beside : {(side.edge + 1) % edges, (side.edge + edges - 1) % edges}) {
        const double across = length_between(surface, {side.member, beside, 0, 1, 0});
        if (across > 0.01 * r.reach) r.reach = std::min(r.reach, 0.1 * across);  // a collapsed edge says nothing
    }
    return r;
}

struct Candidate {
    std::size_t a, b;
    Side at_a, at_b;
    double far;
};

bool boxes_near(const Run& a, const Run& b, double near) {
    for (int axis = 0; axis < 3; ++axis)
        if (b.low[axis] > a.high[axis] + near || b.high[axis] < a.low[axis] - near) return false;
    return true;
}

/// Where along a all of b runs, if it stays near.
std::optional<Candidate> beside(const Composite& surface, const std::vector<Run>& runs, std::size_t i, std::size_t j) {
    const Run &a = runs[i], &b = runs[j];
    const double near = std::min(a.reach, b.reach);
    if (!boxes_near(a, b, near)) return {};
    // An end of b that is near an end of a belongs to it.
    const auto place = [&](const Point& p, bool other_is_first) {
        const double to_first = distance(p, a.first), to_last = distance(p, a.last);
        if (std::min(to_first, to_last) > near) return nearest(surface, a.side, p);
        if (std::max(to_first, to_last) <= near) return other_is_first ? a.side.t1 : a.side.t0;  // a closed run
        return to_first < to_last ? a.side.t0 : a.side.t1;
    };
    Candidate best{i, j, a.side, b.side, HUGE_VAL};
    for (const bool backwards : {false, true}) {
        Candidate c{i, j, a.side, b.side, 0};
        c.at_a.t0 = place(backwards ? b.last : b.first, false), c.at_a.t1 = place(backwards ? b.first : b.last, true);
        if (backwards) std::swap(c.at_b.t0, c.at_b.t1);
        if (!(c.at_a.t1 - c.at_a.t0 > 1e-3)) continue;
        c.far = std::max(apart(surface, c.at_a, c.at_b).nearest, apart(surface, c.at_b, c.at_a).nearest);
        if (c.far < best.far) best = c;
    }
    // Two sheets that lie above each other, the sides of a thin plate, do not continue each other: both are inside on the same side.
    if (!(best.far <= near) || dot(inward(surface, best.at_a), inward(surface, best.at_b)) > 0.5) return {};
    return best;
}

/// Pairs runs of one surface that are near each other, the nearest first. What is left stays in `open`.
void capture_gaps(const Composite& surface, const ContinuityOptions& options, FoundJoints& found) {
    std::vector<Run> runs;
    for (const Side& s : found.open) runs.push_back(run_of(surface, s, options.capture));
    const auto group = [&](std::size_t i) { return options.surface.empty() ? std::string() : options.surface[runs[i].side.member]; };
    std::vector<std::size_t> by_x(runs.size());
    for (std::size_t i = 0; i < runs.size(); ++i) by_x[i] = i;
    std::stable_sort(by_x.begin(), by_x.end(), [&](std::size_t i, std::size_t j) { return runs[i].low.x < runs[j].low.x; });
    std::vector<std::pair<std::size_t, std::size_t>> pairs;  // of runs whose boxes come near each other
    for (std::size_t k = 0; k < by_x.size(); ++k)
        for (std::size_t l = k + 1; l < by_x.size() && runs[by_x[l]].low.x <= runs[by_x[k]].high.x + runs[by_x[k]].reach; ++l) {
            if (group(by_x[k]) != group(by_x[l]) || !boxes_near(runs[by_x[k]], runs[by_x[l]], std::min(runs[by_x[k]].reach, runs[by_x[l]].reach))) continue;
            if (pairs.size() >= kMostPairs) throw Error(ErrorKind::budget, "more than " + std::to_string(kMostPairs) + " pairs of open edges are within " + to_text(options.capture) + " of each other: look for gaps within less (--capture)");
            pairs.push_back({by_x[k], by_x[l]}), pairs.push_back({by_x[l], by_x[k]});
        }
    std::sort(pairs.begin(), pairs.end());
    std::vector<Candidate> candidates;
    for (const auto& [i, j] : pairs)
        if (const auto c = beside(surface, runs, i, j)) candidates.push_back(*c);
    std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& x, const Candidate& y) { return x.far < y.far; });
    std::vector<std::vector<Side>> used(runs.size());
    const auto is_free = [&](std::size_t i, const Side& s) {
        return std::none_of(used[i].begin(), used[i].end(), [&](const Side& o) { return std::min(o.t1, s.t1) - std::max(o.t0, s.t0) > kSnap; });
    };
    for (const Candidate& c : candidates) {
        Side b = c.at_b;
        if (b.t1 < b.t0) std::swap(b.t0, b.t1);
        if (!is_free(c.a, c.at_a) || !is_free(c.b, b)) continue;
        used[c.a].push_back(c.at_a), used[c.b].push_back(b);
        const Apart d = apart(surface, c.at_a, c.at_b);
        found.joints.push_back({{Joint::Kind::gap, c.at_a, c.at_b, !(d.nearest < 0.1 * d.in_step), {}}, {{c.at_a.t0, c.at_a.t1, c.at_b.t0, c.at_b.t1}}});
    }
    std::vector<Side> left;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        std::sort(used[i].begin(), used[i].end(), [](const Side& x, const Side& y) { return x.t0 < y.t0; });
        Side rest = runs[i].side;
        for (const Side& u : used[i]) {
            if (u.t0 - rest.t0 > kSnap) left.push_back({rest.member, rest.edge, rest.t0, u.t0, 0});
            rest.t0 = std::max(rest.t0, u.t1);
        }
        if (rest.t1 - rest.t0 > kSnap) left.push_back(rest);
    }
    found.open = left;
}

}  // namespace

FoundJoints find_joints(const Composite& surface, const ContinuityOptions& options) {
    const double within = std::max(options.tolerance, 1e-7 * options.size);
    const Topology topology = find_topology(surface, within);
    FoundJoints found{joints_of(surface, topology, options.size, within), {}, open_runs(surface, topology, within)};
    for (std::uint32_t m = 0; m < surface.size(); ++m)
        for (int k = 0; k < surface[m].patch.edges(); ++k)
            for (const EdgeRim& r : topology.edges[m][std::size_t(k)])
                if (topology.rims[r.rim].collapsed && r.t0 == 0) found.poles.push_back({m, k, position(surface, {m, k, 0, 1, 0}, 0)});
    if (options.capture > 0) capture_gaps(surface, options, found);
    return found;
}

}  // namespace isoparm
