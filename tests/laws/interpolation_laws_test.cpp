// interpolation_laws_test.cpp -- what the transfinite surfaces promise: cross derivatives, networks, reproduction of
// the surfaces that they contain, and equality of forms that the formula sheet calls equal.
#include <gtest/gtest.h>

#include "curves/bezier.h"
#include "curves/interpolate.h"
#include "curves/isocurve.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "patches/bezier_triangle.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/network.h"
#include "patches/side_vertex.h"
#include "patches/tensor_bezier.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

Point du(const Patch& p, double u, double v) {
    const PointJet x = p.jet(u, v);
    return {x.x.coefficient(1, 0), x.y.coefficient(1, 0), x.z.coefficient(1, 0)};
}
Point dv(const Patch& p, double u, double v) {
    const PointJet x = p.jet(u, v);
    return {x.x.coefficient(0, 1), x.y.coefficient(0, 1), x.z.coefficient(0, 1)};
}
/// Position, cross derivatives and twists of a patch as data; `incompatible` moves the inside of the cross derivatives.
HermiteData data_of(const std::vector<std::vector<Point>>& p, Random* incompatible = nullptr) {
    const int m = int(p.size()) - 1, n = int(p[0].size()) - 1;
    std::array<std::vector<Point>, 4> f, g;
    for (int j = 0; j <= n; ++j) {
        f[0].push_back(p[0][j]), f[3].push_back(p[m][j]);
        f[1].push_back(double(m) * (p[1][j] - p[0][j])), f[2].push_back(double(m) * (p[m][j] - p[m - 1][j]));
    }
    for (int i = 0; i <= m; ++i) {
        g[0].push_back(p[i][0]), g[3].push_back(p[i][n]);
        g[1].push_back(double(n) * (p[i][1] - p[i][0])), g[2].push_back(double(n) * (p[i][n] - p[i][n - 1]));
    }
    if (incompatible)
        for (int k : {1, 2}) {
            for (int j = 1; j < n; ++j) f[k][j] += incompatible->vector();
            for (int i = 1; i < m; ++i) g[k][i] += incompatible->vector();
        }
    return {{make_bezier(f[0]), make_bezier(f[1]), make_bezier(f[2]), make_bezier(f[3])},
            {make_bezier(g[0]), make_bezier(g[1]), make_bezier(g[2]), make_bezier(g[3])}};
}
void expect_interpolated(const Patch& patch, const HermiteData& d, double tolerance) {
    for (int k = 0; k <= 20; ++k) {
        const double t = k / 20.0;
        EXPECT_LE(distance(patch.point(0, t), d.f[0](t)), tolerance);
        EXPECT_LE(distance(du(patch, 0, t), d.f[1](t)), tolerance) << t;
        EXPECT_LE(distance(du(patch, 1, t), d.f[2](t)), tolerance) << t;
        EXPECT_LE(distance(patch.point(1, t), d.f[3](t)), tolerance);
        EXPECT_LE(distance(patch.point(t, 0), d.g[0](t)), tolerance);
        EXPECT_LE(distance(dv(patch, t, 0), d.g[1](t)), tolerance) << t;
        EXPECT_LE(distance(dv(patch, t, 1), d.g[2](t)), tolerance) << t;
        EXPECT_LE(distance(patch.point(t, 1), d.g[3](t)), tolerance);
    }
}
void expect_equal(const Patch& a, const Patch& b, double tolerance) {
    Random r(99);
    for (int n = 0; n < 60; ++n) {
        const Vec2 p = random_parameter(r, a, 1e-3);
        const PointJet x = a.jet(p.x, p.y), y = b.jet(p.x, p.y);
        for (int axis = 0; axis < 3; ++axis)
            for (int k = 0; k < x.x.size; ++k)
                EXPECT_NEAR(x[axis].c[k], y[axis].c[k], tolerance * (1 + std::abs(y[axis].c[k])))
                    << "coefficient " << k << " at " << p.x << ", " << p.y;
    }
}

TEST(CoonsHermite, InterpolatesBoundaryAndCrossDerivatives) {
    for (int seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const HermiteData d = data_of(random_net(r, 6, 5));
        for (auto twist : {Twist::compatible, Twist::gregory, Twist::average})
            expect_interpolated(make_coons_hermite(d, twist), d, 1e-13 * 20);
    }
}

