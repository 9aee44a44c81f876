// How patches join: the order is the one that was built in, and the bounds hold what was planted.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "continuity.h"
#include "curves/arc.h"
#include "curves/bezier.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "patches/bezier_triangle.h"
#include "patches/coons_hermite.h"
#include "patches/nielson.h"
#include "patches/tensor_bezier.h"
#include "patches/transformed.h"
#include "promises.h"
#include "shapes.h"

namespace isoparm::test {
namespace {

using Map = std::function<Point(double, double)>;

/// Blossom of a cubic f(x), by polarisation; exact up to rounding.
template <class F> Point blossom(F f, double a, double b, double c) {
    return (27.0 * f((a + b + c) / 3) - 8.0 * (f((a + b) / 2) + f((b + c) / 2) + f((a + c) / 2)) + f(a) + f(b) + f(c)) / 6.0;
}
/// The cubic map over [x0, x1] x [y0, y1], in one of the eight ways in which a square lies on itself.
Patch quad_of(const Map& f, double x0, double x1, double y0, double y1, int way = 0) {
    Grid<Point> p(4, std::vector<Point>(4));
    const auto at = [](double a, double b, int i, int k) { return k < i ? b : a; };
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            int k = way & 1 ? 3 - i : i, l = way & 2 ? 3 - j : j;
            if (way & 4) std::swap(k, l);
            const auto row = [&](double x) { return blossom([&](double y) { return f(x, y); }, at(y0, y1, l, 0), at(y0, y1, l, 1), at(y0, y1, l, 2)); };
            p[i][j] = blossom(row, at(x0, x1, k, 0), at(x0, x1, k, 1), at(x0, x1, k, 2));
        }
    return make_bezier_patch(p);
}
/// The map, of total degree 3, over a triangle of the plane; `way` turns and flips its vertices.
Patch triangle_of(const Map& f, std::array<Vec2, 3> corner, int way = 0) {
    std::rotate(corner.begin(), corner.begin() + way % 3, corner.end());
    if (way >= 3) std::swap(corner[0], corner[1]);
    std::vector<Point> p;
    for (int r = 0; r <= 3; ++r)
        for (int k = 0; k <= 3 - r; ++k) {
            std::vector<Vec2> q;
            for (int vertex = 0; vertex < 3; ++vertex)
                for (int n = 0; n < (vertex == 0 ? 3 - r - k : vertex == 1 ? k : r); ++n) q.push_back(corner[vertex]);
            const auto mean = [&](std::initializer_list<int> of) {
                Vec2 m;
                for (const int i : of) m.x += q[i].x / double(of.size()), m.y += q[i].y / double(of.size());
                return f(m.x, m.y);
            };
            p.push_back((27.0 * mean({0, 1, 2}) - 8.0 * (mean({0, 1}) + mean({1, 2}) + mean({0, 2})) + mean({0}) + mean({1}) + mean({2})) / 6.0);
        }
    return make_bezier_triangle(3, p);
}

Point cubic(double x, double y) { return {x + 0.1 * y * y, y - 0.05 * x * x * y, 0.3 * x * x - 0.2 * x * y + 0.1 * y * y * y + 0.05 * x * x * x}; }
/// The cubic with h (x - 1)^k (0, 0.6, 0.8) added for x > 1: derivatives below k agree at x = 1, the k-th one jumps by h k!.
Map planted(int k, double h) {
    return [k, h](double x, double y) { return cubic(x, y) + (h * std::pow(x - 1, k)) * Point{0, 0.6, 0.8}; };
}

ContinuityOptions options_for(const Composite& c) {
    ContinuityOptions o;
    o.size = bounding_box(c).diagonal();
    o.tolerance = 1e-9 * o.size, o.curvature = 1e-9 / o.size, o.capture = 1e-2 * o.size;
    return o;
}
Continuity checked(const Composite& c) { return find_continuity(c, options_for(c)); }
/// The one joint of two patches.
Joint joint_of(const Patch& a, const Patch& b) {
    const Continuity c = checked({{"a", a}, {"b", b}});
    EXPECT_EQ(c.joints.size(), 1u);
    return c.joints.empty() ? Joint{} : c.joints[0];
}
std::string order_text(const Joint& j, const Patch& a, const Patch& b) { return order_of(j, options_for({{"a", a}, {"b", b}})).text; }

void expect_holds(const JumpBound& b, double jump, const std::string& what) {
    EXPECT_LE(b.lower, jump * (1 + 1e-14) + 1e-15) << what;
    EXPECT_GE(b.upper, jump) << what;
    EXPECT_LE(b.upper - b.lower, 0.011 * jump + 1e-11) << what;
}

TEST(Continuity, FindsPlantedJumpsOfAllSizesInAllOrientations) {
    const char* const orders[] = {"not joined", "C0", "C1"};  // but an angle of 1e-8 is less than 1e-6 degrees
    for (int k = 0; k < 3; ++k)
        for (const double h : {1e-3, 1e-5, 1e-7, 1e-8})
            for (int way = 0; way < 8; ++way) {
                const Patch a = quad_of(cubic, 0, 1, 0, 1, (way * 3 + k) % 8), b = quad_of(planted(k, h), 1, 2, 0, 1, way);
                const Joint j = joint_of(a, b);
                const std::string what = "k " + std::to_string(k) + ", h " + std::to_string(h) + ", way " + std::to_string(way);
                expect_holds(j.jumps[k], k == 2 ? 2 * h : h, what);
                for (int below = 0; below < k; ++below) EXPECT_LE(j.jumps[below].upper, 1e-11) << what;
                EXPECT_EQ(order_text(j, a, b), k == 1 && h == 1e-8 ? "G1" : orders[k]) << what;
            }
}
TEST(Continuity, JumpsNearTheToleranceAreDecidedByIt) {
    const Patch a = quad_of(cubic, 0, 1, 0, 1), above = quad_of(planted(1, 4e-9), 1, 2, 0, 1), below = quad_of(planted(1, 1e-9), 1, 2, 0, 1);
    const Composite both{{"a", a}, {"b", above}};
    ASSERT_NEAR(bounding_box(both).diagonal(), 2.6, 0.4);  // so the tolerance is between the two
    EXPECT_EQ(order_text(joint_of(a, above), a, above), "G1");  // 2e-7 degrees
    EXPECT_EQ(order_text(joint_of(a, below), a, below), "C2");
    expect_holds(joint_of(a, below).jumps[kC1], 1e-9, "below the tolerance");
}
TEST(Continuity, SmoothPiecesOfOneSurfaceAreC2InAllOrientations) {
    for (int one = 0; one < 8; ++one)
        for (int other = 0; other < 8; ++other) {
            const Patch a = quad_of(cubic, 0, 1, 0, 1, one), b = quad_of(cubic, 1, 2, 0, 1, other);
            const Joint j = joint_of(a, b);
            EXPECT_EQ(order_text(j, a, b), "C2");
            EXPECT_LE(j.jumps[kG1].upper, 1e-9);
            EXPECT_LE(j.jumps[kG2].upper, 1e-10);
        }
}
TEST(Continuity, GeometricOrdersDoNotNeedEqualSpeeds) {
    const double h = 0.01;
    const Map faster = [](double x, double y) { return cubic(1 + 2 * x, y); };
    const Map bent = [&](double x, double y) { return faster(x, y) + Point{0, 0, h * x * x}; };
    const Patch a = quad_of(cubic, 0, 1, 0, 1, 5), g2 = quad_of(faster, 0, 1, 0, 1, 6), g1 = quad_of(bent, 0, 1, 0, 1, 3);
    EXPECT_EQ(order_text(joint_of(a, g2), a, g2), "G2");
    const Joint j = joint_of(a, g1);
    EXPECT_EQ(order_text(j, a, g1), "G1");
    EXPECT_GT(j.jumps[kG2].lower, 1e-3);
    // c1 is |x_x(1,y)|: the speed doubles.
    double speed = 0;
    for (int k = 0; k <= 100; ++k) {
        const double y = k / 100.0;
        speed = std::max(speed, length({1, -0.1 * y, 0.6 - 0.2 * y + 0.15}));
    }
    expect_holds(j.jumps[kC1], speed, "twice the speed");
}
TEST(Continuity, TrianglesJoinQuadsAndTriangles) {
    const std::array<Vec2, 3> right{{{1, 0}, {2, 0.5}, {1, 1}}}, left{{{1, 0}, {0, 0.5}, {1, 1}}};
    const double h = 1e-6;
    for (int way = 0; way < 6; ++way) {
        const Patch quad = quad_of(cubic, 0, 1, 0, 1, way), t = triangle_of(cubic, left, (way + 2) % 6);
        for (const Patch& a : {quad, t}) {
            const Patch smooth = triangle_of(cubic, right, way), c1 = triangle_of(planted(2, h), right, way), c0 = triangle_of(planted(1, h), right, way), gap = triangle_of(planted(0, h), right, way);
            EXPECT_EQ(order_text(joint_of(a, smooth), a, smooth), "C2");
            EXPECT_EQ(order_text(joint_of(a, c1), a, c1), "C1");
            EXPECT_EQ(order_text(joint_of(a, c0), a, c0), "C0");
            EXPECT_EQ(order_text(joint_of(a, gap), a, gap), "not joined");
            expect_holds(joint_of(a, c1).jumps[kC2], 2 * h, "second derivative");
            expect_holds(joint_of(a, c0).jumps[kC1], h, "first derivative");
            expect_holds(joint_of(a, gap).jumps[kC0], h, "position");
        }
    }
}
TEST(Continuity, AnEdgeMayMeetSeveral) {
    Composite c{{"long", quad_of(cubic, 0, 1, 0, 2, 1)}, {"low", quad_of(cubic, 1, 2, 0, 1, 4)}, {"high", quad_of(cubic, 1, 2, 1, 2, 2)}};
    const Continuity found = checked(c);
    ASSERT_EQ(found.joints.size(), 3u);
    EXPECT_EQ(std::count_if(found.joints.begin(), found.joints.end(), [](const Joint& j) { return j.kind == Joint::Kind::t_joint; }), 2);
    for (const Joint& j : found.joints) EXPECT_EQ(order_of(j, options_for(c)).text, "C2");
    EXPECT_EQ(found.open.size(), 7u);
    // The same with a gap: what is left of the long edge stays open.
    const double h = 1e-3;
    c.pop_back();
    c[1].patch = transformed(c[1].patch, Transform::translate({h, 0, 0}));
    const Continuity apart = checked(c);
    ASSERT_EQ(apart.joints.size(), 1u);
    EXPECT_EQ(apart.joints[0].kind, Joint::Kind::gap);
    EXPECT_EQ(order_of(apart.joints[0], options_for(c)).text, "not joined");
    EXPECT_EQ(apart.open.size(), 7u);
}
TEST(Continuity, ASphereOfMirroredOctantsIsSmoothUpToItsPoles) {
    const Composite c = tests::sphere();
    const Continuity found = checked(c);
    ASSERT_EQ(found.joints.size(), 12u);
    EXPECT_EQ(found.poles.size(), 8u);
    for (const Joint& j : found.joints) {
        EXPECT_EQ(order_of(j, options_for(c)).text, "C1");
        EXPECT_LE(j.jumps[kG1].upper, 1e-9);
        EXPECT_GT(j.jumps[kC2].lower, 1.6);
    }
}
TEST(Continuity, ASheetFoldedOnItselfTurnsBy180Degrees) {
    const Patch p = quad_of(cubic, 0, 1, 0, 1);
    const Continuity found = checked({{"a", p}, {"b", p}});
    ASSERT_EQ(found.joints.size(), 4u);
    for (const Joint& j : found.joints) EXPECT_GT(j.jumps[kG1].lower, 179.99);
}
TEST(Continuity, PatchesFarApartAreNotJoined) {
    const Continuity found = checked({{"a", quad_of(cubic, 0, 1, 0, 1)}, {"b", quad_of(cubic, 1.3, 2.3, 0, 1)}});
    EXPECT_TRUE(found.joints.empty());
    EXPECT_EQ(found.open.size(), 8u);
}
TEST(Continuity, NarrowStripsAndThinPlatesHaveNoGaps) {
    const Patch plate = quad_of([](double x, double y) { return Point{x, y, 0}; }, 0, 1, 0, 1), above = transformed(plate, Transform::translate({0, 0, 1e-3})),
                strip = transformed(plate, Transform::scale({5e-3, 1, 1})), beside = transformed(plate, Transform::translate({1 + 1e-3, 0, 1e-3}));
    EXPECT_TRUE(checked({{"plate", plate}, {"above", above}}).joints.empty());
    EXPECT_TRUE(checked({{"strip", strip}}).joints.empty());
    EXPECT_EQ(checked({{"plate", plate}, {"beside", beside}}).joints.size(), 1u);
}

TEST(Continuity, AThirdSheetAlongAJointIsCompared) {
    const auto sheet = [](double x, double z, bool reversed) {  // from the edge x = z = 0
        std::vector<std::vector<Point>> net(2, std::vector<Point>(3));
        for (int j = 0; j < 3; ++j) net[0][reversed ? 2 - j : j] = {0, double(j), j == 1 ? 0.5 : 0}, net[1][reversed ? 2 - j : j] = {x, double(j), (j == 1 ? 0.5 : 0) + z};
        return make_bezier_patch(net);
    };
    for (const bool reversed : {false, true}) {
        const Continuity c = checked({{"A", sheet(1, 0, false)}, {"B", sheet(-1, 0, false)}, {"D", sheet(0, 1, reversed)}});
        ASSERT_EQ(c.joints.size(), 2u);
        EXPECT_EQ(c.open.size(), 9u);
        for (const Joint& j : c.joints) {
            EXPECT_LT(j.jumps[kC0].upper, 1e-12);
            const bool third = j.b.member == 2;
            EXPECT_EQ(j.jumps[kG1].upper < 1e-6, !third);
            if (third) { EXPECT_GT(j.jumps[kG1].lower, 89); }
            if (third) { EXPECT_EQ(j.b.t0 > j.b.t1, reversed); }
        }
    }
}
TEST(Continuity, ASeamIsAJointOfAPatchWithItself) {
    Grid<Point> p;
    for (const Point& q : {Point{0, 0, 0}, Point{3, 1, 0}, Point{-3, 2, 0}, Point{0, 0, 0}}) p.push_back({q, q + Point{0, 0.2, 1}});
    const Continuity found = checked({{"tube", make_bezier_patch(p)}});
    ASSERT_EQ(found.joints.size(), 1u);
    EXPECT_EQ(found.joints[0].kind, Joint::Kind::seam);
    expect_holds(found.joints[0].jumps[kC1], 3 * length(Point{3, 1, 0} + Point{-3, 2, 0}), "3 |(p1 - p0) - (p3 - p2)|");
}
TEST(Continuity, LinesBetweenCellsAreMeasuredToo) {
    Grid<Point> p(5, std::vector<Point>(4));
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 4; ++j) p[i][j] = {double(i), double(j), 0.3 * i * i - 0.1 * i * j};
    const Patch simple = make_bspline_patch(3, 3, {0, 0, 0, 0, 0.4, 1, 1, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}, p);
    Continuity found = checked({{"s", simple}});
    ASSERT_EQ(found.lines.size(), 1u);
    EXPECT_EQ(order_of(found.lines[0], options_for({{"s", simple}})).text, "C2");
    const Patch twice = make_bspline_patch(2, 3, {0, 0, 0, 0.4, 0.4, 1, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}, p);
    EXPECT_EQ(order_of(checked({{"s", twice}}).lines[0], options_for({{"s", twice}})).text, "C0");
}
TEST(Continuity, EdgesOfOtherSpeedAreComparedPointByPoint) {
    const Point across{1, 0.2, 0.1};
    const auto ruled = [&](const std::vector<Point>& edge, double way, double lift) {
        Grid<Point> p(2);
        for (const Point& q : edge) p[0].push_back(q + Point{0, 0, lift}), p[1].push_back(q + way * across + Point{0, 0, lift});
        return make_bezier_patch(p);
    };
    // One parabola, run evenly and not.
    const std::vector<Point> even{{0, 0, 0}, {0, 1, 1}, {0, 2, 0}};
    const double s = 0.8;  // weights 1, s, s^2: the same curve
    const Patch a = ruled(even, -1, 0);
    const auto rational = [&](double lift) {
        return make_bezier_patch({{{0, 0, lift}, {0, 1, 1 + lift}, {0, 2, lift}}, {Point{0, 0, lift} + across, Point{0, 1, 1 + lift} + across, Point{0, 2, lift} + across}}, {{1, s, s * s}, {1, s, s * s}});
    };
    const Patch b = rational(0), above = rational(1e-3);
    const Joint joint = joint_of(a, b), gap = joint_of(a, above);
    EXPECT_FALSE(joint.affine);
    EXPECT_EQ(order_text(joint, a, b), "G2");
    EXPECT_LE(joint.jumps[kC0].upper, 1e-10);
    EXPECT_EQ(order_text(gap, a, above), "not joined");
    EXPECT_LE(gap.jumps[kC0].lower, 1e-3);
    EXPECT_GE(gap.jumps[kC0].upper, 1e-3 * std::cos(std::atan(2.0)));  // the curves are at most that steep
}
/// A boundary that is moved by h is not interpolated, by h; the one that the surface was made of is.
TEST(Continuity, ResidualsOfInterpolationAreCertified) {
    const double h = 1e-6;
    const Curve c0 = make_bezier({{0, 0, 0}, {1, 0.3, 1}, {2, -0.5, 0}, {3, 0, 0}}), c1 = make_arc({1.5, 4, 0}, {0, 4, 0}, {1.5, 4, 1.5}), d0 = make_line({0, 0, 0}, {0, 4, 0}), d1 = make_line({3, 0, 0}, {1.5, 4, 1.5});
    const CoonsCurves curves{c0, c1, d0, d1};
    const Patch patch = make_coons(curves);
    for (const Promise& kept : examine(curves).promises) {
        EXPECT_LE(bound_residual(patch, kept, 1e-9).upper, 1e-9) << kept.what;
        Promise broken = kept;
        broken.curve = transformed(kept.curve, Transform::translate({0.6 * h, 0, 0.8 * h}));
        expect_holds(bound_residual(patch, broken, 1e-9), h, kept.what);
    }
}
/// Hermite data whose four corners' twists disagree: a part along z of the cross derivatives that vanishes with its slope given at the ends.
HermiteData disagreeing_twists() {
    const auto b = [](std::vector<Point> p) { return make_bezier(std::move(p)); };
    return {{b({{0, 0, 0}, {0, 1, 1}, {0, 2, 0}}), b({{2, 0, 2}, {2, 0.5, 9}, {2.1, 0, 2}, {2, 0, 2}}), b({{2, 0, -2}, {2, 0.3, 5}, {2, 0, -2}}), b({{2, 0, 0}, {2, 1, 1}, {2, 2, 0}})},
            {b({{0, 0, 0}, {1, 0, 1}, {2, 0, 0}}), b({{0, 2, 2}, {0.2, 2, -3}, {0, 2, 2}}), b({{0, 2, -2}, {0, 2, 4}, {0, 2.2, 1}, {0, 2, -2}}), b({{0, 2, 0}, {1, 2, 1}, {2, 2, 0}})}};
}
TEST(Continuity, GregorysSquareIsOnItsEdgesWhatStandsForItThere) {
    const HermiteData data = disagreeing_twists();
    const Patch gregory = make_coons_hermite(data, Twist::gregory);
    for (const bool of_f : {true, false}) {
        double slack = 1;
        const Patch on_edge = gregory_on_edges(data, of_f, slack);
        EXPECT_LT(slack, 1e-13);
        double most = 0, away = 0;
        for (const double edge : {0.0, 1.0})
            for (int k = 1; k < 64; ++k) {
                const double t = k / 64.0, u = of_f ? edge : t, v = of_f ? t : edge;
                const PointJet x = gregory.jet(u, v), y = on_edge.jet(u, v);
                for (int axis = 0; axis < 3; ++axis)
                    for (const auto& [i, j] : {std::pair(0, 0), {1, 0}, {0, 1}}) most = std::max(most, std::fabs(x[axis].coefficient(i, j) - y[axis].coefficient(i, j)));
                const Point p = gregory.point(0.3, t), q = on_edge.point(0.3, t);
                away = std::max(away, distance(p, q));
            }
        EXPECT_LT(most, 1e-13) << of_f;
        EXPECT_GT(away, 1e-2) << "inside it is another surface";
    }
}
TEST(Continuity, GregorysCrossDerivativesAreProved) {
    const HermiteData data = disagreeing_twists();
    const Patch gregory = make_coons_hermite(data, Twist::gregory);
    const DataReport report = examine(data, Twist::gregory);
    ASSERT_EQ(report.promises.size(), 8u);
    ASSERT_EQ(report.twists.size(), 4u);
    for (const TwistPair& t : report.twists) EXPECT_GT(t.gap, 1);
    for (Promise p : report.promises) {
        const JumpBound kept = bound_residual(gregory, p, 1e-11);
        EXPECT_LT(kept.upper, 1e-11) << p.what;
        EXPECT_EQ(kept.lower, 0) << p.what;
        p.curve = transformed(p.curve, Transform::translate({0, 0, 1e-6}));  // broken by a millionth
        const JumpBound broken = bound_residual(gregory, p, 1e-11);
        EXPECT_NEAR(broken.lower, 1e-6, 1e-9) << p.what;
        EXPECT_NEAR(broken.upper, 1e-6, 2e-8) << p.what;
    }
    for (Promise p : examine(data, Twist::average).promises) EXPECT_FALSE(p.on_edge) << "the mean is a polynomial by itself";
}
/// Cross derivatives with slopes of their own at the vertices: on each edge the interpolant of its own ray stands for the surface, and its promise is proved.
TEST(Continuity, NielsonsCrossDerivativesAreProved) {
    const std::array<Curve, 3> E{make_bezier({{0, 2, 0}, {0, 1, 0.8}, {0, 0, 0}}), make_bezier({{0, 0, 0}, {1, 0, 0.7}, {2, 0, 0}}), make_bezier({{2, 0, 0}, {1, 1, 0.9}, {0, 2, 0}})};
    const std::array<Curve, 3> D{make_bezier({{2, -1, 1}, {2, -1, 5}, {2, -1, 0.6}}), make_bezier({{-1, 2, 0.9}, {-1, 2, -3}, {-1, 2, 1.1}}), make_bezier({{-1, -1, 0.5}, {-1, -1, 2}, {-1, -1, 0.7}})};
    const Patch patch = make_nielson_c1(E, D);
    const DataReport report = examine_nielson(E, D);
    ASSERT_EQ(report.promises.size(), 6u);
    for (const Promise& p : report.promises) {
        ASSERT_TRUE(p.on_edge);
        for (int k = 1; k < 64; ++k) {
            const double s = k / 64.0, u = p.line.from.x + s * (p.line.to.x - p.line.from.x), v = p.line.from.y + s * (p.line.to.y - p.line.from.y);
            const PointJet x = patch.jet(u, v), y = p.on_edge->jet(u, v);
            for (int axis = 0; axis < 3; ++axis)
                for (const auto& [i, j] : {std::pair(0, 0), {1, 0}, {0, 1}}) EXPECT_NEAR(x[axis].coefficient(i, j), y[axis].coefficient(i, j), 1e-12) << p.what << " at " << s;
        }
        EXPECT_GT(distance(patch.point(0.3, 0.3), p.on_edge->point(0.3, 0.3)), 1e-3) << "inside it is another surface";
        const JumpBound kept = bound_residual(patch, p, 1e-7);
        EXPECT_LE(kept.upper, 1e-7) << p.what;
        EXPECT_EQ(kept.lower, 0) << p.what;
        Promise broken = p;
        broken.curve = transformed(p.curve, Transform::translate({0, 0, 1e-3}));
        EXPECT_NEAR(bound_residual(patch, broken, 1e-7).lower, 1e-3, 1e-6) << p.what;
    }
}
/// What jets of both sides say at many places of a joint: no sample is above the upper bound, and the lower bound is reached at its place.
TEST(Continuity, BoundsHoldAllSamplesOfRandomPatches) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-0.3, 0.3);
    for (int round = 0; round < 6; ++round) {
        Grid<Point> p(4, std::vector<Point>(4)), q = p;
        Grid<double> weights(4, std::vector<double>(4, 1)), other = weights;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                p[i][j] = {i + number(random), j + number(random), number(random)}, q[i][j] = {3 + i + number(random), j + number(random), number(random)};
                if (round % 2) weights[i][j] = 1 + number(random), other[i][j] = 1 + number(random);
            }
        for (int j = 0; j < 4; ++j) q[0][j] = p[3][j], other[0][j] = weights[3][j];
        const Patch a = make_bezier_patch(p, weights), b = make_bezier_patch(q, other);
        const Joint joint = joint_of(a, b);
        std::array<double, kMeasures> most{};
        for (int k = 0; k <= 400; ++k) {
            const double t = k / 400.0;
            const PointJet x = a.jet(1, t), y = b.jet(0, t);
            const auto part = [](const PointJet& j, int i, int l) { return Point{j.x.coefficient(i, l), j.y.coefficient(i, l), j.z.coefficient(i, l)}; };
            const auto normal = [&](const PointJet& j) { return cross(part(j, 1, 0), part(j, 0, 1)); };
            const auto curvature = [&](const PointJet& j) {  // normal curvature across, from the shape in a frame of the tangent plane
                const Point t1 = normalized(part(j, 0, 1)), n = normalized(normal(j)), across = cross(t1, n), su = part(j, 1, 0), sv = part(j, 0, 1);
                const double det = dot(su, across) * dot(sv, t1) - dot(su, t1) * dot(sv, across), c = dot(sv, t1) / det, d = -dot(su, t1) / det;  // c su + d sv = across
                return 2 * c * c * dot(part(j, 2, 0), n) + 2 * c * d * dot(part(j, 1, 1), n) + 2 * d * d * dot(part(j, 0, 2), n);
            };
            const std::array<double, kMeasures> now{distance(part(x, 0, 0), part(y, 0, 0)), distance(part(x, 1, 0), part(y, 1, 0)), 2 * distance(part(x, 2, 0), part(y, 2, 0)),
                                                    std::atan2(length(cross(normal(x), normal(y))), dot(normal(x), normal(y))) * 180 / M_PI, std::fabs(curvature(x) - curvature(y))};
            for (int m = 0; m < kMeasures; ++m) most[m] = std::max(most[m], now[m]);
        }
        for (int m = 0; m < kMeasures; ++m) {
            EXPECT_LE(most[m], joint.jumps[m].upper + 1e-9) << "measure " << m << ", round " << round;
            EXPECT_LE(joint.jumps[m].lower, most[m] * 1.001 + 1e-9) << "measure " << m << ", round " << round;
            if (m == kC0) continue;
            EXPECT_GE(joint.jumps[m].lower, 0.989 * joint.jumps[m].upper) << "measure " << m << ", round " << round;
        }
    }
}

}  // namespace
}  // namespace isoparm::test
