#include "continuity.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "error.h"
#include "joints/continuity_joints.h"
#include "joints/edge_cells.h"
#include "topology.h"

namespace isoparm {
namespace {

Vec2 opposite(const Vec2& a) { return {-a.x, -a.y}; }

EdgeSide side_of(const Patch& patch, int edge, double t0, double t1, bool outward) {
    ParameterLine line = edge_line(patch, edge, t0, t1);
    const Vec2 inward = line.cross;
    if (outward) line.cross = opposite(line.cross);
    return EdgeSide(patch, line, inward);
}

/// Where edges do not run in step: the parameter of b nearest to a, interpolated in the Chebyshev points of a piece. It is a choice of what
/// is compared with what, and need not be exact.
TaylorModel nearest_run(const Composite& surface, const Joint::Side& a, const Joint::Side& b, double middle, double half) {
    constexpr int n = 8;
    const auto find = [&](double s) {
        const Patch &pa = surface[a.member].patch, &pb = surface[b.member].patch;
        const Vec2 p = pa.edge_point(a.edge, std::clamp(a.t0 + s * (a.t1 - a.t0), 0.0, 1.0));
        const double t = nearest_on_edge(pb, b.edge, pa.point(p.x, p.y), std::min(b.t0, b.t1), std::max(b.t0, b.t1));
        return (t - b.t0) / (b.t1 - b.t0);
    };
    if (half == 0) return TaylorModel(find(middle));
    std::array<double, n> d{}, c{};
    for (int k = 0; k < n; ++k) d[k] = std::cos(M_PI * (k + 0.5) / n), c[k] = find(middle + half * d[k]);
    for (int k = 1; k < n; ++k)  // divided differences
        for (int i = n - 1; i >= k; --i) c[i] = (c[i] - c[i - 1]) / (d[i] - d[i - k]);
    for (int k = n - 2; k >= 0; --k)  // from Newton's form to powers
        for (int i = k; i < n - 1; ++i) c[i] -= d[k] * c[i + 1];
    std::array<Interval, n> exact;
    std::copy(c.begin(), c.end(), exact.begin());
    return TaylorModel::polynomial(exact.data(), n - 1);
}

/// At most the distance of a point of a from the edge b: pieces of b that may be nearest are halved until little is left to gain.
double least_distance(const Composite& surface, const Joint::Side& a, const Joint::Side& b, double s) {
    const Patch &pa = surface[a.member].patch, &pb = surface[b.member].patch;
    const Vec2 at = pa.edge_point(a.edge, std::clamp(a.t0 + s * (a.t1 - a.t0), 0.0, 1.0));
    const Vec3<Interval> p = pa.enclose_point(at.x, at.y);
    struct Piece {
        double t0, t1, least;
        bool operator<(const Piece& o) const { return least > o.least; }  // the nearest on top
    };
    const auto piece = [&](double t0, double t1) {
        const Vec2 x = pb.edge_point(b.edge, t0), y = pb.edge_point(b.edge, t1);
        const auto d = pb.enclose_points({hull(Interval(x.x), Interval(y.x)), hull(Interval(x.y), Interval(y.y))}) - p;
        return Piece{t0, t1, sqrt(square(d.x) + square(d.y) + square(d.z)).lo};
    };
    std::vector<Piece> heap{piece(0, 1)};
    for (int k = 0; k < 300; ++k) {
        const Piece best = heap.front();
        if (best.t1 - best.t0 < 1e-12) break;
        std::pop_heap(heap.begin(), heap.end());
        heap.pop_back();
        const double middle = 0.5 * (best.t0 + best.t1);
        for (const Piece& half : {piece(best.t0, middle), piece(middle, best.t1)}) heap.push_back(half), std::push_heap(heap.begin(), heap.end());
    }
    return heap.front().least;
}

using Cut = std::array<double, 2>;  // a place on both edges

/// Adds those inside the part that are not there yet: near the ends, where parts get small, nearness is relative to the distance from them.
void add_fine_cuts(std::vector<Cut> fine, const JointPart& part, std::vector<Cut>& cuts) {
    std::sort(fine.begin(), fine.end());
    std::vector<Cut> added;
    for (const Cut& c : fine) {
        const double room = std::min(c[0] - part.a0, part.a1 - c[0]);
        if (!(room > 0)) continue;
        const auto near = [&](const Cut& o) { return std::fabs(o[0] - c[0]) <= 1e-3 * room; };
        if ((!added.empty() && near(added.back())) || std::any_of(cuts.begin() + 2, cuts.end(), near)) continue;
        added.push_back(c);
    }
    cuts.insert(cuts.end(), added.begin(), added.end());
}

/// Cuts a part at the breaks of both edges, and makes a segment of each piece.
void add_segments(const Composite& surface, const Joint& joint, const JointPart& part, std::vector<EdgeSegment>& out) {
    const Patch &pa = surface[joint.a.member].patch, &pb = surface[joint.b.member].patch;
    const Joint::Side run_a{joint.a.member, joint.a.edge, part.a0, part.a1, 0}, run_b{joint.b.member, joint.b.edge, part.b0, part.b1, 0};
    const auto partner = [&](const Joint::Side& x, const Joint::Side& y, double t) {  // of t on x, on y
        const double s = (t - x.t0) / (x.t1 - x.t0), in_step = y.t0 + s * (y.t1 - y.t0);
        if (joint.affine) return in_step;
        const Patch& patch = surface[x.member].patch;
        const Vec2 p = patch.edge_point(x.edge, t);
        return nearest_on_edge(surface[y.member].patch, y.edge, patch.point(p.x, p.y), std::min(y.t0, y.t1), std::max(y.t0, y.t1));
    };
    std::vector<Cut> cuts{{part.a0, part.b0}, {part.a1, part.b1}};
    const auto inside = [](double t, double t0, double t1) { return t > std::min(t0, t1) + 1e-12 && t < std::max(t0, t1) - 1e-12; };
    for (const double t : form_breaks(pa, joint.a.edge))
        if (inside(t, part.a0, part.a1)) cuts.push_back({t, partner(run_a, run_b, t)});
    for (const double t : form_breaks(pb, joint.b.edge))
        if (inside(t, part.b0, part.b1)) cuts.push_back({partner(run_b, run_a, t), t});
    const EdgeCuts parts_a = joint.affine ? dyadic_cuts(pa, joint.a.edge) : EdgeCuts{}, parts_b = joint.affine ? dyadic_cuts(pb, joint.b.edge) : EdgeCuts{};
    std::vector<Cut> fine;
    for (const double t : parts_a.inner) fine.push_back({t, partner(run_a, run_b, t)});
    for (const double t : parts_b.inner) fine.push_back({partner(run_b, run_a, t), t});
    const double least = fine.empty() ? 1e-12 : 0;
    add_fine_cuts(std::move(fine), part, cuts);
    std::sort(cuts.begin(), cuts.end());
    const auto vertex = [](const EdgeCuts& c, double t) { return (t == 0 && c.starts) || (t == 1 && c.ends); };
    const double tip = kTip * (part.a1 - part.a0);
    const bool starts = vertex(parts_a, part.a0) || vertex(parts_b, part.b0), ends = vertex(parts_a, part.a1) || vertex(parts_b, part.b1);
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        const auto [a0, b0] = cuts[k];
        const auto [a1, b1] = cuts[k + 1];
        if (!(a1 - a0 > least) || !(std::fabs(b1 - b0) > least)) continue;
        EdgeSegment e{side_of(pa, joint.a.edge, a0, a1, false), side_of(pb, joint.b.edge, b0, b1, true), {}, {}, {}, 0, {}};
        if (starts && a1 - part.a0 <= tip) e.singular = pa.edge_point(joint.a.edge, part.a0);
        if (ends && part.a1 - a0 <= tip) e.singular = pa.edge_point(joint.a.edge, part.a1);
        if (!joint.affine) {
            const Joint::Side a{joint.a.member, joint.a.edge, a0, a1, 0}, b{joint.b.member, joint.b.edge, b0, b1, 0};
            e.matched = [&surface, a, b](double middle, double half) { return nearest_run(surface, a, b, middle, half); };
            e.distance = [&surface, a, b](double s) { return least_distance(surface, a, b, s); };
        }
        out.push_back(std::move(e));
    }
}

/// A line between two cells of a patch, as a joint of the two with one segment per cell along it.
std::vector<EdgeSegment> line_segments(const Composite& surface, const Joint& line) {
    const Patch& patch = surface[line.a.member].patch;
    const bool is_u = line.a.edge == 0;
    const auto along = is_u ? patch.lines_v() : patch.lines_u();
    const Vec2 across = is_u ? Vec2{1, 0} : Vec2{0, 1};
    std::vector<EdgeSegment> r;
    for (std::size_t k = 0; k + 1 < along.size(); ++k) {
        const auto at = [&](double t) { return is_u ? Vec2{line.a.value, t} : Vec2{t, line.a.value}; };
        const ParameterLine l{at(along[k]), at(along[k + 1]), across};
        r.push_back({EdgeSide(patch, l, opposite(across)), EdgeSide(patch, l, across), {}, {}, {}, 0, {}});
    }
    return r;
}

std::vector<Joint> lines_of(const Composite& surface) {
    std::vector<Joint> lines;
    for (std::uint32_t m = 0; m < surface.size(); ++m)
        for (const int edge : {0, 1})
            for (const double value : edge == 0 ? surface[m].patch.breaks_u() : surface[m].patch.breaks_v()) {
                const Joint::Side side{m, edge, 0, 1, value};
                lines.push_back({Joint::Kind::line, side, side, true, {}});
            }
    return lines;
}

}  // namespace