TEST(CoonsHermite, GregoryInterpolatesIncompatibleTwistsAndOthersDoNot) {
    for (int seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const HermiteData d = data_of(random_net(r, 5, 4), &r);
        expect_interpolated(make_coons_hermite(d, Twist::gregory), d, 1e-13 * 20);
        for (auto twist : {Twist::average, Twist::zero})
            EXPECT_GE(distance(du(make_coons_hermite(d, twist), 0, 0.5), d.f[1](0.5)), 1e-3);
    }
}

TEST(CoonsHermite, ReproducesWhatIsCubicInOneParameter) {
    for (int seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const auto net = random_net(r, 8, 4);  // degree (7,3)
        for (auto twist : {Twist::compatible, Twist::gregory, Twist::average})
            expect_equal(make_coons_hermite(data_of(net), twist), make_bezier_patch(net), 1e-11);
    }
}

TEST(Coons, ReproducesWhatIsLinearInOneParameter) {
    for (int seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const auto net = random_net(r, 6, 2);
        std::vector<Point> c0, c1;
        for (const auto& row : net) c0.push_back(row[0]), c1.push_back(row[1]);
        expect_equal(make_coons({make_bezier(c0), make_bezier(c1), make_line(c0.front(), c1.front()),
                                 make_line(c0.back(), c1.back())}),
                     make_bezier_patch(net), 1e-12);
    }
}

/// (1-u) d0 + u d1 + (1-v) c0 + v c1 - bilinear, evaluated directly.
Point coons_formula(const Frame& e, double u, double v) {
    return (1 - u) * e.d0(v) + u * e.d1(v) + (1 - v) * e.c0(u) + v * e.c1(u) -
           ((1 - u) * ((1 - v) * e.c0(0) + v * e.c1(0)) + u * ((1 - v) * e.c0(1) + v * e.c1(1)));
}

TEST(Coons, IsItsFormulaOnTheExactAndOnTheGeneralPath) {
    for (int seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const Frame e = random_frame(r);
        // The same cubics with all weights 1 count as rational, so they run on interval jets, not on exact polynomials.
        const auto rational = [&](const Curve& c) {
            const auto p = segment(c, 0, 1);
            Point x[4];
            p.taylor(0.0, 3, x);
            return make_bezier({x[0], x[0] + x[1] / 3.0, x[0] + 2.0 / 3 * x[1] + x[2] / 3.0, x[0] + x[1] + x[2] + x[3]},
                               {1, 1, 1, 1});
        };
        const Patch exact = make_coons({e.c0, e.c1, e.d0, e.d1}),
                    general = make_coons({rational(e.c0), rational(e.c1), rational(e.d0), rational(e.d1)});
        expect_equal(exact, general, 1e-12);
        for (int n = 0; n < 20; ++n) {
            const double u = r.number(), v = r.number(), h = std::pow(10, -r.number(1, 8));
            EXPECT_LE(distance(exact.point(u, v), coons_formula(e, u, v)), 1e-14 * 4);
            const Box box{{u, std::min(1.0, u + h)}, {v, std::min(1.0, v + h)}};
            const Enclosure a = exact.enclose(box), b = general.enclose(box);
            for (int axis = 0; axis < 3; ++axis)
                for (int k = 0; k < a.over.x.size; ++k) {  // both hold the same surface: they overlap
                    EXPECT_LE(a.over[axis].c[k].lo, b.over[axis].c[k].hi + 1e-12);
                    EXPECT_LE(b.over[axis].c[k].lo, a.over[axis].c[k].hi + 1e-12);
                }
        }
    }
}

TEST(Coons, PartsAddUp) {
    Random r(11);
    const Frame e = random_frame(r);
    const CoonsCurves c{e.c0, e.c1, e.d0, e.d1};
    const Patch sum = make_coons(c), p1 = make_coons(c, {}, Part::P1), p2 = make_coons(c, {}, Part::P2),
                p12 = make_coons(c, {}, Part::P1P2);
    const HermiteData d = data_of(random_net(r, 5, 4), &r);
    const auto hermite = [&](Part part) { return make_coons_hermite(d, Twist::gregory, part); };
    for (int n = 0; n < 20; ++n) {
        const double u = r.number(), v = r.number();
        EXPECT_LE(distance(sum.point(u, v), p1.point(u, v) + p2.point(u, v) - p12.point(u, v)), 1e-14 * 10);
        EXPECT_LE(distance(p1.point(0, v), e.d0(v)), 1e-15 * 10);
        EXPECT_LE(distance(p2.point(u, 1), e.c1(u)), 1e-15 * 10);
        EXPECT_LE(
            distance(hermite(Part::sum).point(u, v),
                     hermite(Part::P1).point(u, v) + hermite(Part::P2).point(u, v) - hermite(Part::P1P2).point(u, v)),
            1e-13 * 10);
    }
}

