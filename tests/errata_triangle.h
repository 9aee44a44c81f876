// errata_triangle.h -- data and comparisons that the tests of docs/errata.md on triangles share. Header only, test code.
#pragma once
#include <gtest/gtest.h>

#include <functional>

#include "curves/bezier.h"
#include "patches/bezier_triangle.h"
#include "samples.h"

namespace isoparm::tests {

inline constexpr double kRounding = 1e-13;
inline const Point kShift{100, 0, 0};

using Surface = std::function<Point(double, double, double)>;  // of barycentric u, v, w
inline Surface surface(const Patch& p) {
    return [p](double u, double v, double) { return p.point(u, v); };
}
/// Largest distance over a grid of the triangle; `inside` leaves out the boundary, where a quotient may be 0/0.
inline double gap(const Surface& a, const Surface& b, bool inside = false) {
    double worst = 0;
    const int n = 12;
    for (int i = inside; i <= n - inside; ++i)
        for (int j = inside; i + j <= n - inside; ++j) {
            const double u = double(i) / n, v = double(j) / n, w = double(n - i - j) / n;
            worst = std::max(worst, distance(a(u, v, w), b(u, v, w)));
        }
    return worst;
}
inline double largest(const std::function<Point(double)>& f) {
    double worst = 0;
    for (double t : {0.0, 0.2, 0.5, 0.7, 1.0}) worst = std::max(worst, length(f(t)));
    return worst;
}

/// A random cubic Bezier triangle, and what the interpolants take from it.
struct Cubic {
    std::vector<Point> b;  // rows b300 b210 b120 b030, b201 b111 b021, b102 b012, b003
    explicit Cubic(int seed) {
        Random r(seed);
        for (int k = 0; k <= 3; ++k)
            for (int j = 0; j <= 3 - k; ++j) b.push_back(r.point({double(3 - k - j), double(j), 2}, 0.5));
    }
    Point A() const { return b[0]; }
    Point B() const { return b[3]; }
    Point C() const { return b[9]; }
    std::array<Curve, 3> edges() const {
        return {make_bezier({b[3], b[6], b[8], b[9]}), make_bezier({b[9], b[7], b[4], b[0]}), make_bezier({b[0], b[1], b[2], b[3]})};
    }
    Patch patch() const { return make_bezier_triangle(3, b); }
    /// Derivative along p e1 + q e2 - (p+q) e3 at (u,v).
    Point slope(double p, double q, double u, double v) const {
        const PointFrame x = patch().frame(u, v);
        const auto coefficient = [&](int i, int j) { return Point{x.x.coefficient(i, j), x.y.coefficient(i, j), x.z.coefficient(i, j)}; };
        return p * coefficient(1, 0) + q * coefficient(0, 1);
    }
    /// D_k: in the direction of the median; quadratic along the edge, so that three values say all.
    std::array<Curve, 3> cross() const {
        const auto along = [&](int k, double t) {
            return k == 0 ? slope(1, -0.5, 0, 1 - t) : k == 1 ? slope(-0.5, 1, t, 0) : slope(-0.5, -0.5, 1 - t, t);
        };
        const auto quadratic = [&](int k) {
            const Point p = along(k, 0), q = along(k, 0.5), r = along(k, 1);
            return make_bezier({p, 2.0 * q - 0.5 * (p + r), r});
        };
        return {quadratic(0), quadratic(1), quadratic(2)};
    }
};

}  // namespace isoparm::tests
