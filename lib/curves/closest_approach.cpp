#include "curves/closest_approach.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

/// Points of the curve with their parameters: equal steps, a few for each of its pieces.
struct Polygon {
    std::vector<double> t;
    std::vector<Point> p;
    explicit Polygon(const Curve& c) {
        const std::size_t steps = std::min<std::size_t>(512, 64 + 4 * c.breaks().size());
        for (std::size_t k = 0; k <= steps; ++k) {
            const double x = double(k) / double(steps);
            t.push_back(k == steps ? c.end() : c.begin() + x * (c.end() - c.begin()));
            p.push_back(c(t.back()));
        }
    }
    std::size_t size() const { return p.size() - 1; }  // sides
};

/// Nearest points of two line segments: fractions along them, and the distance.
Approach between_sides(const Point& a0, const Point& a1, const Point& b0, const Point& b1) {
    const Point a = a1 - a0, b = b1 - b0, r = a0 - b0;
    const double aa = dot(a, a), bb = dot(b, b), ab = dot(a, b), ar = dot(a, r), br = dot(b, r), det = aa * bb - ab * ab;
    const auto clamped = [](double x) { return x >= 0 ? std::min(x, 1.0) : 0; };  // NaN: 0
    double s = det > 1e-12 * aa * bb ? clamped((ab * br - bb * ar) / det) : 0;
    const double t = bb > 0 ? clamped((ab * s + br) / bb) : 0;
    s = aa > 0 ? clamped((ab * t - ar) / aa) : 0;
    return {s, t, length(r + s * a - t * b)};
}

/// Newton's method on |a(s) - b(t)|^2 / 2 inside the domains; a step that does not get nearer is shortened.
Approach refined(const Curve& a, const Curve& b, Approach x) {
    for (int round = 0; round < 60; ++round) {
        Point A[3], B[3];
        a.taylor(x.s, 2, A);
        b.taylor(x.t, 2, B);
        const Point d = A[0] - B[0];
        const double g[2] = {dot(d, A[1]), -dot(d, B[1])};
        const bool held[2] = {(x.s <= a.begin() && g[0] > 0) || (x.s >= a.end() && g[0] < 0), (x.t <= b.begin() && g[1] > 0) || (x.t >= b.end() && g[1] < 0)};
        const double aa = dot(A[1], A[1]), bb = dot(B[1], B[1]), ab = -dot(A[1], B[1]);
        double h00 = aa + 2 * dot(d, A[2]), h11 = bb - 2 * dot(d, B[2]);
        if (!(h00 > 0 && h11 > 0 && h00 * h11 - ab * ab > 1e-10 * h00 * h11)) h00 = aa * 1.0001, h11 = bb * 1.0001;  // no minimum ahead: Gauss-Newton
        double step[2];
        if (held[0] || held[1]) {
            step[0] = held[0] || !(h00 > 0) ? 0 : g[0] / h00;
            step[1] = held[1] || !(h11 > 0) ? 0 : g[1] / h11;
        } else {
            const double det = h00 * h11 - ab * ab;
            if (!(det > 0)) return x;
            step[0] = (h11 * g[0] - ab * g[1]) / det;
            step[1] = (h00 * g[1] - ab * g[0]) / det;
        }
        bool nearer = false;
        for (double f = 1; f > 1e-6 && !nearer; f /= 2) {
            const double s = std::clamp(x.s - f * step[0], a.begin(), a.end()), t = std::clamp(x.t - f * step[1], b.begin(), b.end());
            const double there = distance(a(s), b(t));
            nearer = there < x.distance;
            if (nearer) x = {s, t, there};
        }
        if (!nearer) return x;
    }
    return x;
}

}  // namespace

Approach closest_approach(const Curve& a, const Curve& b) {
    const Polygon p(a), q(b);
    constexpr std::size_t kStarts = 12;
    struct Start {
        std::size_t i, j;
        Approach at;
    };
    std::vector<Start> starts;
    for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t j = 0; j < q.size(); ++j) starts.push_back({i, j, between_sides(p.p[i], p.p[i + 1], q.p[j], q.p[j + 1])});
    std::stable_sort(starts.begin(), starts.end(), [](const Start& x, const Start& y) { return x.at.distance < y.at.distance; });
    std::vector<Start> taken;
    Approach best{a.begin(), b.begin(), distance(a(a.begin()), b(b.begin()))};
    for (const Start& x : starts) {
        const auto beside = [&](const Start& y) { return (x.i > y.i ? x.i - y.i : y.i - x.i) <= 2 && (x.j > y.j ? x.j - y.j : y.j - x.j) <= 2; };
        if (std::any_of(taken.begin(), taken.end(), beside)) continue;
        taken.push_back(x);
        const double s = p.t[x.i] + x.at.s * (p.t[x.i + 1] - p.t[x.i]), t = q.t[x.j] + x.at.t * (q.t[x.j + 1] - q.t[x.j]);
        const Approach found = refined(a, b, {s, t, distance(a(s), b(t))});
        if (found.distance < best.distance) best = found;
        if (taken.size() == kStarts) break;
    }
    return best;
}

}  // namespace isoparm
