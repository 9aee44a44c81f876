// condition_laws_test.cpp -- data that do not fit are refused: with the condition, the measured gap and the tolerance.
#include <gtest/gtest.h>

#include <functional>

#include "curves/arc.h"
#include "curves/bezier.h"
#include "curves/bspline.h"
#include "curves/hermite.h"
#include "curves/interpolate.h"
#include "curves/isocurve.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "error.h"
#include "patches/bezier_triangle.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/network.h"
#include "patches/side_vertex.h"
#include "patches/tensor_bezier.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

void expect_gap(const std::function<void()>& make, const std::string& condition, double gap) {
    SCOPED_TRACE(condition);
    try {
        make();
        ADD_FAILURE() << "was accepted";
    } catch (const IncompatibleError& e) {
        EXPECT_NE(e.condition().find(condition), std::string::npos) << e.condition();
        EXPECT_NEAR(e.gap(), gap, 1e-6 * gap);
        EXPECT_GT(e.gap(), e.tolerance());
        EXPECT_GT(e.tolerance(), 0);
        EXPECT_EQ(e.kind(), ErrorKind::input);
        const std::string text = e.what();
        for (const std::string& part : {e.condition(), to_text(e.gap()), to_text(e.tolerance())})
            EXPECT_NE(text.find(part), std::string::npos) << text;
    }
}
void expect_refused(const std::function<void()>& make, const std::string& words) {
    SCOPED_TRACE(words);
    try {
        make();
        ADD_FAILURE() << "was accepted";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::input);
        EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    }
}

const Point kGap{3e-4, 0, 4e-4};  // of length 5e-4
constexpr double kLength = 5e-4;
Curve moved(const Curve& c, const Point& by = kGap) { return transformed(c, Transform::translate(by)); }

TEST(Refuses, CoonsCurvesThatDoNotMeet) {
    Random r(1);
    const Frame e = random_frame(r);
    const auto bent = [](const Curve& c, bool at_end) {  // one end moves
        auto p = c(0), q = c(1);
        (at_end ? q : p) += kGap;
        return make_line(p, q);
    };
    expect_gap([&] { make_coons({bent(e.c0, false), e.c1, e.d0, e.d1}); }, "c0(0) = d0(0)", kLength);
    expect_gap([&] { make_coons({bent(e.c0, true), e.c1, e.d0, e.d1}); }, "c0(1) = d1(0)", kLength);
    expect_gap([&] { make_coons({e.c0, bent(e.c1, false), e.d0, e.d1}); }, "c1(0) = d0(1)", kLength);
    expect_gap([&] { make_coons({e.c0, bent(e.c1, true), e.d0, e.d1}); }, "c1(1) = d1(1)", kLength);
    expect_gap([&] { make_coons({e.c0, e.c1, e.d0, e.d1}, Function::polynomial({0.25, 0.75})); }, "H(0) = 0", 0.25);
    expect_gap([&] { make_coons({e.c0, e.c1, e.d0, e.d1}, Function::polynomial({0, 0.75})); }, "H(1) = 1", 0.25);
    EXPECT_NO_THROW(make_coons({moved(e.c0, {1e-13, 0, 0}), e.c1, e.d0, e.d1})) << "rounding is no gap";
}

HermiteData bilinear() {
    const Point p{0, 0, 0}, u{1, 0, 0.5}, v{0, 1, 0}, uv{0, 0, 2};  // x = u du + v dv + u v duv
    return {{make_line(p, v), make_line(u, u + uv), make_line(u, u + uv), make_line(u, u + v + uv)},
            {make_line(p, u), make_line(v, v + uv), make_line(v, v + uv), make_line(v, u + v + uv)}};
}
TEST(Refuses, HermiteDataThatDoNotFit) {
    EXPECT_NO_THROW(make_coons_hermite(bilinear()));
    const auto with = [](int k, bool f, const Curve& c) {
        HermiteData d = bilinear();
        (f ? d.f : d.g)[k] = c;
        return d;
    };
    const HermiteData d = bilinear();
    expect_gap([&] { make_coons_hermite(with(0, true, moved(d.f[0]))); }, "position at (0,0)", kLength);
    expect_gap([&] { make_coons_hermite(with(3, false, moved(d.g[3]))); }, "position at (0,1)", kLength);
    expect_gap([&] { make_coons_hermite(with(1, true, moved(d.f[1])), Twist::gregory); }, "tangent along u at (0,0)",
               kLength);
    expect_gap([&] { make_coons_hermite(with(2, true, moved(d.f[2])), Twist::average); }, "tangent along u at (1,0)",
               kLength);
    expect_gap([&] { make_coons_hermite(with(2, false, moved(d.g[2])), Twist::zero); }, "tangent along v at (0,1)",
               kLength);
    // x_u(0,v) with another slope at v = 0 only
    const Curve bent = make_bezier({d.f[1](0), d.f[1](0.5) + 0.5 * kGap, d.f[1](1)});
    expect_gap([&] { make_coons_hermite(with(1, true, bent)); }, "twist at (0,0)", kLength);
    for (auto twist : {Twist::gregory, Twist::average, Twist::zero})
        EXPECT_NO_THROW(make_coons_hermite(with(1, true, bent), twist));
}

