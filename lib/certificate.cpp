#include "certificate.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "bound.h"
#include "tessellate.h"

namespace isoparm {
namespace {

using Slide = std::array<Vec2, 2>;

/// An edge of a patch, and where its slide may go: anywhere, or along a line.
struct EdgeSlide {
    std::uint32_t low = 0, high = 0;  // corners; the slide is that from low to high
    bool free = false;
    Box room;                         // that the control points have to stay in
    Slide slide{};
    std::array<std::optional<std::array<std::uint32_t, 2>>, 2> side;  // triangles, and which of their edges it is
};

Vec2 plus(const Vec2& p, const Vec2& w, double s) { return {p.x + s * w.x, p.y + s * w.y}; }
Slide times(const Slide& slide, double s) { return {plus({}, slide[0], s), plus({}, slide[1], s)}; }

/// By how much the parameters q move, anywhere or along a line, when the surface's point comes as near as it can to the target (Gauss and
/// Newton). `line`: 0 where it may go anywhere.
Vec2 shift_to(const Patch& patch, const Vec2& q, const Point& target, const Box& room, const Vec2& line) {
    const bool free = line.x == 0 && line.y == 0;
    const auto inside = [](double x, double way, const Interval& r) { return way == 0 || (x > r.lo && x < r.hi); };
    const auto allowed = [&](const Vec2& w) {
        const Vec2 p = plus(q, w, 1);
        return inside(p.x, w.x, room.u) && inside(p.y, w.y, room.v) && (patch.domain() == Domain::quad || w.x == -w.y || p.x + p.y < 1);
    };
    Vec2 shift;
    double least = distance(patch.point(q.x, q.y), target);
    for (int i = 0; i < 4; ++i) {
        const PointFrame f = patch.frame(q.x + shift.x, q.y + shift.y);
        const Point r = target - Point{f.x.c[0], f.y.c[0], f.z.c[0]}, su{f.x.c[1], f.y.c[1], f.z.c[1]}, sv{f.x.c[2], f.y.c[2], f.z.c[2]};
        Vec2 step;
        if (free) {
            const double E = dot(su, su), F = dot(su, sv), G = dot(sv, sv), det = E * G - F * F, a = dot(su, r), b = dot(sv, r);
            step = {(G * a - F * b) / det, (E * b - F * a) / det};
        } else {
            const Point s = line.x * su + line.y * sv;
            step = plus({}, line, dot(s, r) / dot(s, s));
        }
        const Vec2 next = plus(shift, step, 1);
        if (!std::isfinite(next.x) || !std::isfinite(next.y) || !allowed(next)) break;
        const double there = distance(patch.point(q.x + next.x, q.y + next.y), target);
        if (!(there < least)) break;
        least = there, shift = next;
    }
    return shift;
}

/// The slide that takes two points of the edge to where the surface is nearest to the mesh; a part of it where the control points would
/// leave their room.
void find_slide(const Patch& patch, const std::vector<Point>& points, const CertifiedPatch& p, EdgeSlide& e) {
    const Vec2 &a = p.uv[e.low], &b = p.uv[e.high];
    const Point &x = points[p.vertex[e.low]], &y = points[p.vertex[e.high]];
    const Vec2 line = e.free ? Vec2{} : a.x == b.x ? Vec2{0, 1} : a.y == b.y ? Vec2{1, 0} : Vec2{1, -1};
    const auto shift_at = [&](double s) { return shift_to(patch, plus(plus({}, a, 1 - s), b, s), (1 - s) * x + s * y, e.room, line); };
    const Vec2 first = shift_at(1.0 / 3), second = shift_at(2.0 / 3);
    e.slide = {plus(plus({}, first, 3), second, -1.5), plus(plus({}, second, 3), first, -1.5)};
    const auto fits = [&](double s, const Vec2& w) {
        const Vec2 c = plus(plus(plus({}, a, 1 - s), b, s), w, 1);
        const auto inside = [](double at, double way, const Interval& r) { return way == 0 || (at > r.lo && at < r.hi); };
        return inside(c.x, w.x, e.room.u) && inside(c.y, w.y, e.room.v) && (patch.domain() == Domain::quad || w.x == -w.y || c.x + c.y < 1 - 1e-14);
    };
    for (int i = 0; !(fits(1.0 / 3, e.slide[0]) && fits(2.0 / 3, e.slide[1])); ++i) e.slide = i < 8 ? times(e.slide, 0.5) : Slide{};
}

Interval cell_between(const std::vector<double>& lines, double low) {
    const auto above = std::upper_bound(lines.begin() + 1, lines.end() - 1, low);
    return {*(above - 1), *above};
}

/// The largest distance of the surface's points from the triangle's, as sampled.
double sampled_distance(const Patch& patch, const std::vector<Point>& points, const CertifiedPatch& p, const CertifiedTriangle& t) {
    double most = 0;
    each_sample(p, t, [&](const Vec2& q, const std::array<double, 3>& l) {
        Point x;
        for (int k = 0; k < 3; ++k) x += l[k] * points[p.vertex[t.corner[k]]];
        most = std::max(most, distance(patch.point(q.x, q.y), x));
    });
    return most;
}

/// One patch while its slides are sought; those of an edge are the same in both triangles beside it.
class Slides {
public:
    Slides(const Patch& patch, const std::vector<Point>& points, CertifiedPatch& p) : patch_(patch), points_(points), p_(p), edge_of_(p.triangles.size()) { collect(); }