Network random_network(Random& r, int m, int n) {
    std::vector<std::vector<Point>> p(m + 1);
    for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= n; ++j) p[i].push_back(r.point({double(i), double(j), 0}, 0.3));
    Network net;
    for (int i = 0; i <= m; ++i) net.a.push_back(make_interpolate(p[i], SplineEnds::natural));
    for (int j = 0; j <= n; ++j) {
        std::vector<Point> row;
        for (int i = 0; i <= m; ++i) row.push_back(p[i][j]);
        net.b.push_back(make_interpolate(row, SplineEnds::clamped));
    }
    return net;
}

TEST(NetworkOfCurves, InterpolatesEveryCurveWithEveryTwist) {
    for (int seed = 1; seed <= 4; ++seed)
        for (auto [m, n] : {std::pair{1, 1}, {1, 3}, {3, 2}, {4, 4}})
            for (auto twist : {Twist::average, Twist::zero, Twist::gregory}) {
                SCOPED_TRACE("seed " + std::to_string(seed));
                Random r(seed);
                const Network net = random_network(r, m, n);
                const Patch patch = make_network(net, twist);
                for (int k = 0; k <= 20; ++k) {
                    for (int i = 0; i <= m; ++i)
                        EXPECT_LE(distance(patch.point(i, n * k / 20.0), net.a[i](n * k / 20.0)), 1e-13)
                            << "a[" << i << "]";
                    for (int j = 0; j <= n; ++j)
                        EXPECT_LE(distance(patch.point(m * k / 20.0, j), net.b[j](m * k / 20.0)), 1e-13)
                            << "b[" << j << "]";
                }
            }
}

TEST(NetworkOfCurves, IsC1AcrossItsCells) {
    for (int seed = 1; seed <= 4; ++seed)
        for (auto twist : {Twist::average, Twist::zero, Twist::gregory}) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            Random r(seed);
            const Patch patch = make_network(random_network(r, 3, 3), twist);
            for (int line : {1, 2})
                for (int k = 1; k < 30; ++k) {
                    const double t = k / 10.0, before = std::nextafter(double(line), 0.0);
                    EXPECT_LE(distance(du(patch, before, t), du(patch, line, t)), 1e-12) << line << ", " << t;
                    EXPECT_LE(distance(dv(patch, t, before), dv(patch, t, line)), 1e-12) << line << ", " << t;
                }
        }
}

TEST(NetworkOfCurves, TakesTheDifferencesAsCrossDerivativesAtItsNodes) {
    // (6.25) and A12: at the nodes x_u is (r(i+1,j) - r(i-1,j)) / 2, and one-sided at the ends.
    Random r(12);
    const Network net = random_network(r, 3, 2);
    const Patch patch = make_network(net);
    for (int j = 0; j <= 2; ++j) {
        const auto x = [&](int i) { return net.a[i](j); };
        EXPECT_LE(distance(du(patch, 0, j), 2.0 * x(1) - 2.0 * x(0) - 0.5 * (x(2) - x(0))), 1e-12) << j;
        EXPECT_LE(distance(du(patch, 3, j), 2.0 * x(3) - 2.0 * x(2) - 0.5 * (x(3) - x(1))), 1e-12) << j;
    }
}

TEST(NetworkOfCurves, PrescribedCrossDerivativesOfACatmullRomNetwork) {
    // Curves by the same rule as the differences: then x_u(i,v) is the difference along the whole curve, not only at
    // nodes.
    Random r(13);
    const int m = 3, n = 3;
    std::vector<std::vector<Point>> p(m + 1);
    for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= n; ++j) p[i].push_back(r.point({double(i), double(j), 0}, 0.3));
    Network net;
    for (int i = 0; i <= m; ++i) net.a.push_back(make_interpolate(p[i], SplineEnds::catmull_rom));
    for (int j = 0; j <= n; ++j)
        net.b.push_back(make_interpolate({p[0][j], p[1][j], p[2][j], p[3][j]}, SplineEnds::catmull_rom));
    const Patch patch = make_network(net, Twist::compatible);  // the twists agree
    for (int k = 0; k <= 30; ++k) {
        const double t = k / 10.0;
        EXPECT_LE(distance(du(patch, 1, t), 0.5 * (net.a[2](t) - net.a[0](t))), 1e-12) << t;
        EXPECT_LE(distance(dv(patch, t, 2), 0.5 * (net.b[3](t) - net.b[1](t))), 1e-12) << t;
    }
}