TEST(Refuses, NetworksThatDoNotMeet) {
    Network net;
    for (int i = 0; i <= 2; ++i) net.a.push_back(make_line({double(i), 0, 0}, {double(i), 1, 0}));
    for (int j = 0; j <= 1; ++j) net.b.push_back(make_line({0, double(j), 0}, {2, double(j), 0}));
    EXPECT_NO_THROW(make_network(net));
    Network bad = net;
    bad.a[1] = make_line({1, 0, 0}, Point{1, 1, 0} + kGap);
    expect_gap([&] { make_network(bad); }, "a[1](1) = b[1](1)", kLength);
    bad = net;
    bad.b[0] = moved(bad.b[0]);
    expect_gap([&] { make_network(bad); }, "a[0](0) = b[0](0)", kLength);
    bad = net;
    bad.b.pop_back();
    expect_refused([&] { make_network(bad); }, "two");
    bad = net;
    bad.a.resize(1, net.a[0]);
    expect_refused([&] { make_network(bad); }, "two");
    Random r(1);
    Network curved;  // twists of random curves do not agree
    std::vector<std::vector<Point>> p(3);
    for (int i = 0; i <= 2; ++i)
        for (int j = 0; j <= 2; ++j) p[i].push_back(r.point({double(i), double(j), 0}, 0.3));
    for (int i = 0; i <= 2; ++i) curved.a.push_back(make_interpolate(p[i], SplineEnds::natural));
    for (int j = 0; j <= 2; ++j)
        curved.b.push_back(make_interpolate({p[0][j], p[1][j], p[2][j]}, SplineEnds::catmull_rom));
    EXPECT_THROW(make_network(curved, Twist::compatible), IncompatibleError);
    EXPECT_NO_THROW(make_network(curved));
}

TEST(Refuses, TrianglesThatDoNotClose) {
    Random r(2);
    const auto e = random_triangle(r);
    const Function h = Function::polynomial({0, 0, 1});
    const auto end_moved = [](const Curve& c) { return make_line(c(0), c(1) + kGap); };
    expect_gap([&] { make_side_vertex({end_moved(e[0]), e[1], e[2]}, h); }, "E1(1) = E2(0)", kLength);
    expect_gap([&] { make_side_vertex({e[0], end_moved(e[1]), e[2]}, h); }, "E2(1) = E3(0)", kLength);
    expect_gap([&] { make_side_vertex({e[0], e[1], end_moved(e[2])}, h); }, "E3(1) = E1(0)", kLength);
    expect_gap([&] { make_side_vertex(e, Function::polynomial({0.5, 0.5})); }, "H(0) = 0", 0.5);
    expect_gap([&] { make_side_vertex(e, Function::polynomial({0, 0.5})); }, "H(1) = 1", 0.5);
    EXPECT_THROW(make_side_vertex({reversed(e[0]), e[1], e[2]}, h), IncompatibleError)
        << "edges run round the triangle";
}

