#include "patch.h"

#include <limits>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "error.h"

namespace isoparm {
namespace {

Point first_order(const PointJet& j, int i, int k) { return {j.x.coefficient(i, k), j.y.coefficient(i, k), j.z.coefficient(i, k)}; }

std::optional<Point> if_finite(const Point& p) { return finite(p) ? std::optional<Point>(p) : std::nullopt; }

/// from + t (to - from); at a break where it comes within rounding of one, so that edge_point() inverts edge_breaks().
double along_range(double from, double to, const std::vector<double>& breaks, double t) {
    if (t == 0 || t == 1) return t == 0 ? from : to;
    const double x = std::clamp(from + t * (to - from), from, to), rounding = 4e-16 * (std::fabs(from) + std::fabs(to));
    const auto near = std::lower_bound(breaks.begin(), breaks.end(), x - rounding);
    return near != breaks.end() && *near <= x + rounding ? *near : x;
}

}  // namespace

std::vector<double> Patch::lines_u() const {
    std::vector<double> lines = breaks_u();
    lines.insert(lines.begin(), rect().u0);
    lines.push_back(rect().u1);
    return lines;
}
std::vector<double> Patch::lines_v() const {
    std::vector<double> lines = breaks_v();
    lines.insert(lines.begin(), rect().v0);
    lines.push_back(rect().v1);
    return lines;
}

void Patch::frames(std::span<const double> u, std::span<const double> v, const FrameArrays& out, Isa isa) const {
    bool agree = v.size() == u.size() || v.size() == 1;
    for (const auto* arrays : {&out.position, &out.du, &out.dv})
        for (const auto& a : *arrays) agree = agree && a.size() == u.size();
    if (!agree) throw std::invalid_argument("Patch::frames: v (unless it is one number) and all arrays of the result must have the size of u");
    impl_->frame_arrays(isa, u, v, out);
}

Vec3<Interval> Patch::enclose_point(double u, double v) const {
    // On a break the cells of both sides count: their values agree only up to rounding.
    const auto widened = [](double t, const std::vector<double>& breaks) {
        return std::find(breaks.begin(), breaks.end(), t) == breaks.end() ? Interval(t) : Interval(std::nextafter(t, -HUGE_VAL), std::nextafter(t, HUGE_VAL));
    };
    return enclose_points({widened(u, breaks_u()), widened(v, breaks_v())});
}

Vec2 Patch::edge_point(int k, double t) const {
    if (domain() == Domain::triangle) return k == 0 ? Vec2{0, 1 - t} : k == 1 ? Vec2{t, 0} : Vec2{1 - t, 1 - (1 - t)};
    const Rect r = rect();
    switch (k) {
        case 0: return {along_range(r.u0, r.u1, breaks_u(), t), r.v0};
        case 1: return {r.u1, along_range(r.v0, r.v1, breaks_v(), t)};
        case 2: return {along_range(r.u0, r.u1, breaks_u(), t), r.v1};
        default: return {r.u0, along_range(r.v0, r.v1, breaks_v(), t)};
    }
}

std::string Patch::edge_name(int k) const {
    static const std::array<const char*, 4> quad{"c0", "d1", "c1", "d0"};
    static const std::array<const char*, 3> triangle{"E1", "E2", "E3"};
    return domain() == Domain::quad ? quad[k] : triangle[k];
}

std::vector<double> Patch::edge_breaks(int k) const {
    if (domain() == Domain::triangle) return {};
    const Rect r = rect();
    const bool along_u = k == 0 || k == 2;
    auto list = along_u ? breaks_u() : breaks_v();
    for (auto& t : list) t = along_u ? (t - r.u0) / (r.u1 - r.u0) : (t - r.v0) / (r.v1 - r.v0);
    return list;
}

namespace {

/// Derivatives per width of the domain and per size of the largest of them: free of units, so that thresholds mean the
/// same for every knot vector and every scale.
struct ScaledDerivatives {
    Point u, v, uu, uv, vv;
    double noise;  // rounding errors of these, as they come from coordinates of the size of the position

    ScaledDerivatives(const Patch& patch, const PointJet& jet) {
        const Rect r = patch.rect();
        const double du = r.u1 - r.u0, dv = r.v1 - r.v0;
        u = du * first_order(jet, 1, 0), v = dv * first_order(jet, 0, 1);
        uu = 2 * du * du * first_order(jet, 2, 0), uv = du * dv * first_order(jet, 1, 1), vv = 2 * dv * dv * first_order(jet, 0, 2);
        double size = 0;
        for (const Point* d : {&u, &v, &uu, &uv, &vv})
            for (int axis = 0; axis < 3; ++axis)
                if (std::isfinite((*d)[axis])) size = std::max(size, std::fabs((*d)[axis]));
        if (!(size > 0)) size = 1;
        for (Point* d : {&u, &v, &uu, &uv, &vv}) *d = *d / size;
        const Point p = first_order(jet, 0, 0) / size;
        noise = 64 * 0x1p-52 * (1 + std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}));
    }
    bool regular() const { return length(cross(u, v)) > noise * (length(u) + length(v)); }
};

}  // namespace