Continuity find_continuity(const Composite& surface, const ContinuityOptions& options) {
    FoundJoints found = find_joints(surface, options);
    Continuity result{{}, lines_of(surface), std::move(found.poles), std::move(found.open)};
    for (const FoundJoint& f : found.joints) result.joints.push_back(f.joint);
    JumpLimits limits;
    limits.tolerance = {options.tolerance, options.tolerance, options.tolerance, options.angle, options.curvature};
    limits.max_halvings = options.max_halvings;
    const std::size_t joints = result.joints.size();
    tbb::parallel_for(std::size_t(0), joints + result.lines.size(), [&](std::size_t k) {
        std::vector<EdgeSegment> segments;
        Joint& joint = k < joints ? result.joints[k] : result.lines[k - joints];
        if (k >= joints) segments = line_segments(surface, joint);
        else
            for (const JointPart& p : found.joints[k].parts) add_segments(surface, joint, p, segments);
        if (segments.empty()) joint.jumps.fill({0, HUGE_VAL, {}, {}, HUGE_VAL});
        else joint.jumps = bound_jumps(segments, limits);
    });
    return result;
}

namespace {

/// `upper`: which bound of a jump counts.
JointOrder order_by(const Joint& joint, const ContinuityOptions& options, double JumpBound::*upper) {
    const std::array<double, kMeasures> tolerance{options.tolerance, options.tolerance, options.tolerance, options.angle, options.curvature};
    const auto proved = [&](int m) { return joint.jumps[m].*upper <= tolerance[m]; };
    const auto disproved = [&](int m) { return joint.jumps[m].lower > tolerance[m]; };
    JointOrder r;
    if (!proved(kC0)) {
        r.text = disproved(kC0) ? "not joined" : "undecided";
        if (!disproved(kC0)) r.undecided.push_back("C0");
        return r;
    }
    // Whether an order that needs all of `need` holds.
    const auto holds = [&](const char* name, std::initializer_list<int> need) {
        if (std::all_of(need.begin(), need.end(), proved)) return true;
        if (std::none_of(need.begin(), need.end(), disproved)) r.undecided.push_back(name);
        return false;
    };
    if (holds("G1", {kG1})) r.geometric = holds("G2", {kG1, kG2}) ? "G2" : "G1";
    r.text = r.geometric.empty() ? "C0" : r.geometric;
    if (joint.affine && holds("C1", {kC1})) r.text = holds("C2", {kC1, kC2}) ? "C2" : "C1";
    return r;
}

}  // namespace

JointOrder order_of(const Joint& joint, const ContinuityOptions& options) {
    const auto both = [](const JointOrder& o) { return o.geometric.empty() || o.geometric == o.text ? o.text : o.text + ", " + o.geometric; };
    JointOrder r = order_by(joint, options, &JumpBound::upper);
    const std::string inside = both(order_by(joint, options, &JumpBound::inside));
    if (inside != both(r)) r.inside = inside;
    return r;
}

std::string edge_text(const Composite& surface, const Joint& joint, const Joint::Side& side) {
    if (joint.kind == Joint::Kind::line) return (side.edge == 0 ? "u = " : "v = ") + to_text(side.value);
    return surface[side.member].patch.edge_name(side.edge);
}

}  // namespace isoparm