TEST(Refuses, PointsWeightsAndDegrees) {
    const Point o, nan{NAN, 0, 0}, inf{0, HUGE_VAL, 0};
    expect_refused([&] { make_bezier({}); }, "at least one point");
    expect_refused([&] { make_bezier({o, nan}); }, "point 1 is not finite");
    expect_refused([&] { make_bezier({inf, o}); }, "point 0 is not finite");
    expect_refused([&] { make_bezier({o, o}, {1}); }, "1 weights for 2 points");
    expect_refused([&] { make_bezier({o, o}, {1, 0}); }, "weight 0");
    expect_refused([&] { make_bezier({o, o}, {1, -2}); }, "weight -2");
    expect_refused([&] { make_bezier({o, o}, {1, NAN}); }, "weight nan");
    expect_refused([&] { make_bezier(std::vector<Point>(34, o)); }, "degree 33");
    expect_refused([&] { make_hermite({o}, {o}); }, "1 points");
    expect_refused([&] { make_hermite({o, o}, {o}); }, "1 tangents");
    expect_refused([&] { make_interpolate({o}, SplineEnds::natural); }, "1 points");
    expect_refused([&] { make_interpolate({o, nan, o}, SplineEnds::clamped); }, "not finite");
    expect_refused([&] { make_bezier_patch({}); }, "no points");
    expect_refused([&] { make_bezier_patch({{o, o}, {o}}); }, "1 points in row 1");
    expect_refused([&] { make_bezier_patch({{o, nan}}); }, "not finite");
    expect_refused([&] { make_bezier_patch({{o, o}}, {{1}}); }, "1 weights in row 0");
    expect_refused([&] { make_bezier_patch({{o, o}}, {{1, 0}}); }, "weight 0");
    expect_refused([&] { make_bezier_patch({{o, o}}, {{1, 1}, {1, 1}}); }, "2 rows of weights");
    expect_refused([&] { make_bezier_patch(Grid<Point>(34, {o})); }, "degree (33, 0)");
    expect_refused([&] { make_bezier_triangle(0, {o}); }, "degree 0");
    expect_refused([&] { make_bezier_triangle(33, {o}); }, "degree 33");
    expect_refused([&] { make_bezier_triangle(2, {o, o, o}); }, "3 points for degree 2, expected 6");
    expect_refused([&] { make_bezier_triangle(1, {o, o, o}, {1, 1}); }, "2 weights");
    expect_refused([&] { make_bezier_triangle(1, {o, o, o}, {1, 1, -1}); }, "weight -1");
    expect_refused([&] { make_bezier_triangle(1, {o, nan, o}); }, "not finite");
}

TEST(Refuses, KnotVectors) {
    const std::vector<Point> p(4);
    expect_refused([&] { make_bspline(0, {0, 1, 2, 3, 4}, p); }, "degree 0");
    expect_refused([&] { make_bspline(4, {0, 0, 0, 0, 0, 1, 1, 1, 1}, p); }, "4 points for degree 4");
    expect_refused([&] { make_bspline(3, {0, 0, 0, 0, 1, 1, 1}, p); }, "7 knots");
    expect_refused([&] { make_bspline(2, {0, 0, 0, 0.5, 0.25, 1, 1}, p); }, "do not decrease");
    expect_refused([&] { make_bspline(2, {0, 0, 0, NAN, 1, 1, 1}, p); }, "knot 3 is not finite");
    expect_refused([&] { make_bspline(1, {0, 0, 1, 1, 2, 2}, p); }, "found");
    expect_refused([&] { make_bspline(1, {0, 0.5, 0.5, 0.5, 1, 2}, p); }, "3 times");
    expect_refused([&] { make_bspline(3, {0, 1, 1, 1, 1, 1, 2, 3}, p); }, "found");
    expect_refused([&] { make_bspline(2, {0, 0, 0, 0.5, 1, 1, 1}, p, {1, 1, 1}); }, "3 weights");
    expect_refused([&] { make_bspline(2, {0, 0, 0, 0.5, 1, 1, 1}, p, {1, 1, 0, 1}); }, "weight 0");
    const Grid<Point> net(3, std::vector<Point>(3));
    expect_refused([&] { make_bspline_patch(2, 2, {0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1}, net); }, "knots along v");
    expect_refused([&] { make_bspline_patch(2, 2, {0, 0, 1, 0, 1, 1}, {0, 0, 0, 1, 1, 1}, net); }, "knots along u");
}

TEST(Refuses, ArcsSegmentsIsocurvesAndMaps) {
    const Point c{1, 2, 3}, x{2, 0, 0}, y{0, 2, 0};
    expect_gap([&] { make_arc(c, c + x, c + 1.25 * y); }, "not equally far", 0.5);
    expect_refused([&] { make_arc(c, c + x, c - x); }, "opposite");
    expect_refused([&] { make_arc(c, c + x, c + x); }, "differ");
    expect_refused([&] { make_arc(c, c, c + x); }, "away from its center");
    const Curve line = make_line(c, c + x);
    expect_refused([&] { segment(line, 0.5, 0.5); }, "expected one inside");
    expect_refused([&] { segment(line, -0.1, 0.5); }, "expected one inside");
    expect_refused([&] { segment(line, 0.1, 1.5); }, "expected one inside");
    expect_refused([&] { segment(line, NAN, 0.5); }, "expected one inside");
    const Patch quad = make_bezier_patch({{c, c + y}, {c + x, c + x + y}}),
                triangle = make_bezier_triangle(1, {c, c + x, c + y});
    expect_refused([&] { make_isocurve(quad, Along::u, 1.5); }, "v = 1.5");
    expect_refused([&] { make_isocurve(quad, Along::v, NAN); }, "u = nan");
    expect_refused([&] { make_isocurve(triangle, Along::v, 0.5); }, "triangle");
    expect_refused([&] { Transform::rotate({}, 30); }, "axis");
    expect_refused([&] { Transform::mirror({}, 1); }, "normal");
}

}  // namespace
}  // namespace isoparm::tests
