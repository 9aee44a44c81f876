// errata_triangle_test.cpp -- docs/errata.md, surfaces on a triangle (the paper of 2007 and the lecture): printed formulas that fail beside
// the corrected ones.
#include "curves/modify.h"
#include "errata_triangle.h"
#include "patches/side_vertex.h"
#include "patches/tensor_bezier.h"
#include "patches/three_curves.h"

namespace isoparm::tests {
namespace {

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
    // (6) is to be the edge u = 0 of the triangle (7). The sum over i of P_{0,2-j} C_2^j w^j (1-w)^{2-j} is three times one term, whatever j is.
    const Point B{1, 2, 3}, P01{2, 2, 0}, C{0, -1, 1}, pole[] = {B, P01, C};  // P_{0,2-j}
    const Patch triangle = make_bezier_triangle(2, {{4, 0, 0}, {3, 1, 1}, B, {2, -2, 0}, P01, C});
    const auto term = [&](int j, double w) { return (j == 1 ? 2.0 : 1.0) * std::pow(w, j) * std::pow(1 - w, 2 - j) * pole[j]; };
    const auto missed = [&](const std::function<Point(double)>& g3) { return largest([&](double w) { return g3(w) - triangle.point(0, 1 - w); }); };
    for (int j = 0; j <= 2; ++j) {
        const auto over_i = [&](double w) {
            Point sum;
            for (int i = 0; i <= 2; ++i) sum += term(j, w);
            return sum;
        };
        EXPECT_GE(missed(over_i), 1) << "j = " << j;
    }
    const auto over_j = [&](double w) {
        Point sum;
        for (int j = 0; j <= 2; ++j) sum += term(j, w);
        return sum;
    };
    EXPECT_LE(missed(over_j), kRounding);
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
    // r = a r_1 + b r_2 + c r_3, called bilinear. What is bilinear over these points, a quadrangle with one side shrunk to r_1, runs over the
    // same plane triangle with x_uv = r_3 - r_2.
    const Point r1{1, 2, 3}, r2{-1, 0, 2}, r3{4, 1, 0};
    const Surface printed = [&](double a, double b, double c) { return a * r1 + b * r2 + c * r3; };
    const Patch bilinear = make_bezier_patch({{r1, r1}, {r2, r3}}), patch = make_bezier_triangle(1, {r1, r2, r3});
    const auto mixed = [](const std::function<Point(double, double)>& x) { return x(0.75, 0.75) - x(0.75, 0.25) - x(0.25, 0.75) + x(0.25, 0.25); };
    EXPECT_EQ(length(mixed([&](double u, double v) { return printed(u, v, 1 - u - v); })), 0);
    EXPECT_NEAR(length(mixed([&](double s, double t) { return bilinear.point(s, t); })), 0.25 * distance(r2, r3), kRounding);
    EXPECT_LE(distance(bilinear.point(0.3, 0.6), printed(0.7, 0.12, 0.18)), kRounding);
    EXPECT_LE(gap(printed, surface(patch)), kRounding);
    EXPECT_EQ(length(*evaluate(patch, 0.3, 0.4).duv), 0);
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

}  // namespace
}  // namespace isoparm::tests