TEST(NetworkOfCurves, LinesOfAPlaneAreThePlane) {
    Network net;
    for (int i = 0; i <= 2; ++i) net.a.push_back(make_line({double(i), 0, 0}, {double(i), 3, 3}));
    for (int j = 0; j <= 3; ++j) net.b.push_back(make_line({0, double(j), double(j)}, {2, double(j), double(j)}));
    const Patch patch = make_network(net, Twist::compatible);
    for (double u : {0.0, 0.3, 1.0, 1.7, 2.0})
        for (double v : {0.0, 0.9, 2.5, 3.0}) EXPECT_LE(distance(patch.point(u, v), {u, v, v}), 1e-14 * 4);
}

TEST(Breaks, OfTheCurvesAreBreaksOfTheSurface) {
    Random r(14);
    const auto spline = [](Random& random, const Point& a, const Point& b) {
        return make_interpolate({a, 0.5 * a + 0.5 * b + random.vector(0.3), b}, SplineEnds::natural);
    };
    const Frame e = random_frame(r, spline);
    const Patch coons = make_coons({e.c0, e.c1, e.d0, random_cubic(r, e.c0(2), e.c1(2))});
    ASSERT_EQ(coons.breaks_u(), std::vector<double>{0.5});
    ASSERT_EQ(coons.breaks_v(), std::vector<double>{0.5});
    // Between the breaks the surface is polynomial: third derivatives have bounds up to the break.
    const Enclosure exact = coons.enclose({{0.25, 0.5}, {0.5, 0.75}});
    for (int k = 0; k < exact.over.x.size; ++k) EXPECT_TRUE(exact.over.x.c[k].bounded());
    // Splines whose knots lie inside the cells of a network.
    Network net;
    net.a = {make_line({0, 0, 0}, {0, 1, 0}), make_line({1, 0, 0}, {1, 1, 0})};
    const auto bump = [](double y) {
        return make_interpolate({{0, y, 0}, {0.3, y, 0.2}, {0.6, y, -0.1}, {1, y, 0}}, SplineEnds::natural);
    };
    net.b = {bump(0), bump(1)};
    const Patch patch = make_network(net);
    ASSERT_EQ(patch.breaks_u().size(), 2u);
    EXPECT_NEAR(patch.breaks_u()[0], 1 / 3.0, 1e-15);
    EXPECT_TRUE(patch.breaks_v().empty());
}

// ---- triangles ------------------------------------------------------------------------------------------------------
TEST(SideVertex, OfQuadraticsIsTheBezierTriangle) {
    for (int seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const Point a = r.point({2, 0, 0}), b = r.point({0, 2, 0}), c = r.point(), m1 = r.point(), m2 = r.point(),
                    m3 = r.point();
        const std::array<Curve, 3> e{make_bezier({b, m1, c}), make_bezier({c, m2, a}), make_bezier({a, m3, b})};
        const Patch triangle = make_bezier_triangle(2, {a, m3, b, m2, m1, c});
        for (auto form : {SideVertexForm::delta, SideVertexForm::seed})
            expect_equal(make_side_vertex(e, Function::polynomial({0, 0, 1}), form), triangle, 1e-11);
    }
}

TEST(SideVertex, FormsAgreeExactlyWhenHIsQuadratic) {
    Random r(15);
    const auto e = random_triangle(r);
    for (double c : {0.0, 1.0, -0.4}) {
        const Function h = Function::polynomial({0, 1 - c, c});
        expect_equal(make_side_vertex(e, h, SideVertexForm::delta), make_side_vertex(e, h, SideVertexForm::seed),
                     1e-10);
    }
    const Function quartic = Function::polynomial({0, 0, 0, 2, -1});
    EXPECT_GE(distance(make_side_vertex(e, quartic, SideVertexForm::delta).point(0.3, 0.3),
                       make_side_vertex(e, quartic, SideVertexForm::seed).point(0.3, 0.3)),
              1e-3);
}

