// spline_laws_test.cpp -- B-splines against de Boor's recurrence, the conditions that define the interpolating splines,
// and arcs on their circles.
#include <gtest/gtest.h>

#include "curves/arc.h"
#include "curves/bezier.h"
#include "curves/bspline.h"
#include "curves/hermite.h"
#include "curves/interpolate.h"
#include "curves/modify.h"
#include "curves/piecewise_bezier.h"
#include "patches/tensor_bezier.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

/// N_i,p(t) by the definition (Piegl and Tiller 1997, 2.5), the last span closed.
double basis(const std::vector<double>& k, int i, int p, double t) {
    if (p == 0) return (k[i] <= t && t < k[i + 1]) || (t == k.back() && k[i] < t && t == k[i + 1]) ? 1 : 0;
    const double a = k[i + p] > k[i] ? (t - k[i]) / (k[i + p] - k[i]) * basis(k, i, p - 1, t) : 0;
    const double b =
        k[i + p + 1] > k[i + 1] ? (k[i + p + 1] - t) / (k[i + p + 1] - k[i + 1]) * basis(k, i + 1, p - 1, t) : 0;
    return a + b;
}

struct Knots {
    int degree;
    std::vector<double> knots;
    int points() const { return int(knots.size()) - degree - 1; }
};
const std::vector<Knots> kKnots{
    {1, {0, 0, 1, 3, 3}},
    {2, {0, 0, 0, 1, 1, 1}},
    {2, {0, 0, 0, 1, 1, 2, 2, 2}},
    {3, {0, 0, 0, 0, 0.3, 0.35, 1, 2, 2, 2, 2}},
    {3, {-1, -1, -1, -1, 0, 0, 1, 1, 1, 4, 4, 4, 4}},
    {3, {0, 1, 2, 3, 4, 5, 6, 7, 8}},
    {5, {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2.5, 3, 3, 3, 3, 3, 3}},
    {2, {0, 0.5, 0.7, 1, 1.5, 1.5, 1.9, 2.2, 3}},
};

TEST(BSpline, AgreesWithTheRecurrence) {
    for (std::size_t n = 0; n < kKnots.size(); ++n)
        for (bool rational : {false, true}) {
            SCOPED_TRACE("knot vector " + std::to_string(n) + ", seed " + std::to_string(n + 1));
            Random r(n + 1);
            const auto& [p, k] = kKnots[n];
            std::vector<Point> points;
            std::vector<double> weights;
            for (int i = 0; i < kKnots[n].points(); ++i)
                points.push_back(r.point()), weights.push_back(rational ? r.number(0.5, 2) : 1);
            const Curve c = make_bspline(p, k, points, rational ? weights : std::vector<double>{});
            EXPECT_EQ(c.begin(), k[p]);
            EXPECT_EQ(c.end(), k[points.size()]);
            for (int s = 0; s <= 50; ++s) {
                const double t = s == 50 ? std::nextafter(c.end(), 0) : c.begin() + (c.end() - c.begin()) * s / 50;
                Point sum;
                double total = 0;
                for (std::size_t i = 0; i < points.size(); ++i) {
                    const double b = weights[i] * basis(k, int(i), p, t);
                    sum += b * points[i];
                    total += b;
                }
                EXPECT_LE(distance(c(t), sum / total), 1e-14) << t;
            }
        }
}

TEST(BSpline, KnotsOfMultiplicityMLeaveDegreeMinusMDerivatives) {
    for (const auto& [p, k] : kKnots) {
        Random r(3);
        std::vector<Point> points;
        for (std::size_t i = 0; i + p + 1 < k.size(); ++i) points.push_back(r.point());
        const Curve c = make_bspline(p, k, points);
        std::size_t at = 0;
        const auto breaks = c.breaks();
        for (std::size_t i = 0; i < k.size(); ++i) {
            if (!(k[i] > c.begin() && k[i] < c.end()) || (i > 0 && k[i] == k[i - 1])) continue;
            const int multiplicity = int(std::count(k.begin(), k.end(), k[i]));
            ASSERT_LT(at, breaks.size());
            EXPECT_EQ(breaks[at].t, k[i]);
            EXPECT_EQ(breaks[at].continuity, p - multiplicity);
            Point low[4], high[4];
            c.taylor(std::nextafter(k[i], c.begin()), 3, low), c.taylor(k[i], 3, high);
            for (int d = 0; d <= std::min(3, p - multiplicity); ++d)
                EXPECT_LE(distance(low[d], high[d]), 1e-11 * (1 + length(high[d])));
            if (p - multiplicity < 3) {
                EXPECT_GE(distance(low[p - multiplicity + 1], high[p - multiplicity + 1]), 1e-3)
                    << "random data should jump there";
            }
            ++at;
        }
        EXPECT_EQ(at, breaks.size());
    }
}

