// refine_fan.cpp -- how a Refinement bounds what lies around a collapsed edge as one: there a mesh triangle is the image of a whole strip of the
// domain from its base to the edge, of itself and of what the triangles beside it that are left out have. docs/certificates.md, "Fans", has the proof.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "tessellation/refine.h"

namespace isoparm {
namespace {

using rounding::product_up, rounding::up;

/// A strip of a fan: above the base from b to c, between lines that end on the collapsed edge.
struct Strip {
    const Patch& patch;
    const PoleFan& fan;
    Vec2 b, c;

    double along(const Vec2& p) const { return fan.along_u ? p.x : p.y; }
    double across(const Vec2& p) const { return fan.along_u ? p.y : p.x; }
    Vec2 at(double along) const { return fan.along_u ? Vec2{along, fan.at} : Vec2{fan.at, along}; }
    Box box(const Interval& along, const Interval& across) const { return fan.along_u ? Box{along, across} : Box{across, along}; }
};

/// What is proved: |S - bilinear| <= (base + side) / 8, the strip's sides and its base being what bends.
struct StripBends {
    double base = 0, side = 0;
    double bound() const { return up(up(base + side) / 8); }
};

/// Tolerances up to which a sharper bound is tried.
constexpr double kNear = 8;
/// Where the bend of a strip's sides is looked at.
constexpr double kOfHeight[] = {0.25, 0.75};

/// From second derivatives, c[3 4 5] of jets, over a part of the strip.
template <class Jets> StripBends bends_of(const Strip& s, const Jets& jets) {
    const Interval width = Interval(s.along(s.c)) - Interval(s.along(s.b)), rise = Interval(s.across(s.c)) - Interval(s.across(s.b));
    const Interval slope = hull(Interval(0), rise), height = hull(Interval(s.fan.at) - Interval(s.across(s.b)), Interval(s.fan.at) - Interval(s.across(s.c)));
    std::array<double, 3> base, side;
    for (int axis = 0; axis < 3; ++axis) {
        const auto& c = jets[axis].c;
        const Interval aa = Interval(2) * (s.fan.along_u ? c[3] : c[5]), bb = Interval(2) * (s.fan.along_u ? c[5] : c[3]);
        base[axis] = mag(aa * square(width) + Interval(2) * c[4] * width * slope + bb * square(slope));
        side[axis] = mag(bb * square(height));
    }
    return {rounding::length_up(base[0], base[1], base[2]), rounding::length_up(side[0], side[1], side[2])};
}

/// Over parts x parts pieces.
StripBends bends_over(const Strip& s, int parts) {
    const auto piece = [&](double from, double to, int k) { return Interval(k == 0 ? from : from + (to - from) * k / parts, k + 1 == parts ? to : from + (to - from) * (k + 1) / parts); };
    const auto [a0, a1] = std::minmax({s.along(s.b), s.along(s.c)});
    const auto range = std::minmax({s.across(s.b), s.across(s.c), s.fan.at});
    StripBends most;
    for (int i = 0; i < parts; ++i)
        for (int k = 0; k < parts; ++k) {
            const StripBends b = bends_of(s, s.patch.enclose(s.box(piece(a0, a1, i), piece(range.first, range.second, k))).over);
            // No number is no bound.
            if (!std::isfinite(b.base + b.side)) return {TriangleBound::none, TriangleBound::none};
            most.base = std::max(most.base, b.base), most.side = std::max(most.side, b.side);
        }
    return most;
}

}  // namespace

bool PatchMesh::in_fan(const PatchTriangle& t) const {
    return std::any_of(fans.begin(), fans.end(), [&](const PoleFan& f) { return f.on(uv[t.corner[0]]) || f.on(uv[t.corner[1]]) || f.on(uv[t.corner[2]]); });
}

void PatchMesh::find_fans() {
    for (PoleFan& f : fans) {
        f.triangles.clear();
        for (std::uint32_t i = 0; i < triangles.size(); ++i)
            if (f.touches(*this, triangles[i])) f.triangles.push_back(i);
    }
}

/// Which corner of a triangle is its apex: the only one on the edge; -1 where two are.
int PoleFan::apex(const PatchMesh& mesh, const PatchTriangle& t) const {
    int found = -1;
    for (int k = 0; k < 3; ++k)
        if (on(mesh.uv[t.corner[k]])) {
            if (found >= 0) return -1;
            found = k;
        }
    return found;
}

/// Does every base go the same way along the edge, so that the strips above all of them fill what the triangles fill?
bool PoleFan::is_graph(const PatchMesh& mesh) const {
    return std::all_of(triangles.begin(), triangles.end(), [&](std::uint32_t i) {
        const PatchTriangle& t = mesh.triangles[i];
        const int k = apex(mesh, t);
        if (k < 0) return true;
        const Vec2 &b = mesh.uv[t.corner[std::size_t(k + 1) % 3]], &c = mesh.uv[t.corner[std::size_t(k + 2) % 3]];
        // Triangles are counter-clockwise. A strip belongs to one fan only.
        const double way = along_u ? c.x - b.x : c.y - b.y;
        const bool other = std::any_of(mesh.fans.begin(), mesh.fans.end(), [&](const PoleFan& f) { return &f != this && f.touches(mesh, t); });
        return (edge == 1 || edge == 0 ? way < 0 : way > 0) && !other;
    });
}

bool PoleFan::touches(const PatchMesh& mesh, const PatchTriangle& t) const { return on(mesh.uv[t.corner[0]]) || on(mesh.uv[t.corner[1]]) || on(mesh.uv[t.corner[2]]); }

/// The proof of a triangle of a fan, by its strip; one that is left out has nothing of its own.
TriangleBound Refinement::bound_strip(const PatchMesh& mesh, std::uint32_t member, const PoleFan& fan, const PatchTriangle& t) const {
    TriangleBound proof;
    proof.turn = t.proof.turn, proof.worst_turn = t.proof.worst_turn;
    const int k = fan.apex(mesh, t);
    if (k < 0) {
        proof.parametric = 0;
        return proof;
    }
    const auto a = std::size_t(k), b = (a + 1) % 3, c = (a + 2) % 3;
    const Patch& patch = surface_[member].patch;
    const Strip s{patch, fan, mesh.uv[t.corner[b]], mesh.uv[t.corner[c]]};
    const Point& pole = positions_[mesh.vertex[t.corner[a]]];
    const double slack = std::max(slack_of(patch, s.at(s.along(s.b)), pole), slack_of(patch, s.at(s.along(s.c)), pole));
    StripBends bends = bends_over(s, 1);
    if (!(bends.bound() + slack <= tolerance_) && bends.bound() <= kNear * tolerance_) {
        const StripBends sharp = bends_over(s, SecondDerivatives::pieces);
        bends.base = std::min(bends.base, sharp.base), bends.side = std::min(bends.side, sharp.side);
    }
    proof.parametric = up(bends.bound() + slack);
    // The base, or one of the sides: what then is the new base has to go the same way.
    proof.worst_edge = int(b);
    if (bends.side > bends.base) {
        const Vec2& apex = mesh.uv[t.corner[a]];
        const auto between = [&](const Vec2& x, const Vec2& from, const Vec2& to) { return (s.along(to) - s.along(x)) * (s.along(x) - s.along(from)) >= 0; };
        const auto middle = [&](const Vec2& p) { return Vec2{0.5 * apex.x + 0.5 * p.x, 0.5 * apex.y + 0.5 * p.y}; };
        const Vec2 first = middle(s.b), second = middle(s.c);
        const bool may_first = between(first, s.b, s.c) && s.along(first) != s.along(s.c), may_second = between(second, s.b, s.c) && s.along(second) != s.along(s.b);
        const bool longer = std::fabs(fan.at - s.across(s.b)) >= std::fabs(fan.at - s.across(s.c));
        if (may_first && (longer || !may_second)) proof.worst_edge = k;
        else if (may_second) proof.worst_edge = int(c);
    }
    proof.worst_across = proof.worst_edge;
    return proof;
}

/// Do the sides of strips, from the base to the collapsed edge, bend by more than the tolerance? By samples, nothing is proved. Then rows across the
/// strips would be needed where triangles that are bounded each for itself need few: the surface is flat around the pole, and its bends are tangential.
bool Refinement::sides_bend(const PatchMesh& mesh, std::uint32_t member, const PoleFan& fan) const {
    const Patch& patch = surface_[member].patch;
    return std::any_of(fan.triangles.begin(), fan.triangles.end(), [&](std::uint32_t i) {
        const PatchTriangle& t = mesh.triangles[i];
        const int k = fan.apex(mesh, t);
        if (k < 0) return false;
        const Vec2 &b = mesh.uv[t.corner[std::size_t(k + 1) % 3]], &c = mesh.uv[t.corner[std::size_t(k + 2) % 3]];
        const Vec2 base{0.5 * b.x + 0.5 * c.x, 0.5 * b.y + 0.5 * c.y};
        const double height = fan.at - (fan.along_u ? base.y : base.x);
        return std::any_of(std::begin(kOfHeight), std::end(kOfHeight), [&](double part) {
            const PointJet x = fan.along_u ? patch.jet(base.x, base.y + part * height) : patch.jet(base.x + part * height, base.y);
            const int p = fan.along_u ? 0 : 2;
            const Point half{x.x.coefficient(p, 2 - p), x.y.coefficient(p, 2 - p), x.z.coefficient(p, 2 - p)};
            return 0.25 * height * height * length(half) > tolerance_;
        });
    });
}

/// The strips of a fan whose triangles are all fresh, where they leave less to be split than triangles that are bounded each for itself; else nothing.
std::vector<TriangleBound> Refinement::better_strips(const PatchMesh& mesh, std::uint32_t member, const PoleFan& fan) const {
    const auto excess = [&](double bound) { return std::max(0.0, bound / tolerance_ - 1); };
    double each = 0;
    for (const auto i : fan.triangles) each += excess(mesh.triangles[i].proof.own(measure_));
    if (each == 0 || sides_bend(mesh, member, fan)) return {};
    std::vector<TriangleBound> strips(fan.triangles.size());
    tbb::parallel_for(std::size_t(0), strips.size(), [&](std::size_t i) { strips[i] = bound_strip(mesh, member, fan, mesh.triangles[fan.triangles[i]]); });
    double all = 0;
    for (std::size_t i = 0; i < strips.size(); ++i) {
        const int apex = fan.apex(mesh, mesh.triangles[fan.triangles[i]]);
        all += excess(strips[i].parametric);
        if (strips[i].parametric > tolerance_ && strips[i].worst_edge != (apex + 1) % 3) return {};  // a side
    }
    return all <= each ? strips : std::vector<TriangleBound>();
}

/// Bounds the fresh triangles of the fans by their strips. A fan that is none any more is given up: its triangles are bounded each for itself.
void Refinement::bound_fans(std::uint32_t member) {
    PatchMesh& mesh = patches_[member];
    if (mesh.fans.empty()) return;
    std::vector<std::uint32_t> fresh(mesh.fresh);
    std::sort(fresh.begin(), fresh.end());
    for (PoleFan& f : mesh.fans) {
        auto& list = f.triangles;
        list.insert(list.end(), fresh.begin(), fresh.end());
        list.erase(std::remove_if(list.begin(), list.end(), [&](std::uint32_t i) { return !f.touches(mesh, mesh.triangles[i]); }), list.end());
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    std::vector<char> good;
    std::vector<std::vector<TriangleBound>> first(mesh.fans.size());  // strips of a fan that is chosen now
    for (PoleFan& f : mesh.fans) {
        auto& strips = first[good.size()];
        const bool graph = f.is_graph(mesh);
        if (graph && !f.settled) strips = better_strips(mesh, member, f);
        good.push_back(graph && (f.settled || !strips.empty()));
        mesh.fan_broken |= f.settled && !good.back();
        f.settled = true;
    }
    for (std::size_t k = 0; k < good.size(); ++k) {
        const PoleFan& f = mesh.fans[k];
        tbb::parallel_for(std::size_t(0), f.triangles.size(), [&](std::size_t i) {
            PatchTriangle& t = mesh.triangles[f.triangles[i]];
            const bool is_fresh = std::binary_search(fresh.begin(), fresh.end(), f.triangles[i]);
            if (good[k] && is_fresh) t.proof = first[k].empty() ? bound_strip(mesh, member, f, t) : first[k][i];
            if (!good[k] && !is_fresh) bound(mesh, member, t);
        });
        if (good[k]) continue;
        for (const auto i : f.triangles) {
            if (!std::binary_search(fresh.begin(), fresh.end(), i)) mesh.fresh.push_back(i);
            for (const auto e : mesh.triangles[i].edge)
                for (const auto beside : mesh.edges[e].side)
                    if (beside != kNone) mesh.settled[beside] = kUnsettled;
        }
    }
    for (std::size_t k = good.size(); k-- > 0;)
        if (!good[k]) mesh.fans.erase(mesh.fans.begin() + std::ptrdiff_t(k));
}

}  // namespace isoparm
