// triangle_laws_test.cpp -- what the surfaces over three edges promise: cross derivatives and tangent planes along whole edges, precision,
// parts that add up, and data that are refused.
#include <gtest/gtest.h>

#include "curves/bezier.h"
#include "curves/bspline.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "error.h"
#include "patches/bbg.h"
#include "patches/bezier_triangle.h"
#include "patches/nielson.h"
#include "patches/side_vertex.h"
#include "patches/three_curves.h"
#include "samples.h"
#include "scalar/elementary.h"

namespace isoparm::tests {
namespace {

using Three = std::array<Curve, 3>;

/// Derivative at E_k(t) in the direction of the median.
Point median_derivative(const Patch& patch, int k, double t) {
    const Vec2 p = patch.edge_point(k, t);
    const SurfacePoint s = evaluate(patch, p.x, p.y);
    const double a = k == 0 ? 1 : -0.5, b = k == 1 ? 1 : -0.5;
    return a * s.du.value() + b * s.dv.value();
}
void expect_cross(const Patch& patch, const Three& d, double tolerance) {
    for (int k = 0; k < 3; ++k)
        for (int n = 0; n <= 40; ++n) EXPECT_LE(distance(median_derivative(patch, k, n / 40.0), d[k](n / 40.0)), tolerance) << "D" << k + 1 << " at " << n / 40.0;
}

TEST(C1Triangles, InterpolateCrossDerivativesWhateverTheTwists) {
    for (int seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const Three e = random_triangle(r), d = random_cross(r, e);
        expect_cross(make_bbg_c1(e, d), d, 1e-12 * 20);
        expect_cross(make_nielson_c1(e, d), d, 1e-12 * 20);
        // A projector alone does so on its own edges only.
        EXPECT_LE(distance(median_derivative(make_bbg_c1(e, d, TrianglePart::of_A), 1, 0.4), d[1](0.4)), 1e-12 * 20);
        EXPECT_GE(distance(median_derivative(make_bbg_c1(e, d, TrianglePart::of_A), 0, 0.4), d[0](0.4)), 1e-6);
        EXPECT_LE(distance(median_derivative(make_nielson_c1(e, d, TrianglePart::of_C), 2, 0.4), d[2](0.4)), 1e-12 * 20);
    }
}

TEST(C1Triangles, NielsonG1TouchesTheGivenPlanesAlongTheEdges) {
    for (int seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const Three e = random_triangle(r), n = normals_of(e, random_cross(r, e, 0.2));
        const Patch patch = make_nielson_g1(e, n);
        for (int k = 0; k < 3; ++k)
            for (int i = 1; i < 40; ++i) {
                const Point given = normalized(n[k](i / 40.0));
                EXPECT_LE(std::abs(dot(median_derivative(patch, k, i / 40.0), given)), 1e-12 * 20) << "N" << k + 1 << " at " << i / 40.0;
            }
        for (const Vec2 at : {Vec2{1, 0}, Vec2{0, 1}, Vec2{0, 0}}) EXPECT_TRUE(finite(evaluate(patch, at.x, at.y).position));
    }
}

/// The edges of a Bezier triangle of degree 3, and its cross derivatives.
struct Cubic {
    Patch patch;
    Three e, d;
};
Cubic random_cubic_triangle(Random& r, bool quadratic) {
    std::vector<Point> b;  // rows from the edge w = 0
    const int n = quadratic ? 2 : 3;
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n - k; ++j) b.push_back(r.point({2.0 * (n - j - k) / n, 2.0 * j / n, 0}, 0.3));
    const Patch patch = make_bezier_triangle(n, b);
    std::vector<Curve> e, d;
    for (int k = 0; k < 3; ++k) {
        const auto at = [&](double t) {
            const Vec2 p = patch.edge_point(k, t);
            return patch.point(p.x, p.y);
        };
        // Curves of degree 3 and 2 through their values at the ends and in between.
        const Point p0 = at(0), p1 = at(1 / 3.0), p2 = at(2 / 3.0), p3 = at(1);
        e.push_back(make_bezier({p0, (-5.0 * p0 + 18.0 * p1 - 9.0 * p2 + 2.0 * p3) / 6.0, (2.0 * p0 - 9.0 * p1 + 18.0 * p2 - 5.0 * p3) / 6.0, p3}));
        const Point d0 = median_derivative(patch, k, 0), d1 = median_derivative(patch, k, 0.5), d2 = median_derivative(patch, k, 1);
        d.push_back(make_bezier({d0, 2.0 * d1 - 0.5 * d0 - 0.5 * d2, d2}));
    }
    return {patch, {e[0], e[1], e[2]}, {d[0], d[1], d[2]}};
}
double largest_distance(const Patch& a, const Patch& b) {
    Random r(3);
    double most = 0;
    for (int n = 0; n < 60; ++n) {
        const Vec2 p = random_parameter(r, a);
        most = std::max(most, distance(a.point(p.x, p.y), b.point(p.x, p.y)));
    }
    return most;
}

TEST(TrianglePrecision, IsWhatTheDocumentationSays) {
    using Kind = BbgForm::Kind;
    for (int seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const Cubic q = random_cubic_triangle(r, true), c = random_cubic_triangle(r, false);
        EXPECT_LE(largest_distance(make_bbg_c1(c.e, c.d), c.patch), 1e-13 * 20);
        EXPECT_LE(largest_distance(make_nielson_c1(c.e, c.d), c.patch), 1e-13 * 20);
        for (int i = 1; i <= 3; ++i)
            for (int j = 1; j <= 3; ++j)
                if (i != j) EXPECT_LE(largest_distance(make_bbg(q.e, {Kind::boolean, i, j}), q.patch), 1e-13 * 20);
        EXPECT_LE(largest_distance(make_bbg(q.e, {Kind::symmetric}), q.patch), 1e-13 * 20);
        EXPECT_GE(largest_distance(make_bbg(q.e, {Kind::convex}), q.patch), 1e-6);
        EXPECT_GE(largest_distance(make_three_curves(q.e), q.patch), 1e-6);
        EXPECT_GE(largest_distance(make_bbg(c.e, {Kind::symmetric}), c.patch), 1e-6);
    }
}

TEST(Bbg, IsTheBooleanSumOfItsProjectors) {
    Random r(4);
    const Three e = random_triangle(r);
    using Kind = BbgForm::Kind;
    const auto chord = [&](int k) { return make_line(e[k](0), e[k](1)); };
    // Pi Pj is Pi of the surface Pj, whose own edge E_j is a chord.
    for (int i = 1; i <= 3; ++i)
        for (int j = 1; j <= 3; ++j) {
            if (i == j) continue;
            Three replaced = e;
            replaced[j - 1] = chord(j - 1);
            const Patch sum = make_bbg(e, {Kind::boolean, i, j}), pi = make_bbg(e, {Kind::projector, i}), pj = make_bbg(e, {Kind::projector, j}),
                        both = make_bbg(replaced, {Kind::projector, i}), product = make_bbg(e, {Kind::product, i, j});
            for (int n = 0; n < 20; ++n) {
                const Vec2 p = random_parameter(r, sum);
                EXPECT_LE(distance(sum.point(p.x, p.y), pi.point(p.x, p.y) + pj.point(p.x, p.y) - both.point(p.x, p.y)), 1e-14 * 20) << i << j;
                EXPECT_LE(distance(product.point(p.x, p.y), both.point(p.x, p.y)), 1e-14 * 20) << i << j;
            }
        }
    EXPECT_GE(largest_distance(make_bbg(e, {Kind::boolean, 1, 2}), make_bbg(e, {Kind::boolean, 2, 1})), 1e-3);
    EXPECT_THROW(make_bbg(e, {Kind::boolean, 2, 2}), Error);
    EXPECT_THROW(make_bbg(e, {Kind::projector, 4}), Error);
}

/// A line that folds at one point.
struct Kinked {
    Point from, to;
    double at, begin = 0, end = 1;
    template <class S> Vec3<S> operator()(const S& t) const {
        const S fold = absolute(S(t - at)) - (at + t * (1 - 2 * at));
        return {S(from.x + t * (to.x - from.x)), S(from.y + t * (to.y - from.y)), S(from.z + t * (to.z - from.z) + fold)};
    }
    Vec3<Polynomial> operator()(const Polynomial&) const { return {Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()}; }
};

TEST(SideVertex, PartsAddUp) {
    Random r(5);
    const Three e = random_triangle(r);
    for (auto form : {SideVertexForm::delta, SideVertexForm::seed})
        for (const auto& h : {Function::polynomial({0, 1}), Function::polynomial({0, 0, 0, 2, -1})}) {
            const auto at = [&](SideVertexPart part, Vec2 p) { return make_side_vertex(e, h, form, part).point(p.x, p.y); };
            for (int n = 0; n < 10; ++n) {
                const Vec2 p = random_parameter(r, make_side_vertex(e, h, form));
                using S = SideVertexPart;
                EXPECT_LE(distance(at(S::sum, p), at(S::s1, p) + at(S::s2, p) + at(S::s3, p) - 2.0 * at(S::s4, p)), 1e-14 * 20);
            }
        }
    // H = t: s1 is ruled between E2 and the vertex B, s4 the plane triangle, in both forms.
    for (auto form : {SideVertexForm::delta, SideVertexForm::seed}) {
        const Patch s1 = make_side_vertex(e, Function::polynomial({0, 1}), form, SideVertexPart::s1), s4 = make_side_vertex(e, Function::polynomial({0, 1}), form, SideVertexPart::s4);
        EXPECT_LE(distance(s1.point(0.3 * 0.6, 0.4), 0.6 * e[1](0.3) + 0.4 * e[0](0)), 1e-14 * 4);
        EXPECT_LE(distance(s4.point(0.2, 0.3), 0.2 * e[2](0) + 0.3 * e[0](0) + 0.5 * e[1](0)), 1e-14 * 4);
    }
}

TEST(Refuses, TriangleDataThatDoNotFit) {
    Random r(6);
    const Three e = random_triangle(r), d = random_cross(r, e), n = normals_of(e, d);
    const auto moved = [](const Curve& c) { return transformed(c, Transform::translate({3e-4, 0, 4e-4})); };
    const auto refused = [](auto make, const std::string& words) {
        try {
            make();
            ADD_FAILURE() << "was accepted: " << words;
        } catch (const Error& x) {
            EXPECT_EQ(x.kind(), ErrorKind::input);
            EXPECT_NE(std::string(x.what()).find(words), std::string::npos) << x.what();
        }
    };
    refused([&] { make_three_curves({moved(e[0]), e[1], e[2]}); }, "E1(1) = E2(0)");
    refused([&] { make_bbg({e[0], e[1], moved(e[2])}, {}); }, "E2(1) = E3(0)");
    refused([&] { make_bbg_c1(e, {d[0], moved(d[1]), d[2]}); }, "D2(0) = -E1'(1) - E2'(0)/2 (vertex C)");
    refused([&] { make_nielson_c1(e, {d[0], make_bezier({d[1](0), d[1](1) + Point{1e-3, 0, 0}}), d[2]}); }, "D2(1) = E3'(0) + E2'(1)/2 (vertex A)");
    const Curve bent = make_bspline(1, {0, 0, 0.5, 1, 1}, {e[0](0), {0.3, 0.7, 1}, e[0](1)});
    refused([&] { make_bbg_c1({bent, e[1], e[2]}, d); }, "the edge E1 with a corner at 0.5");
    EXPECT_NO_THROW(make_bbg({bent, e[1], e[2]}, {}));
    for (const double at : {0.5, 0.3}) {  // a corner that no break tells of
        const Curve kinked = make_curve(Kinked{e[0](0), e[0](1), at});
        refused([&] { make_bbg_c1({kinked, e[1], e[2]}, d); }, "the edge E1 with a derivative that is not proved to be continuous near " + std::string(at == 0.5 ? "0.5" : "0.3"));
    }
    EXPECT_NO_THROW(make_nielson_g1(e, n));
    refused([&] { make_nielson_g1(e, {n[0], n[1], moved(n[2])}); }, "N3 normal to E3'");
    const auto line = [](const Point& a, const Point& b) { return make_line(a, b); };
    const Three flat{line({0, 1, 0}, {0, 0, 0}), line({0, 0, 0}, {1, 0, 0}), line({1, 0, 0}, {0, 1, 0})};
    const Curve up = line({0, 0, 1}, {0, 0, 1}), down = line({0, 0, -2}, {0, 0, -1}), turning = line({0, 0, 1}, {0, 1, 1}), through = line({0, 0, 1}, {0, 0, -1});
    EXPECT_NO_THROW(make_nielson_g1(flat, {up, down, up})) << "normals may point to either side";
    const Patch plain = make_nielson_g1(e, n);
    for (const double length : {1e200, 1e-170}) {
        const auto longer = [&](const Curve& c) { return transformed(c, Transform::scale({length, length, length})); };
        EXPECT_LE(largest_distance(make_nielson_g1(e, {longer(n[0]), n[1], longer(n[2])}), plain), 1e-12) << length;
    }
    refused([&] { make_nielson_g1(flat, {up, turning, up}); }, "N2(1) parallel to N3(0) (vertex A)");
    refused([&] { make_nielson_g1(flat, {up, up, through}); }, "the normal N3");
}

TEST(C1Triangles, OfLinesAreThePlaneAlsoAtTheVertices) {
    const auto line = [](const Point& a, const Point& b) { return make_line(a, b); };
    const Point a{1, 0, 0}, b{0, 1, 0.5}, c{0, 0, 0};
    const Three e{line(b, c), line(c, a), line(a, b)};
    const auto constant = [&](const Point& p) { return line(p, p); };
    const Three d{constant(a - 0.5 * b - 0.5 * c), constant(b - 0.5 * c - 0.5 * a), constant(c - 0.5 * a - 0.5 * b)};
    const Point normal = cross(a, b);
    for (const Patch& patch : {make_bbg_c1(e, d), make_nielson_c1(e, d), make_nielson_g1(e, {constant(normal), constant(normal), constant(normal)})})
        for (const Vec2 p : {Vec2{1, 0}, {0, 1}, {0, 0}, {0.2, 0.3}, {0.5, 0.5}}) {
            const SurfacePoint s = evaluate(patch, p.x, p.y);
            EXPECT_LE(distance(s.position, p.x * a + p.y * b), 1e-15 * 4);
            ASSERT_TRUE(s.du && s.dv && s.normal) << p.x << ", " << p.y;
            EXPECT_LE(distance(*s.normal, normalized(normal)), 1e-14 * 4);
        }
}

}  // namespace
}  // namespace isoparm::tests
