#include "curves/interpolate.h"

#include "curves/hermite.h"
#include "curves/piecewise_bezier.h"
#include "error.h"

namespace isoparm {
namespace {

/// Tangents of the C2 spline: m[i-1] + 4 m[i] + m[i+1] = 3 (p[i+1] - p[i-1]) inside, `first` and `last` rows at the ends.
std::vector<Point> c2_tangents(const std::vector<Point>& p, bool natural) {
    const std::size_t n = p.size() - 1;
    std::vector<double> below(n + 1, 1), diagonal(n + 1, 4), above(n + 1, 1);
    std::vector<Point> m(n + 1);
    for (std::size_t i = 1; i < n; ++i) m[i] = 3.0 * (p[i + 1] - p[i - 1]);
    if (natural) {  // 2 m0 + m1 = 3 (p1 - p0)
        diagonal[0] = diagonal[n] = 2;
        m[0] = 3.0 * (p[1] - p[0]);
        m[n] = 3.0 * (p[n] - p[n - 1]);
    } else {  // Bessel: the parabola through three points
        diagonal[0] = diagonal[n] = 1;
        above[0] = below[n] = 0;
        m[0] = n == 1 ? p[1] - p[0] : -1.5 * p[0] + 2.0 * p[1] - 0.5 * p[2];
        m[n] = n == 1 ? p[1] - p[0] : 1.5 * p[n] - 2.0 * p[n - 1] + 0.5 * p[n - 2];
    }
    for (std::size_t i = 1; i <= n; ++i) {  // Thomas
        const double f = below[i] / diagonal[i - 1];
        diagonal[i] -= f * above[i - 1];
        m[i] = m[i] - f * m[i - 1];
    }
    m[n] = m[n] / diagonal[n];
    for (std::size_t i = n; i-- > 0;) m[i] = (m[i] - above[i] * m[i + 1]) / diagonal[i];
    return m;
}

std::vector<Point> catmull_rom_tangents(const std::vector<Point>& p) {
    const std::size_t n = p.size() - 1;
    std::vector<Point> m(n + 1);
    if (n == 1) return {p[1] - p[0], p[1] - p[0]};
    for (std::size_t i = 1; i < n; ++i) m[i] = 0.5 * (p[i + 1] - p[i - 1]);
    m[0] = 2.0 * (p[1] - p[0]) - m[1];
    m[n] = 2.0 * (p[n] - p[n - 1]) - m[n - 1];
    return m;
}

}  // namespace

Curve make_interpolate(const std::vector<Point>& points, SplineEnds ends) {
    if (points.size() < 2) throw_input("found " + std::to_string(points.size()) + " points, expected at least two");
    if (ends == SplineEnds::catmull_rom) return make_hermite(points, catmull_rom_tangents(points));
    const Curve spline = make_hermite(points, c2_tangents(points, ends == SplineEnds::natural));
    return make_piecewise_bezier(spline.bezier()->pieces(), std::vector<int>(points.size() - 2, 2));
}

}  // namespace isoparm
