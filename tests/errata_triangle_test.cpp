// errata_triangle_test.cpp -- docs/errata.md, surfaces on a triangle: printed formulas that fail beside the corrected ones.
#include <gtest/gtest.h>

#include <functional>

#include "curves/bezier.h"
#include "curves/modify.h"
#include "patches/bbg.h"
#include "patches/bezier_triangle.h"
#include "patches/side_vertex.h"
#include "patches/three_curves.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

constexpr double kRounding = 1e-13;
const Point kShift{100, 0, 0};

using Surface = std::function<Point(double, double, double)>;  // of barycentric u, v, w
Surface surface(const Patch& p) {
    return [p](double u, double v, double) { return p.point(u, v); };
}
/// Largest distance over a grid of the triangle; `inside` leaves out the boundary, where a quotient may be 0/0.
double gap(const Surface& a, const Surface& b, bool inside = false) {
    double worst = 0;
    const int n = 12;
    for (int i = inside; i <= n - inside; ++i)
        for (int j = inside; i + j <= n - inside; ++j) {
            const double u = double(i) / n, v = double(j) / n, w = double(n - i - j) / n;
            worst = std::max(worst, distance(a(u, v, w), b(u, v, w)));
        }
    return worst;
}
double largest(const std::function<Point(double)>& f) {
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
double cube(double t) { return t * t * t; }

// ---- Malozemov, Sergeev, Chashnikov 2007 ----------------------------------------------------------------------------
/// (3) as printed, with the edges in the cyclic notation of this project.
Surface seed3(const std::array<Curve, 3>& e, const std::function<double(double)>& H, const Point& shift = {}) {
    return [=](double u, double v, double w) {
        const auto term = [&](double r, const Curve& c, double a) { return r == 0 ? Point{} : H(r) * (c(a / r) + shift); };
        return term(1 - v, e[1], u) + term(1 - w, e[2], v) + term(1 - u, e[0], w) - H(u) * (e[2](0) + shift) -
               H(v) * (e[0](0) + shift) - H(w) * (e[1](0) + shift);
    };
}
std::array<Curve, 3> shifted(const std::array<Curve, 3>& e) {
    const auto move = [](const Curve& c) { return transformed(c, Transform::translate(kShift)); };
    return {move(e[0]), move(e[1]), move(e[2])};
}

TEST(Errata, ThirdEdgeSumsOverJ) {
    // (6): the sum over i of P_{0,2-j} C_2^j w^j (1-w)^{2-j} is three times one term, whatever j is.
    const Point B{1, 2, 3}, P01{2, 2, 0}, C{0, -1, 1}, pole[] = {B, P01, C};  // P_{0,2-j}
    for (int j = 0; j <= 2; ++j) {
        const auto printed = [&](double w) { return 3.0 * (j == 1 ? 2 : 1) * std::pow(w, j) * std::pow(1 - w, 2 - j) * pole[j]; };
        EXPECT_GE(std::max(distance(printed(0), B), distance(printed(1), C)), 1) << "does not run from B to C";
    }
    const Curve right = make_bezier({B, P01, C});
    EXPECT_EQ(right(0), B);
    EXPECT_EQ(right(1), C);
}

TEST(Errata, SideVertexMovesOnlyWithSymmetricBlends) {
    // "Arbitrary H": under a shift by s the middle moves by s (3 H(2/3) - 3 H(1/3)): 7/9 for t^3, 13/9 for 3t^2 - 2t^3.
    const Cubic c(1);
    const auto e = c.edges();
    const auto deviation = [&](const Surface& here, const Surface& there) {
        return distance(there(1 / 3.0, 1 / 3.0, 1 / 3.0), here(1 / 3.0, 1 / 3.0, 1 / 3.0) + kShift);
    };
    struct Case {
        Function H;
        double expected;
    };
    for (const auto& [H, expected] : {Case{Function::polynomial({0, 0, 0, 1}), 200 / 9.0}, {Function::polynomial({0, 0, 3, -2}), 400 / 9.0},
                                      {Function::polynomial({0, 1}), 0}, {Function::polynomial({0, 0, 1}), 0},
                                      {Function::polynomial({0, 0, 0, 2, -1}), 0}, {Function::polynomial({0, 3, -2}), 0}}) {
        const auto h = [f = H](double t) { return f(t); };
        EXPECT_LE(gap(seed3(e, h), surface(make_side_vertex(e, H, SideVertexForm::seed))), kRounding) << "the formula as printed";
        EXPECT_NEAR(deviation(seed3(e, h), seed3(e, h, kShift)), expected, 1e-10);
        EXPECT_LE(deviation(surface(make_side_vertex(e, H)), surface(make_side_vertex(shifted(e), H))), 1e-12) << "the delta form";
        EXPECT_LE(largest([&](double t) { return make_side_vertex(e, H).point(0, 1 - t) - e[0](t); }), kRounding);
    }
    // With t^3 and cubic edges the surface is the cubic Bezier triangle whose inner point is the origin of the coordinates.
    Cubic origin = c;
    origin.b[5] = {};
    EXPECT_LE(gap(seed3(e, cube), surface(origin.patch())), kRounding);
}

TEST(Errata, SideVertexHasConePointsUnlessTheBlendIsFlat) {
    // "The term is zero" at a vertex, and so the surface is continuous; but for H = t derivatives at B do not add up.
    const Cubic c(2);
    const auto at_B = [](const Surface& s, double p, double q) {  // along p (e1 - e2) + q (e3 - e2)
        const double h = 1e-6;
        return (s(h * p, 1 - h * (p + q), h * q) - s(0, 1, 0)) / h;
    };
    const auto defect = [&](const Surface& s) { return length(at_B(s, 1, 1) - at_B(s, 1, 0) - at_B(s, 0, 1)); };
    EXPECT_GE(defect(seed3(c.edges(), [](double t) { return t; })), 0.1);
    EXPECT_LE(defect(seed3(c.edges(), [](double t) { return t * t; })), 1e-4);
    EXPECT_FALSE(evaluate(make_side_vertex(c.edges(), Function::polynomial({0, 1})), 0, 1).du) << "isoparm: no derivative";
    EXPECT_TRUE(evaluate(make_side_vertex(c.edges(), Function::polynomial({0, 0, 1})), 0, 1).du);
}

// ---- the lecture ----------------------------------------------------------------------------------------------------
TEST(Errata, BilinearTriangleIsLinear) {
    const Patch patch = make_bezier_triangle(1, {{1, 2, 3}, {-1, 0, 2}, {4, 1, 0}});
    const SurfacePoint x = evaluate(patch, 0.3, 0.4);
    EXPECT_LE(length(*x.duv) + length(*x.duu) + length(*x.dvv), kRounding) << "a bilinear surface has x_uv not 0";
    EXPECT_LE(distance(x.position, 0.3 * Point{1, 2, 3} + 0.4 * Point{-1, 0, 2} + 0.3 * Point{4, 1, 0}), kRounding);
}

TEST(Errata, SurfaceOnThreeCurvesIsRightAsPrinted) {
    const Cubic c(3);
    const auto e = c.edges();
    const auto r = [&](int k, double t) { return e[k - 1](1 - t); };
    const Surface printed = [&](double a, double b, double w) {  // (6.28)
        return a * (r(3, 1 - b) + r(2, w) - c.A()) + b * (r(1, 1 - w) + r(3, a) - c.B()) + w * (r(2, 1 - a) + r(1, b) - c.C());
    };
    EXPECT_LE(gap(printed, surface(make_three_curves(e))), kRounding);
    EXPECT_LE(largest([&](double t) { return printed(0, 1 - t, t) - e[0](t); }), kRounding);
}

TEST(Errata, ProgramOfTheExample) {
    // pj101 with {5,9,3} jumps by 5 at tj = 1/2, with {5,9,8} it does not.
    const auto first_half = [](const Point& start, double t) { return start + 2 * t * (Point{0, 15, 20} - Point{5, 9, 8}); };
    EXPECT_EQ(distance(first_half({5, 9, 3}, 0.5), {0, 15, 20}), 5);
    EXPECT_EQ(distance(first_half({5, 9, 8}, 0.5), {0, 15, 20}), 0);
    // r3 with pj002 v w: the weights sum to 1 - w^2 + v w, and the corner w = 1 is the origin.
    const Point p200{0, 10, 0}, p020{0, 0, 20}, p110{0, 10, 20}, p002{1, 14, 25}, p101{1, 13, 17}, p011{2, 7, 20};
    const auto r3 = [&](double u, double v, double w, double last) {
        return u * u * p200 + v * v * p020 + last * p002 + 2 * u * w * p101 + 2 * u * v * p110 + 2 * v * w * p011;
    };
    EXPECT_EQ(r3(0, 0, 1, 0.0 * 1.0), Point{}) << "v w, as printed";
    EXPECT_EQ(r3(0, 0, 1, 1.0 * 1.0), p002) << "w w";
    EXPECT_LE(gap([&](double u, double v, double w) { return r3(u, v, w, w * w); },
                  surface(make_bezier_triangle(2, {p200, p110, p020, p101, p011, p002}))), kRounding);
    // rfe1 is (6.28) over the edges that the three surfaces share.
    const std::array<Curve, 3> e{make_bezier({{0, 0, 20}, {10, 0, 20}, {10, 0, 0}}), make_bezier({{10, 0, 0}, {10, 10, 0}, {0, 10, 0}}),
                                 make_bezier({{0, 10, 0}, {0, 10, 20}, {0, 0, 20}})};
    const auto rf1 = [&](double t) { return e[0](1 - t); };  // rf1[tb, 1, t]
    const auto rf2 = [&](double t) { return e[1](t); };      // rf2[te, 0, t]
    const auto rf3 = [&](double s) { return e[2](s); };      // rf3[tj, s, 1]
    const Surface rfe1 = [&](double u, double v, double) {
        return u * (rf3(v) + rf2(u + v) - rf2(1)) + v * (rf1(u + v) + rf3(1 - u) - rf1(1)) + (1 - u - v) * (rf2(u) + rf1(v) - rf1(0));
    };
    EXPECT_LE(gap(rfe1, surface(make_three_curves(e))), 20 * kRounding);
}

// ---- Pavlovich 2017: Barnhill, Birkhoff and Gordon ------------------------------------------------------------------
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