TEST(BSpline, PatchAgreesWithTheRecurrence) {
    Random r(4);
    for (const auto& a : {kKnots[3], kKnots[2], kKnots[7]})
        for (const auto& b : {kKnots[1], kKnots[4]}) {
            const auto net = random_net(r, a.points(), b.points());
            Grid<double> w(a.points(), std::vector<double>(b.points()));
            for (auto& row : w)
                for (auto& x : row) x = r.number(0.5, 2);
            const Patch patch = make_bspline_patch(a.degree, b.degree, a.knots, b.knots, net, w);
            for (int n = 0; n < 40; ++n) {
                const Vec2 p = random_parameter(r, patch);
                Point sum;
                double total = 0;
                for (int i = 0; i < a.points(); ++i)
                    for (int j = 0; j < b.points(); ++j) {
                        const double weight =
                            w[i][j] * basis(a.knots, i, a.degree, p.x) * basis(b.knots, j, b.degree, p.y);
                        sum += weight * net[i][j];
                        total += weight;
                    }
                EXPECT_LE(distance(patch.point(p.x, p.y), sum / total), 1e-14 * 10);
            }
        }
}

TEST(Hermite, MeetsPointsAndTangents) {
    Random r(5);
    std::vector<Point> p, m;
    for (int i = 0; i < 6; ++i) p.push_back(r.point()), m.push_back(r.vector());
    const Curve c = make_hermite(p, m);
    for (int i = 0; i < 6; ++i) {
        EXPECT_LE(distance(c(i), p[i]), 1e-15);
        EXPECT_LE(distance(c.derivative(i), m[i]), 1e-14);
    }
}

class Interpolate : public ::testing::TestWithParam<int> {
protected:
    static std::vector<Point> points() {
        Random r(6);
        std::vector<Point> p;
        for (int i = 0; i < GetParam(); ++i) p.push_back(r.point());
        return p;
    }
    static Point derivative(const Curve& c, double t, int order) {
        Point x[4];
        c.taylor(t, 3, x);
        return (order == 3 ? 6.0 : order == 2 ? 2.0 : 1.0) * x[order];
    }
    static Point before(const Curve& c, double t, int order) {
        return derivative(c, std::nextafter(t, c.begin()), order);
    }
};

TEST_P(Interpolate, PassesThroughItsPoints) {
    const auto p = points();
    for (auto ends : {SplineEnds::natural, SplineEnds::clamped, SplineEnds::catmull_rom}) {
        const Curve c = make_interpolate(p, ends);
        EXPECT_EQ(c.end(), double(p.size() - 1));
        for (std::size_t i = 0; i < p.size(); ++i) EXPECT_LE(distance(c(double(i)), p[i]), 1e-15);
    }
}
TEST_P(Interpolate, NaturalAndClampedAreC2) {
    const auto p = points();
    for (auto ends : {SplineEnds::natural, SplineEnds::clamped}) {
        const Curve c = make_interpolate(p, ends);
        for (std::size_t i = 1; i + 1 < p.size(); ++i)
            for (int k : {1, 2})
                EXPECT_LE(distance(before(c, double(i), k), derivative(c, double(i), k)), 1e-12)
                    << i << ", order " << k;
        for (const auto& b : c.breaks()) EXPECT_EQ(b.continuity, 2);
    }
}
TEST_P(Interpolate, NaturalEndsAreStraight) {
    const Curve c = make_interpolate(points(), SplineEnds::natural);
    EXPECT_LE(length(derivative(c, 0, 2)), 1e-12);
    EXPECT_LE(length(derivative(c, c.end(), 2)), 1e-12);
}
TEST_P(Interpolate, ClampedEndsFollowTheParabola) {
    const auto p = points();
    const Curve c = make_interpolate(p, SplineEnds::clamped);
    if (p.size() == 2) {
        EXPECT_LE(distance(c.derivative(0), p[1] - p[0]), 1e-14);
        return;
    }
    EXPECT_LE(distance(c.derivative(0), -1.5 * p[0] + 2.0 * p[1] - 0.5 * p[2]), 1e-13);
    const std::size_t n = p.size() - 1;
    EXPECT_LE(distance(c.derivative(c.end()), 1.5 * p[n] - 2.0 * p[n - 1] + 0.5 * p[n - 2]), 1e-13);
}
TEST_P(Interpolate, CatmullRomHasCentralTangentsAndQuadraticEnds) {
    const auto p = points();
    const Curve c = make_interpolate(p, SplineEnds::catmull_rom);
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
        EXPECT_LE(distance(c.derivative(double(i)), 0.5 * (p[i + 1] - p[i - 1])), 1e-14);
        EXPECT_LE(distance(before(c, double(i), 1), c.derivative(double(i))), 1e-13);
    }
    EXPECT_LE(length(derivative(c, 0, 3)), 1e-12);
    EXPECT_LE(length(derivative(c, c.end(), 3)), 1e-12);
}
INSTANTIATE_TEST_SUITE_P(Points, Interpolate, ::testing::Values(2, 3, 4, 9));

