#include "composite.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
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

/// The highest of a grid of samples of a patch along an axis, up or down.
struct Top {
    Vec2 at;
    double height = -kHuge, step = 0;  // step: the largest difference between neighbours on the grid
};

struct Tops {
    double du = 0, dv = 0;        // of the grid
    std::array<Top, 6> top;       // x, -x, y, -y, z, -z
    static double height(std::size_t way, const Point& p) { return way % 2 ? -p[int(way / 2)] : p[int(way / 2)]; }

    Tops() = default;
    explicit Tops(const Patch& patch) {
        const Rect r = patch.rect();
        const std::size_t nu = 16 * (patch.breaks_u().size() + 1), nv = 16 * (patch.breaks_v().size() + 1);
        du = (r.u1 - r.u0) / nu, dv = (r.v1 - r.v0) / nv;
        std::vector<double> u, v;
        std::vector<std::size_t> before;  // the neighbour at smaller u
        std::size_t last = 0;
        for (std::size_t i = 0; i <= nu; ++i) {
            const std::size_t first = u.size();
            for (std::size_t j = 0; j <= (patch.domain() == Domain::triangle ? nu - i : nv); ++j) {
                u.push_back(i == nu ? r.u1 : r.u0 + du * i);
                v.push_back(j == nv ? r.v1 : r.v0 + dv * j);
                before.push_back(i > 0 ? last + j : first);
            }
            last = first;
        }
        std::vector<Point> x(u.size());
        patch.points(u.size(), u.data(), v.data(), x.data());
        for (std::size_t way = 0; way < top.size(); ++way)
            for (std::size_t i = 0; i < x.size(); ++i) {
                const double h = height(way, x[i]), step = std::max(std::fabs(h - height(way, x[before[i]])), i > 0 && u[i - 1] == u[i] ? std::fabs(h - height(way, x[i - 1])) : 0);
                top[way].step = std::max(top[way].step, step);
                if (h > top[way].height) top[way].height = h, top[way].at = {u[i], v[i]};
            }
    }
};

}  // namespace

Bounds united(const Bounds& a, const Bounds& b) {
    Bounds r = a;
    add(r, b.low);
    add(r, b.high);
    return r;
}

Bounds bounding_box(const Composite& surface) {
    Bounds box = nothing();
    std::vector<Tops> tops(surface.size());
    tbb::parallel_for(std::size_t(0), surface.size(), [&](std::size_t m) { tops[m] = Tops(surface[m].patch); });
    std::array<double, 6> highest;
    highest.fill(-kHuge);
    for (const Tops& t : tops)
        for (std::size_t way = 0; way < 6; ++way) highest[way] = std::max(highest[way], t.top[way].height);
    // Only from near the highest samples of all.
    for (std::size_t m = 0; m < surface.size(); ++m)
        for (std::size_t way = 0; way < 6; ++way) {
            const Top& top = tops[m].top[way];
            if (top.height + top.step < highest[way]) continue;
            const Vec2 at = climb(surface[m].patch, top.at, tops[m].du, tops[m].dv, [&](const Point& p) { return Tops::height(way, p); });
            add(box, surface[m].patch.point(at.x, at.y));
        }
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
