// errata_slides_test.cpp -- docs/errata.md, surfaces on a triangle in the slides of 2017: printed formulas that fail beside the corrected ones.
#include "errata_triangle.h"
#include "patches/bbg.h"
#include "patches/side_vertex.h"

namespace isoparm::tests {
namespace {

TEST(Errata, BbgSecondProjectorRunsFromTheEdgeToU) {
    const Cubic c(4);
    const auto e = c.edges();
    const auto P2 = [&](double s, double v) { return (1 - s) * e[2](v) + s * e[0](1 - v); };
    const auto printed = [&](double, double v, double w) { return P2(w / (v + w), v); };
    const auto right = [&](double u, double v, double w) { return P2(w / (w + u), v); };
    EXPECT_GE(largest([&](double t) { return printed(0, 1 - t, t) - e[0](t); }), 0.1) << "misses the edge u = 0";
    const Patch patch = make_bbg(e, {BbgForm::Kind::projector, 2});
    EXPECT_LE(largest([&](double t) { return patch.point(0, 1 - t) - e[0](t); }), kRounding);
    EXPECT_LE(gap(right, surface(patch), true), kRounding);
}

TEST(Errata, BbgProjectorsTakeTheirValuesOnTheBoundary) {
    // "x(u,0,w)" on the line u = const: (u,0,w) does not lie in the plane u + v + w = 1. The point of the same u is (u,0,1-u).
    // Brought to the plane along the ray instead, (u,0,w)/(u+w), even the linear x = u e1 + v e2 + w e3 is not reproduced.
    const auto x = [](double u, double v, double w) { return Point{u, v, w}; };
    const Surface by_ray = [&](double u, double v, double w) {
        const double r = v / (v + w);
        return (1 - r) * x(u / (u + w), 0, w / (u + w)) + r * x(u / (u + v), v / (u + v), 0);
    };
    EXPECT_NEAR(distance(by_ray(1 / 3.0, 1 / 3.0, 1 / 3.0), x(1 / 3.0, 1 / 3.0, 1 / 3.0)), std::sqrt(1 / 24.0), 1e-12);
    const Point A{1, 0, 0}, B{0, 1, 0}, C{0, 0, 1};
    const std::array<Curve, 3> e{make_bezier({B, C}), make_bezier({C, A}), make_bezier({A, B})};
    for (int k = 1; k <= 3; ++k) EXPECT_LE(gap(x, surface(make_bbg(e, {BbgForm::Kind::projector, k}))), kRounding);
}

TEST(Errata, BbgProjectorsDoNotCommute) {
    // "P = P1 (+) P2", but in which order? Both interpolate the boundary, and they differ inside.
    const Cubic c(5);
    const Patch p12 = make_bbg(c.edges(), {BbgForm::Kind::boolean, 1, 2}), p21 = make_bbg(c.edges(), {BbgForm::Kind::boolean, 2, 1});
    EXPECT_GE(gap(surface(p12), surface(p21)), 0.02);
    for (const Patch& p : {p12, p21}) {
        const auto e = c.edges();
        EXPECT_LE(largest([&](double t) { return p.point(0, 1 - t) - e[0](t); }), kRounding);
        EXPECT_LE(largest([&](double t) { return p.point(t, 0) - e[1](t); }), kRounding);
        EXPECT_LE(largest([&](double t) { return p.point(1 - t, t) - e[2](t); }), kRounding);
    }
}

TEST(Errata, BbgOfPolynomialCurvesIsPolynomial) {
    // "Rational in u, v, w": the weights are; the surface over cubic curves is a cubic, as its fourth differences say.
    const Cubic c(6);
    for (const BbgForm& form : {BbgForm{BbgForm::Kind::boolean, 1, 2}, {BbgForm::Kind::boolean, 3, 1}, {BbgForm::Kind::symmetric}}) {
        const Patch p = make_bbg(c.edges(), form);
        for (const auto& [du, dv] : {std::pair{0.06, 0.03}, {0.1, -0.02}, {-0.04, 0.15}}) {
            const auto at = [&, du = du, dv = dv](int k) { return p.point(0.3 + k * du, 0.2 + k * dv); };
            EXPECT_LE(length(at(0) - 4.0 * at(1) + 6.0 * at(2) - 4.0 * at(3) + at(4)), kRounding);
        }
    }
    Cubic inner = c;  // the symmetric one: b111 = (six poles of the edges) / 4 - (A + B + C) / 6
    inner.b[5] = 0.25 * (c.b[1] + c.b[2] + c.b[4] + c.b[6] + c.b[7] + c.b[8]) - (c.A() + c.B() + c.C()) / 6.0;
    EXPECT_LE(gap(surface(make_bbg(c.edges(), {BbgForm::Kind::symmetric})), surface(inner.patch())), kRounding);
}

TEST(Errata, BbgC1ProjectorsHaveTheirOwnParametersAndDirections) {
    // The lines named P1 for the second and the third time. Each right projector is cubic Hermite interpolation along its
    // lines and so reproduces a cubic surface.
    const Cubic c(7);
    const Surface x = surface(c.patch());
    using Slope = std::function<Point(double, double)>;
    const Slope x1 = [&](double u, double v) { return (1 - u) * c.slope(0, 1, u, v); },          // (v+w) D_{e2-e3}
        x2 = [&](double u, double v) { return (1 - v) * c.slope(-1, 0, u, v); },                 // (u+w) D_{e3-e1}
        x3 = [&](double u, double v) { return (u + v) * c.slope(-1, 1, u, v); };                 // (u+v) D_{e2-e1}
    const auto blend = [](double t, const Point& a, const Point& b, const Point& p, const Point& q) {
        const double t2 = t * t, t3 = t2 * t;
        return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * b + (t3 - t2) * p + (3 * t2 - 2 * t3) * q;
    };
    const auto P2 = [&](bool own_parameter, bool own_direction) -> Surface {
        return [=](double u, double v, double w) {
            const double t = own_parameter ? w / (w + u) : v / (v + w);
            return blend(t, x(1 - v, v, 0), x2(1 - v, v), (own_direction ? x2 : x1)(0, v), x(0, v, 1 - v));
        };
    };
    const auto P3 = [&](bool own_parameter, bool own_direction, bool own_end) -> Surface {
        return [=](double u, double v, double w) {
            const double t = own_parameter ? v / (u + v) : v / (v + w);
            const Slope& d = own_direction ? x3 : x1;
            return blend(t, x(1 - w, 0, w), d(1 - w, 0), own_end ? d(0, 1 - w) : d(1 - w, 0), x(0, 1 - w, w));
        };
    };
    EXPECT_GE(gap(P2(false, false), x, true), 0.1) << "as printed: H(r) and x_1 at the end";
    EXPECT_GE(gap(P2(true, false), x, true), 0.1) << "with s, but x_1";
    EXPECT_LE(gap(P2(true, true), x, true), kRounding);
    EXPECT_GE(gap(P3(false, false, false), x, true), 0.1) << "as printed: H(r), and x_1(u,0,w) twice";
    EXPECT_GE(gap(P3(true, false, false), x, true), 0.1) << "with t, but x_1";
    EXPECT_GE(gap(P3(true, true, false), x, true), 0.1) << "and with x_3, but at the same end twice";
    EXPECT_LE(gap(P3(true, true, true), x, true), kRounding);
    for (int k = 0; k <= 3; ++k) EXPECT_LE(gap(surface(make_bbg_c1(c.edges(), c.cross(), TrianglePart(k))), x), 10 * kRounding) << "projector " << k;
}

TEST(Errata, NielsonRaysMeetTheOppositeEdge) {
    // The ray from e2 through (u,v,w) meets v = 0 at (u,0,w)/(u+w): s = w/(u+w) in x(1-s,0,s). Printed is s = u/(u+w): the edge
    // is run backwards. The same with t = v/(u+v).
    const Cubic c(8);
    const auto e = c.edges();
    const auto ratio = [](double a, double b) { return a + b == 0 ? 0 : a / (a + b); };
    const auto P1 = [&](double u, double r) { return u * c.A() + (1 - u) * e[0](1 - r); };  // x(0, r, 1-r)
    const auto P2 = [&](double v, double s) { return v * c.B() + (1 - v) * e[1](1 - s); };  // x(1-s, 0, s)
    const auto P3 = [&](double w, double t) { return w * c.C() + (1 - w) * e[2](t); };      // x(1-t, t, 0)
    const auto sum = [&](bool printed) -> Surface {
        return [=](double u, double v, double w) {
            const Point L = u * c.A() + v * c.B() + w * c.C();  // every product P_i P_j, and P1 P2 P3
            return P1(u, ratio(v, w)) + P2(v, printed ? ratio(u, w) : ratio(w, u)) + P3(w, printed ? ratio(u, v) : ratio(v, u)) - 2.0 * L;
        };
    };
    EXPECT_GE(largest([&](double t) { return sum(true)(t, 0, 1 - t) - e[1](t); }), 0.1);
    EXPECT_GE(largest([&](double t) { return sum(true)(1 - t, t, 0) - e[2](t); }), 0.1);
    EXPECT_LE(largest([&](double t) { return sum(false)(t, 0, 1 - t) - e[1](t); }), kRounding);
    EXPECT_LE(largest([&](double t) { return sum(false)(1 - t, t, 0) - e[2](t); }), kRounding);
    EXPECT_LE(gap(sum(false), surface(make_side_vertex(e, Function::polynomial({0, 1})))), kRounding);
}

}  // namespace
}  // namespace isoparm::tests