std::optional<Point> unit_normal(const Patch& patch, const PointJet& jet, double u, double v) {
    const ScaledDerivatives d(patch, jet);
    if (!finite(d.u) || !finite(d.v)) return patch.singular_normal(u, v);
    if (d.regular()) return normalized(cross(d.u, d.v));
    // S_u x S_v vanishes: the direction in which it leaves 0 when one moves into the domain, if all ways agree.
    const Point nu = cross(d.uu, d.v) + cross(d.u, d.uv), nv = cross(d.uv, d.v) + cross(d.u, d.vv);
    if (!finite(nu) || !finite(nv)) return {};
    std::vector<Vec2> inward;
    if (patch.domain() == Domain::quad) {
        const Rect r = patch.rect();
        const double du = 1e-9 * (r.u1 - r.u0), dv = 1e-9 * (r.v1 - r.v0);
        for (double a : {-1.0, 1.0})
            if (u + a * du >= r.u0 && u + a * du <= r.u1) inward.push_back({a, 0});
        for (double b : {-1.0, 1.0})
            if (v + b * dv >= r.v0 && v + b * dv <= r.v1) inward.push_back({0, b});
    } else {
        for (const Vec2 d : {Vec2{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}}) {
            const double a = u + 1e-9 * d.x, b = v + 1e-9 * d.y;
            if (a >= 0 && b >= 0 && a + b <= 1 + 1e-15) inward.push_back(d);
        }
    }
    std::optional<Point> limit;
    for (const Vec2& way : inward) {
        const Point m = way.x * nu + way.y * nv;
        if (length(m) <= d.noise) continue;
        const Point unit = normalized(m);
        if (limit && length(unit - *limit) > 1e-7) return {};
        limit = limit ? limit : unit;
    }
    return limit;
}

static double largest(const Point& p) { return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}); }

/// Of derivatives with respect to a u and b v, which are the same curvatures.
static void set_curvatures(SurfacePoint& s, double a, double b) {
    const Point du = *s.du / a, dv = *s.dv / b;
    const double E = dot(du, du), F = dot(du, dv), G = dot(dv, dv);
    const double L = dot(*s.duu, *s.normal) / a / a, M = dot(*s.duv, *s.normal) / a / b, N = dot(*s.dvv, *s.normal) / b / b;
    const double area = E * G - F * F;
    s.gaussian = (L * N - M * M) / area;
    s.mean = (E * N - 2 * F * M + G * L) / (2 * area);
}

SurfacePoint evaluate(const Patch& patch, double u, double v) {
    const Rect r = patch.rect();
    const bool inside = patch.domain() == Domain::quad ? u >= r.u0 && u <= r.u1 && v >= r.v0 && v <= r.v1 : u >= 0 && v >= 0 && u + v <= 1 + 4e-16;
    if (!inside)
        throw_input("found (" + to_text(u) + ", " + to_text(v) + "), expected a point of the domain " +
                    (patch.domain() == Domain::quad ? "[" + to_text(r.u0) + ", " + to_text(r.u1) + "] x [" + to_text(r.v0) + ", " + to_text(r.v1) + "]"
                                                    : std::string("u >= 0, v >= 0, u + v <= 1")));
    const PointJet jet = patch.jet(u, v);
    SurfacePoint s;
    s.position = first_order(jet, 0, 0);
    s.du = if_finite(first_order(jet, 1, 0));
    s.dv = if_finite(first_order(jet, 0, 1));
    s.duu = if_finite(2.0 * first_order(jet, 2, 0));
    s.duv = if_finite(first_order(jet, 1, 1));
    s.dvv = if_finite(2.0 * first_order(jet, 0, 2));
    s.normal = unit_normal(patch, jet, u, v);
    if (!s.du || !s.dv || !s.duu || !s.duv || !s.dvv || !s.normal || !ScaledDerivatives(patch, jet).regular()) return s;
    const double a = largest(*s.du), b = largest(*s.dv);
    const bool usual = std::min(a, b) > 1e-60 && std::max(a, b) < 1e60;  // whose fourth powers, and what is taken from them, are doubles
    set_curvatures(s, usual ? 1 : a, usual ? 1 : b);
    if (!std::isfinite(s.gaussian.value_or(0)) || !std::isfinite(s.mean.value_or(0))) s.gaussian.reset(), s.mean.reset();
    return s;
}

}  // namespace isoparm