TEST(Interpolating, ReproducesPolynomialsOfItsDegree) {
    // A parabola has central differences and Bessel tangents that are exact: both rules return it.
    const auto f = [](double t) { return Point{1 + t, t * t, 2 - t + 0.5 * t * t}; };
    std::vector<Point> p;
    for (int i = 0; i < 5; ++i) p.push_back(f(i));
    for (auto ends : {SplineEnds::clamped, SplineEnds::catmull_rom})
        for (double t = 0; t <= 4; t += 0.125) EXPECT_LE(distance(make_interpolate(p, ends)(t), f(t)), 1e-13);
}

TEST(Arc, LiesOnItsCircleForEveryAngle) {
    Random r(7);
    for (double degrees : {0.01, 1.0, 30.0, 60.0, 89.999999, 90.0, 90.000001, 120.0, 150.0, 179.0, 179.99}) {
        const Point center = r.point({}, 5), a = r.vector(2) + Point{1, 0, 0};
        const Point axis = normalized(cross(a, Point{0, 1, 0.3}));
        const Point b = Transform::rotate(axis, degrees).vector(a);
        const Curve c = make_arc(center, center + a, center + b);
        EXPECT_EQ(c.begin(), 0);
        EXPECT_EQ(c.end(), 1);
        EXPECT_LE(distance(c(0), center + a), 1e-15 * 10);
        EXPECT_LE(distance(c(1), center + b), 1e-15 * 10);
        const double radius = length(a),
                     flat = 2 * radius / length(a + b);  // nearly opposite points hardly tell the plane
        double angle = 0;
        for (int k = 0; k <= 64; ++k) {
            const Point x = c(k / 64.0) - center;
            EXPECT_NEAR(length(x), radius, 2e-14 * (radius + length(center))) << degrees;
            EXPECT_NEAR(dot(x, axis), 0, 2e-14 * (radius + length(center)) * flat) << "leaves its plane";
            EXPECT_NEAR(dot(x, c.derivative(k / 64.0)), 0, 1e-10 * radius * length(c.derivative(k / 64.0)))
                << "tangent across the radius";
            const double now = std::atan2(dot(cross(a, x), axis), dot(a, x));
            EXPECT_GE(now, angle - 1e-9) << "goes back";
            angle = now;
        }
        EXPECT_NEAR(angle, degrees * M_PI / 180, 1e-7) << "the minor arc";
        for (const auto& joint : c.breaks())
            EXPECT_LE(distance(c.derivative(std::nextafter(joint.t, 0)), c.derivative(joint.t)),
                      1e-13 * flat * length(c.derivative(joint.t)));
    }
}

TEST(Segment, BreaksThatDifferByRoundingMakeNoSlivers) {
    // Ten spans over [0, 0.7], run over [0, 7]: the break at 1 comes out as 1 + 2^-52.
    std::vector<double> knots{0, 0, 0};
    for (int k = 0; k <= 7; ++k) knots.push_back(0.1 * k);
    knots.insert(knots.end(), {0.7, 0.7, 0.7});
    knots[knots.size() - 4] = 0.7;
    Random r(8);
    std::vector<Point> p;
    for (std::size_t i = 0; i + 4 < knots.size(); ++i) p.push_back(r.point());
    const Curve c = reparametrized(make_bspline(3, knots, p), 0, 7);
    for (int k = 0; k < 7; ++k) {
        const Curve part = segment(c, k, k + 1);
        EXPECT_EQ(part.bezier()->pieces().size(), 1u) << k;
        for (double s : {0.0, 0.5, 1.0}) {
            EXPECT_LE(distance(part(s), c(k + s)), 1e-13);
        }
        EXPECT_LE(distance(part.derivative(0.5), c.derivative(k + 0.5)), 1e-12);
        EXPECT_LE(length(part.derivative(0)), 10) << "the derivative of a sliver is rounding divided by its width";
    }
    const Curve exact = make_interpolate(
        {{0, 0, 0}, {1, 1, 0}, {2, 0, 1}, {3, 1, 1}, {4, 0, 0}, {5, 1, 2}, {6, 0, 0}, {7, 0, 0}}, SplineEnds::natural);
    const Curve sum = linear_combination({1, -1}, {c, exact});
    EXPECT_EQ(sum.breaks().size(), 6u);
    for (int k = 0; k <= 70; ++k) {
        const double t = k / 10.0;
        EXPECT_LE(distance(sum(t), c(t) - exact(t)), 1e-13);
        EXPECT_LE(length(sum.derivative(t)), 20);
    }
}

}  // namespace
}  // namespace isoparm::tests