TEST(SideVertex, SeedFormWithCubeDependsOnTheOrigin) {
    // B1: with H = t^3 and cubic edges it is the cubic Bezier triangle whose middle point is the origin.
    Random r(16);
    const auto e = random_triangle(r);
    const auto pole = [](const Curve& c, int k) {
        Point x[4];
        c.taylor(0.0, 3, x);
        return k == 1 ? x[0] + x[1] / 3.0 : x[0] + 2.0 / 3 * x[1] + x[2] / 3.0;
    };
    const Patch triangle = make_bezier_triangle(3, {e[2](0),
                                                    pole(e[2], 1),
                                                    pole(e[2], 2),
                                                    e[2](1),
                                                    pole(e[1], 2),
                                                    {0, 0, 0},
                                                    pole(e[0], 1),
                                                    pole(e[1], 1),
                                                    pole(e[0], 2),
                                                    e[0](1)});
    expect_equal(make_side_vertex(e, Function::polynomial({0, 0, 0, 1}), SideVertexForm::seed), triangle, 1e-10);
}

TEST(SideVertex, StraightEdgesMakeThePlaneWithANormalAtTheVertices) {
    const Point a{2, 0.1, 0}, b{0.3, 2, 1}, c{-0.1, 0.2, 0.7};
    const auto straight = [](const Point& p, const Point& q) {
        return make_bezier({p, p + (q - p) / 3.0, p + 2.0 * (q - p) / 3.0, q});
    };
    const std::array<Curve, 3> e{straight(b, c), straight(c, a), straight(a, b)};
    for (auto form : {SideVertexForm::delta, SideVertexForm::seed})
        for (const auto& h : {Function::polynomial({0, 1}), Function::polynomial({0, 0, 1})}) {
            const Patch patch = make_side_vertex(e, h, form);
            const Point normal = normalized(cross(a - c, b - c));
            for (const Vec2 p : {Vec2{0.3, 0.4}, {1, 0}, {0, 1}, {0, 0}, {0.5, 0.5}}) {
                const SurfacePoint s = evaluate(patch, p.x, p.y);
                EXPECT_LE(distance(s.position, p.x * a + p.y * b + (1 - p.x - p.y) * c), 1e-15 * 10);
                ASSERT_TRUE(s.du && s.dv && s.normal) << p.x << ", " << p.y;
                EXPECT_LE(distance(*s.du, a - c), 1e-14 * 10);
                EXPECT_LE(distance(*s.dv, b - c), 1e-14 * 10);
                EXPECT_LE(distance(*s.normal, normal), 1e-14 * 10);
                ASSERT_TRUE(s.duu && s.duv && s.dvv) << p.x << ", " << p.y;
                EXPECT_LE(length(*s.duu) + length(*s.duv) + length(*s.dvv), 1e-12);
            }
        }
}

TEST(SideVertex, KeepsItsDigitsNextToEveryVertex) {
    // Close to a vertex the surface is its tangent cone: moved along a ray by 2^-k, the way from the vertex scales by
    // 2^-k.
    Random r(17);
    const auto e = random_triangle(r);
    const Patch patch = make_side_vertex(e, Function::polynomial({0, 1}));
    for (const auto& [at, d] :
         {std::pair{Vec2{1, 0}, Vec2{-1, 0.3}}, {Vec2{0, 1}, Vec2{0.3, -1}}, {Vec2{0, 0}, Vec2{0.3, 0.6}}}) {
        const auto slope = [&](double h) {
            const SurfacePoint s = evaluate(patch, at.x + h * d.x, at.y + h * d.y);
            return d.x * *s.du + d.y * *s.dv;
        };
        EXPECT_LE(distance(slope(0x1p-42), slope(0x1p-44)), 1e-10) << at.x << ", " << at.y;
    }
}

TEST(SideVertex, DerivativesAtVerticesAreThoseOfTheEdges) {
    Random r(18);
    const auto e = random_triangle(r);
    for (const auto& h : {Function::polynomial({0, 0, 1}), Function::polynomial({0, 0, 0, 2, -1}), cubic_blend()}) {
        const Patch patch = make_side_vertex(e, h);
        // B1: at B dS = -du E3'(1) + dw E1'(0), and cyclically; here w = 1 - u - v.
        EXPECT_LE(distance(du(patch, 1, 0), e[1].derivative(1)), 1e-12);
        EXPECT_LE(distance(dv(patch, 1, 0), e[1].derivative(1) + e[2].derivative(0)), 1e-12);
        EXPECT_LE(distance(du(patch, 0, 1), -e[2].derivative(1) - e[0].derivative(0)), 1e-12);
        EXPECT_LE(distance(dv(patch, 0, 1), -e[0].derivative(0)), 1e-12);
        EXPECT_LE(distance(du(patch, 0, 0), e[1].derivative(0)), 1e-12);
        EXPECT_LE(distance(dv(patch, 0, 0), -e[0].derivative(1)), 1e-12);
    }
}

}  // namespace
}  // namespace isoparm::tests