    void find() {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, edges_.size(), 64), [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) find_slide(patch_, points_, p_, edges_[i]);
        });
        for (std::uint32_t e = 0; e < edges_.size(); ++e) set(e, edges_[e].slide);
    }

    /// Slides less where a triangle would be farther than `limit`, as sampled; then claims no less than samples show, with a little room, and `room` for rounding.
    void settle(double limit, double room) {
        for (int pass = 0; pass < 3; ++pass) {
            const std::vector<double> far = distances();
            bool any = false;
            for (std::size_t i = 0; i < far.size(); ++i)
                if (far[i] > kClose * limit) any = slide_less(std::uint32_t(i)) || any;
            if (!any) break;
        }
        const std::vector<double> far = distances();
        for (std::size_t i = 0; i < far.size(); ++i) p_.triangles[i].bound = std::max(p_.triangles[i].bound, std::min(limit, kRoom * far[i] + room));
    }

private:
    static constexpr double kClose = 0.9, kRoom = 1.1;

    void collect() {
        const std::vector<double> us = patch_.lines_u(), vs = patch_.lines_v();
        std::unordered_map<std::uint64_t, std::uint32_t> number;
        for (std::uint32_t i = 0; i < p_.triangles.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                const auto& corner = p_.triangles[i].corner;
                const std::uint32_t low = std::min(corner[k], corner[(k + 1) % 3]), high = std::max(corner[k], corner[(k + 1) % 3]);
                const auto [found, fresh] = number.try_emplace((std::uint64_t(low) << 32) | high, std::uint32_t(edges_.size()));
                const Vec2 &a = p_.uv[corner[0]], &b = p_.uv[corner[1]], &c = p_.uv[corner[2]];
                const Box cell{cell_between(us, std::min({a.x, b.x, c.x})), cell_between(vs, std::min({a.y, b.y, c.y}))};
                if (fresh) edges_.push_back({low, high, false, cell, {}, {}});
                EdgeSlide& e = edges_[found->second];
                if (!fresh) e.free = !along_line(p_.uv[low], p_.uv[high], us, vs), e.room = {intersection(e.room.u, cell.u), intersection(e.room.v, cell.v)};
                e.side[fresh ? 0 : 1] = {i, std::uint32_t(k)};
                edge_of_[i][k] = found->second;
            }
    }

    void set(std::uint32_t edge, const Slide& slide) {
        edges_[edge].slide = slide;
        for (const auto& side : edges_[edge].side) {
            if (!side) continue;
            CertifiedTriangle& t = p_.triangles[(*side)[0]];
            t.slide[(*side)[1]] = t.corner[(*side)[1]] == edges_[edge].low ? slide : Slide{slide[1], slide[0]};
        }
    }

    /// Of the triangles beside an edge.
    double farthest(std::uint32_t edge) const {
        double most = 0;
        for (const auto& side : edges_[edge].side)
            if (side) most = std::max(most, sampled_distance(patch_, points_, p_, p_.triangles[(*side)[0]]));
        return most;
    }

    bool slide_less(std::uint32_t triangle) {
        bool better = false;
        for (const std::uint32_t e : edge_of_[triangle]) {
            const Slide whole = edges_[e].slide;
            double best = 1, least = farthest(e);
            for (const double part : {0.7, 0.4, 0.0}) {
                set(e, times(whole, part));
                const double far = farthest(e);
                if (far < least) least = far, best = part;
            }
            set(e, times(whole, best));
            better = better || best < 1;
        }
        return better;
    }

    std::vector<double> distances() const {
        std::vector<double> far(p_.triangles.size());
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, far.size(), 64), [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) far[i] = sampled_distance(patch_, points_, p_, p_.triangles[i]);
        });
        return far;
    }

    const Patch& patch_;
    const std::vector<Point>& points_;
    CertifiedPatch& p_;
    std::vector<EdgeSlide> edges_;
    std::vector<std::array<std::uint32_t, 3>> edge_of_;
};

/// Room for the rounding of the checker, which is another one than that of the bounds.
double room_of(const std::vector<Point>& points) {
    double most = 0;
    for (const Point& p : points) most = std::max({most, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    return 128 * 0x1p-52 * most;
}

}  // namespace

double sampled_distance(const Composite& surface, const Certificate& c) {
    double most = 0;
    for (std::size_t m = 0; m < c.patches.size(); ++m)
        for (const CertifiedTriangle& t : c.patches[m].triangles) most = std::max(most, sampled_distance(surface[m].patch, c.points, c.patches[m], t));
    return most;
}

Certificate make_certificate(const Composite& surface, const Tessellation& t, bool slide) {
    Certificate all;
    const double room = room_of(t.mesh.positions);
    const auto with_room = [&](double bound) { return std::max(bound, std::min(bound + room, t.tolerance)); };
    all.tolerance = t.tolerance, all.certified_error = with_room(t.certified_error);
    all.points = t.mesh.positions;
    for (std::size_t m = 0; m < surface.size(); ++m) {
        const MeshPart& part = t.mesh.parts[m];
        CertifiedPatch p;
        p.name = part.name, p.uv = part.uv, p.vertex = part.vertex;
        for (const auto& corners : part.triangles) {
            p.triangles.push_back({corners, {}, with_room(part.bounds[p.triangles.size()])});
            if (part.flipped) std::swap(p.triangles.back().corner[1], p.triangles.back().corner[2]);
        }
        for (const auto& corners : part.left_out) p.triangles.push_back({corners, {}, with_room(part.bounds[p.triangles.size()])});
        if (slide) {
            Slides slides(surface[m].patch, all.points, p);
            slides.find();
            slides.settle(all.certified_error, 16 * room);
        }
        all.patches.push_back(std::move(p));
    }
    return all;
}

}  // namespace isoparm
