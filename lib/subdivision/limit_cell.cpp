#include "subdivision/limit_cell.h"

#include <cmath>
#include <limits>

#include "curves/bezier.h"
#include "curves/lane_by_lane.h"
#include "error.h"
#include "patches/bbg.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/nielson.h"
#include "patches/side_vertex.h"
#include "patches/three_curves.h"

namespace isoparm {
namespace {

Vec2 operator+(const Vec2& a, const Vec2& b) { return {a.x + b.x, a.y + b.y}; }
Vec2 operator-(const Vec2& a, const Vec2& b) { return {a.x - b.x, a.y - b.y}; }
Vec2 operator*(double k, const Vec2& a) { return {k * a.x, k * a.y}; }

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Vec2 corner_of(Domain domain, int k) {
    static constexpr double quad[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, triangle[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    const auto& c = domain == Domain::quad ? quad[k] : triangle[k];
    return {c[0], c[1]};
}
bool is_corner(Domain domain, int k, double s, double t) {
    const Vec2 c = corner_of(domain, k);
    return c.x == s && c.y == t;
}
Point along(const LimitFrame& x, const Vec2& d) { return d.x == 0 ? d.y * x.dv : d.y == 0 ? d.x * x.du : d.x * x.du + d.y * x.dv; }

/// The curve of a cell along a line. Beyond positions and first derivatives nothing is known, nor over intervals: surfaces on it are measured, not certified.
class CellCurve final : public Curve::Concept {
public:
    CellCurve(LimitCell cell, const Vec2& from, const Vec2& to) : cell_(std::move(cell)), from_(from), to_(to) {}
    double begin() const override { return 0; }
    double end() const override { return 1; }
    void taylor(double t, int order, Vec3<double>* out) const override {
        const LimitFrame x = cell_((1 - t) * from_.x + t * to_.x, (1 - t) * from_.y + t * to_.y);
        out[0] = x.p;
        if (order > 0) out[1] = along(x, to_ - from_);
        for (int k = 2; k <= order; ++k) out[k] = {kNaN, kNaN, kNaN};
    }
    void taylor(const Pack& t, int order, Vec3<Pack>* out) const override { lane_by_lane(*this, t, order, out); }
    void taylor(const Interval&, int order, Vec3<Interval>* out) const override {
        for (int k = 0; k <= order; ++k) out[k] = {Interval::all(), Interval::all(), Interval::all()};
    }

private:
    LimitCell cell_;
    Vec2 from_, to_;
};

Curve bezier(std::vector<Point> points) { return make_bezier(std::move(points)); }
Curve cubic_between(const Point& x0, const Point& d0, const Point& d1, const Point& x1) { return bezier({x0, x0 + d0 / 3.0, x1 - d1 / 3.0, x1}); }
/// Values at 0, 1/4, 3/4, 1.
Curve cubic_through(const Point& x0, const Point& x1, const Point& x2, const Point& x3) {
    return bezier({x0, (-10.0 * x0 + 24.0 * x1 - 8.0 * x2 + 3.0 * x3) / 9.0, (3.0 * x0 - 8.0 * x1 + 24.0 * x2 - 10.0 * x3) / 9.0, x3});
}

/// What a cell shows along a side: f of the frames there, at 0, 1/4, 3/4, 1.
template <class F> Curve across(const LimitCell& cell, const Vec2& from, const Vec2& to, const F& f) {
    const auto at = [&](double t) { return f(cell((1 - t) * from.x + t * to.x, (1 - t) * from.y + t * to.y)); };
    return cubic_through(at(0), at(0.25), at(0.75), at(1));
}
Point du(const LimitFrame& x) { return x.du; }
Point dv(const LimitFrame& x) { return x.dv; }

Patch coons(const LimitCell& c) { return make_coons({c.curve({0, 0}, {1, 0}), c.curve({0, 1}, {1, 1}), c.curve({0, 0}, {0, 1}), c.curve({1, 0}, {1, 1})}); }

Patch gregory(const LimitCell& c) {
    HermiteData data{{bezier({Point()}), across(c, {0, 0}, {0, 1}, du), across(c, {1, 0}, {1, 1}, du), bezier({Point()})},
                     {bezier({Point()}), across(c, {0, 0}, {1, 0}, dv), across(c, {0, 1}, {1, 1}, dv), bezier({Point()})}};
    for (const int k : {0, 1}) {
        const LimitFrame a = c(k, 0), b = c(k, 1), d = c(0, k), e = c(1, k);
        data.f[3 * k] = cubic_between(a.p, a.dv, b.dv, b.p);
        data.g[3 * k] = cubic_between(d.p, d.du, e.du, e.p);
    }
    return make_coons_hermite(data, Twist::gregory);
}

// A is at (1,0), B at (0,1), C at (0,0): so the triangle's (u,v) is the cell's (s,t).
constexpr double kVertex[3][2] = {{1, 0}, {0, 1}, {0, 0}};
Vec2 vertex(int k) { return {kVertex[k % 3][0], kVertex[k % 3][1]}; }

using Edges = std::array<Curve, 3>;
Edges own_curves(const LimitCell& c) { return {c.curve(vertex(1), vertex(2)), c.curve(vertex(2), vertex(0)), c.curve(vertex(0), vertex(1))}; }

/// The quartic with the ends of the limit, its derivatives there and its middle.
Curve quartic(const LimitCell& c, const Vec2& from, const Vec2& to) {
    const LimitFrame a = c(from.x, from.y), b = c(to.x, to.y);
    const Point m = c(0.5 * (from.x + to.x), 0.5 * (from.y + to.y)).p, p1 = a.p + along(a, to - from) / 4.0, p3 = b.p - along(b, to - from) / 4.0;
    return bezier({a.p, p1, (16.0 * m - a.p - 4.0 * p1 - 4.0 * p3 - b.p) / 6.0, p3, b.p});
}
Edges quartics(const LimitCell& c) { return {quartic(c, vertex(1), vertex(2)), quartic(c, vertex(2), vertex(0)), quartic(c, vertex(0), vertex(1))}; }
Curve median(const LimitCell& c, int k) {
    const Vec2 from = vertex(k + 1), to = vertex(k + 2), d = vertex(k) - 0.5 * (from + to);
    return across(c, from, to, [&](const LimitFrame& x) { return along(x, d); });
}
Edges medians(const LimitCell& c) { return {median(c, 0), median(c, 1), median(c, 2)}; }

Patch side_vertex(const LimitCell& c) { return make_side_vertex(own_curves(c), Function::polynomial({0, 0, 1})); }
Patch nielson(const LimitCell& c) { return make_nielson_c1(quartics(c), medians(c)); }
Patch bbg_c1(const LimitCell& c) { return make_bbg_c1(quartics(c), medians(c)); }
Patch side_vertex_quadratic(const LimitCell& c) { return make_side_vertex(quartics(c), Function::polynomial({0, 0, 1})); }
Patch side_vertex_linear(const LimitCell& c) { return make_side_vertex(quartics(c), Function::polynomial({0, 1})); }
Patch bbg_symmetric(const LimitCell& c) { return make_bbg(quartics(c), {BbgForm::Kind::symmetric}); }
Patch bbg_convex(const LimitCell& c) { return make_bbg(quartics(c), {BbgForm::Kind::convex}); }
Patch three_curves(const LimitCell& c) { return make_three_curves(quartics(c)); }

}  // namespace

LimitFunction limit_function(const Patch& patch) {
    return [patch](double u, double v) {
        const PointFrame f = patch.frame(u, v);
        const auto part = [&](int k) { return Point(f.x.c[k], f.y.c[k], f.z.c[k]); };
        return LimitFrame{part(0), part(1), part(2)};
    };
}

LimitCell::LimitCell(Domain domain, LimitFunction limit) : domain_(domain), limit_(std::move(limit)) {}

LimitCell::LimitCell(Domain domain, LimitFunction limit, int corner, double h, const FaceTangents& tangents) : LimitCell(domain, std::move(limit)) {
    corner_ = corner, whole_ = h == 1;
    const int n = corners();
    origin_ = corner_of(domain, corner);
    s_ = h * (corner_of(domain, (corner + 1) % n) - origin_);
    t_ = h * (corner_of(domain, (corner + n - 1) % n) - origin_);
    base_ = limit_(origin_.x, origin_.y).p;
    for (int k = 0; k < n; ++k) at_corners_[k] = corner_frame(k, tangents);
}

LimitCell LimitCell::part(const Vec2& origin, const Vec2& s_end, const Vec2& t_end) const {
    LimitCell cell(domain_, limit_);
    const auto image = [&](const Vec2& x) { return origin_ + x.x * s_ + x.y * t_; };
    cell.origin_ = image(origin), cell.s_ = image(s_end) - cell.origin_, cell.t_ = image(t_end) - cell.origin_;
    cell.base_ = limit_(cell.origin_.x, cell.origin_.y).p;
    for (int k = 0; k < corners(); ++k) cell.at_corners_[k] = cell.corner_frame(k, {});
    return cell;
}

LimitFrame LimitCell::natural(double s, double t) const {
    const Vec2 at = origin_ + s * s_ + t * t_;
    const LimitFrame x = limit_(at.x, at.y);
    return {x.p - base_, along(x, s_), along(x, t_)};
}

LimitFrame LimitCell::operator()(double s, double t) const {
    for (int k = 0; k < corners(); ++k)
        if (is_corner(domain_, k, s, t)) return at_corners_[k];
    return natural(s, t);
}

bool LimitCell::complete() const {
    for (int k = 0; k < corners(); ++k)
        if (!finite(at_corners_[k].du) || !finite(at_corners_[k].dv)) return false;
    return true;
}

/// The derivative at one corner along the side to another.
Point LimitCell::side(int from, int to, const FaceTangents& tangents) const {
    const Vec2 a = corner_of(domain_, from), d = corner_of(domain_, to) - a;
    const auto at = [&](double x) { return natural(a.x + x * d.x, a.y + x * d.y); };
    const LimitFrame start = at(0), end = at(1);
    if (const Point own = along(start, d); finite(own)) return own;
    const int n = corners();
    const auto& known = tangents[(corner_ + from) % n];
    if (!known || (from != 0 && !whole_)) return {kNaN, kNaN, kNaN};
    const Point unit = normalized(to == (from + 1) % n ? known->next : known->previous);
    const auto length = [&](const LimitFrame& middle, const LimitFrame& far, double part) {
        return dot(unit, 8.0 * (middle.p - 0.5 * (start.p + far.p)) + part * along(far, d));
    };
    const double whole = length(at(0.5), end, 1);
    return (std::isfinite(whole) ? whole : 2 * length(at(0.25), at(0.5), 0.5)) * unit;
}

LimitFrame LimitCell::corner_frame(int k, const FaceTangents& tangents) const {
    const int n = corners(), next = (k + 1) % n, previous = (k + n - 1) % n;
    const Vec2 at = corner_of(domain_, k), a = corner_of(domain_, next) - at, b = corner_of(domain_, previous) - at;
    const Point x = side(k, next, tangents), y = side(k, previous, tangents);
    const double det = a.x * b.y - a.y * b.x;  // 1
    return {natural(at.x, at.y).p, (b.y * x - a.y * y) / det, (a.x * y - b.x * x) / det};
}

Curve LimitCell::curve(const Vec2& from, const Vec2& to) const { return Curve(std::make_shared<CellCurve>(*this, from, to)); }

std::optional<Patch> LimitMethod::on(const LimitCell& cell) const {
    try {
        return make(cell);
    } catch (const IncompatibleError&) {
        return {};
    }
}

const std::vector<LimitMethod>& quad_methods() {
    static const std::vector<LimitMethod> methods{{"coons", coons, 4}, {"gregory", gregory, 8}};
    return methods;
}
const std::vector<LimitMethod>& triangle_methods() {
    static const std::vector<LimitMethod> methods{{"side_vertex", side_vertex, 3}, {"nielson_c1", nielson, 4}};
    return methods;
}
const std::vector<LimitMethod>& regular_triangle_methods() {
    static const std::vector<LimitMethod> methods{{"nielson_c1", nielson, 4}, {"bbg_c1", bbg_c1, 4}, {"side_vertex_t2", side_vertex_quadratic, 3}, {"bbg_symmetric", bbg_symmetric, 3},
                                                  {"side_vertex_t", side_vertex_linear, 2}, {"bbg_convex", bbg_convex, 2}, {"three_curves", three_curves, 2}};
    return methods;
}

}  // namespace isoparm
