#include "composite.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace isoparm {
namespace {

constexpr double kHuge = std::numeric_limits<double>::infinity();

Bounds nothing() { return {{kHuge, kHuge, kHuge}, {-kHuge, -kHuge, -kHuge}}; }

/// Climbs from (u,v) to a local maximum of `height` over the domain by a shrinking pattern of steps.
Vec2 climb(const Patch& patch, Vec2 at, double du, double dv, const std::function<double(const Point&)>& height) {
    const Rect r = patch.rect();
    const bool triangle = patch.domain() == Domain::triangle;
    double best = height(patch.point(at.x, at.y));
    constexpr int ways = 6;
    static constexpr double way_u[ways] = {1, -1, 0, 0, 1, -1}, way_v[ways] = {0, 0, 1, -1, -1, 1};
    for (double step = 1; step > 1e-6;) {
        bool better = false;
        for (int first = 0; first < ways;) {  // all that are left from here at once, as mostly none is higher
            double u[ways], v[ways];
            Point x[ways];
            for (int k = first; k < ways; ++k)
                u[k] = std::clamp(at.x + step * du * way_u[k], r.u0, r.u1), v[k] = std::clamp(at.y + step * dv * way_v[k], r.v0, r.v1);
            const auto outside = [&](int k) { return triangle && u[k] + v[k] > 1; };
            for (int k = first; k < ways; ++k)
                if (outside(k)) u[k] = at.x, v[k] = at.y;
            patch.points(std::size_t(ways - first), u + first, v + first, x + first);
            for (; first < ways; ++first) {
                const double h = height(x[first]);
                if (!(h > best)) continue;
                best = h, at = {u[first], v[first]}, better = true;
                ++first;
                break;
            }
        }
        if (!better) step *= 0.5;
    }
    return at;
}

void add(Bounds& box, const Point& p) {
    for (int axis = 0; axis < 3; ++axis) box.low[axis] = std::min(box.low[axis], p[axis]), box.high[axis] = std::max(box.high[axis], p[axis]);
}

void add(Bounds& box, const Patch& patch) {
    const Rect r = patch.rect();
    const std::size_t nu = 16 * (patch.breaks_u().size() + 1), nv = 16 * (patch.breaks_v().size() + 1);
    const double du = (r.u1 - r.u0) / nu, dv = (r.v1 - r.v0) / nv;
    std::vector<double> u, v;
    for (std::size_t i = 0; i <= nu; ++i)
        for (std::size_t j = 0; j <= (patch.domain() == Domain::triangle ? nu - i : nv); ++j) {
            u.push_back(i == nu ? r.u1 : r.u0 + du * i);
            v.push_back(j == nv ? r.v1 : r.v0 + dv * j);
        }
    std::vector<Point> x(u.size());
    patch.points(u.size(), u.data(), v.data(), x.data());
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            std::size_t top = 0;
            for (std::size_t i = 1; i < x.size(); ++i)
                if (sign * x[i][axis] > sign * x[top][axis]) top = i;
            const Vec2 at = climb(patch, {u[top], v[top]}, du, dv, [&](const Point& p) { return sign * p[axis]; });
            add(box, patch.point(at.x, at.y));
        }
}

}  // namespace

Bounds united(const Bounds& a, const Bounds& b) {
    Bounds r = a;
    add(r, b.low);
    add(r, b.high);
    return r;
}

Bounds bounding_box(const Composite& surface) {
    Bounds box = nothing();
    for (const auto& member : surface) add(box, member.patch);
    return box;
}

Bounds bounding_box(const Curve& curve) {
    constexpr int n = 64;
    Bounds box = nothing();
    const double step = (curve.end() - curve.begin()) / n;
    for (int i = 0; i <= n; ++i) add(box, curve(i == n ? curve.end() : curve.begin() + step * i));
    for (int axis = 0; axis < 3; ++axis)
        for (const bool up : {false, true}) {  // golden section would do; the pattern of climb() in one dimension is as short
            double t = curve.begin(), best = -kHuge;
            const auto height = [&](double s) { return (up ? 1 : -1) * curve(s)[axis]; };
            for (int i = 0; i <= n; ++i) {
                const double s = i == n ? curve.end() : curve.begin() + step * i;
                if (height(s) > best) best = height(s), t = s;
            }
            for (double h = step; h > 1e-6 * step;) {
                const double left = std::max(curve.begin(), t - h), right = std::min(curve.end(), t + h);
                if (height(left) > best) best = height(left), t = left;
                else if (height(right) > best) best = height(right), t = right;
                else h *= 0.5;
            }
            add(box, curve(t));
        }
    return box;
}

}  // namespace isoparm
