// Surfaces over rational curves and formulas beside their edges: exact forms and models against the derivatives of the surface itself, and planted jumps in all orientations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "continuity.h"
#include "curves/arc.h"
#include "curves/bezier.h"
#include "curves/bspline.h"
#include "curves/modify.h"
#include "patches/cone.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/gordon.h"
#include "patches/lagrange.h"
#include "patches/network.h"
#include "patches/ruled.h"
#include "patches/transformed.h"
#include "patches/translational.h"
#include "promises.h"
#include "scalar/elementary.h"

namespace isoparm::test {
namespace {

struct Wave {
    Point from, step, height;
    double begin = 0, end = 1;
    template <class S> auto operator()(const S& t) const {
        const auto s = sin(t * std::numbers::pi);
        return Vec3<S>{S(from.x + t * step.x + s * height.x), S(from.y + t * step.y + s * height.y), S(from.z + t * step.z + s * height.z)};
    }
};
Curve rational(const Point& a, const Point& b, const Point& bend, double weight = 1.4) {
    return make_bezier({a, (2.0 / 3) * a + (1.0 / 3) * b + bend, (1.0 / 3) * a + (2.0 / 3) * b - 0.5 * bend, b}, {1, weight, 0.8, 1.1});
}
Curve nurbs(const Point& a, const Point& b, const Point& bend) {
    return make_bspline(3, {0, 0, 0, 0, 0.375, 1, 1, 1, 1}, {a, 0.75 * a + 0.25 * b + bend, 0.5 * (a + b) - bend, 0.25 * a + 0.75 * b, b}, {1, 1.3, 0.7, 1.2, 1});
}
const Point A{0, 0, 0}, B{2, 0, 0.5}, C{0, 2, 0.25}, D{2.5, 2, -0.5};

CoonsCurves rational_frame() { return {rational(A, B, {0, 0.2, 0.7}), rational(C, D, {0.1, 0, -0.5}, 0.6), rational(A, C, {0.3, 0, 0.4}, 2), rational(B, D, {0.1, 0.1, 0.3})}; }
CoonsCurves frame_of_arcs() {
    const auto arc = [](const Point& a, const Point& b, double r) { return make_arc(0.5 * (a + b) - Point{0, 0, r}, a, b); };
    const Point a{0, 0, 0}, b{2, 0, 0}, c{0, 1, 0}, d{2, 1.5, 0};
    return {arc(a, b, 0.5), arc(c, d, 0.7), arc(a, c, 0.3), arc(b, d, 0.9)};
}
CoonsCurves frame_of_waves() {
    const auto wave = [](const Point& a, const Point& b, const Point& h) { return make_curve(Wave{a, b - a, h}); };
    return {wave(A, B, {0, 0.2, 0.7}), wave(C, D, {0.1, 0, -0.5}), wave(A, C, {0.3, 0, 0.4}), wave(B, D, {0.1, 0.1, 0.3})};
}
/// Bicubic data over a frame; cross derivatives are rational, with twists that do not agree.
HermiteData hermite_over(const CoonsCurves& c) {
    const auto between = [](const Point& a, const Point& b, const Point& bend) { return make_bezier({a, 0.5 * (a + b) + bend, b}, {1, 1.6, 0.9}); };
    return {{c.d0, between(c.c0.derivative(0), c.c1.derivative(0), {0.3, 0, 1}), between(c.c0.derivative(1), c.c1.derivative(1), {0, -0.4, 0.6}), c.d1},
            {c.c0, between(c.d0.derivative(0), c.d1.derivative(0), {0.2, 0.1, -1}), between(c.d0.derivative(1), c.d1.derivative(1), {0, 0.5, 0.2}), c.c1}};
}

/// Coefficients of s^i e^j of the surface at a point of a line.
std::array<double, 6> expected_jet(const PointJet& y, int axis, const Vec2& a, const Vec2& c) {
    const auto f = [&](int i, int j) { return y[axis].coefficient(i, j); };
    return {f(0, 0), f(1, 0) * a.x + f(0, 1) * a.y, f(1, 0) * c.x + f(0, 1) * c.y, f(2, 0) * a.x * a.x + f(1, 1) * a.x * a.y + f(0, 2) * a.y * a.y,
            2 * f(2, 0) * a.x * c.x + f(1, 1) * (a.x * c.y + a.y * c.x) + 2 * f(0, 2) * a.y * c.y, f(2, 0) * c.x * c.x + f(1, 1) * c.x * c.y + f(0, 2) * c.y * c.y};
}
/// The jets over a piece hold those that the surface itself computes there, and are no wider than `width`.
void expect_holds_piece(const Patch& patch, const EdgeSide& side, const ParameterLine& line, double middle, double half, double width) {
    const EdgeSide::Jet x = side.jet(middle, half);
    const Vec2 step{line.to.x - line.from.x, line.to.y - line.from.y};
    for (const double d : {-0.9, -0.2, 0.6}) {
        const Vec2 at = side.at(middle + half * d);
        const PointJet y = patch.jet(at.x, at.y);
        for (int axis = 0; axis < 3; ++axis) {
            const auto expected = expected_jet(y, axis, step, line.cross);
            for (int n = 0; n < 6; ++n) {
                const double size = 1 + std::fabs(y[axis].coefficient(2, 0)) + std::fabs(y[axis].coefficient(1, 1)) + std::fabs(y[axis].coefficient(0, 2));
                const Interval got = x[axis].c[n].at(d);
                ASSERT_TRUE(got.bounded()) << "coefficient " << n;
                EXPECT_LE(got.lo, expected[std::size_t(n)] + 1e-12 * size) << "coefficient " << n << " at " << at.x << " " << at.y;
                EXPECT_GE(got.hi, expected[std::size_t(n)] - 1e-12 * size) << "coefficient " << n << " at " << at.x << " " << at.y;
                EXPECT_LT(got.hi - got.lo, width * size) << "coefficient " << n;
            }
        }
    }
}

std::vector<std::pair<const char*, Patch>> rational_patches() {
    const CoonsCurves r = rational_frame();
    const auto through = [](const Point& a, const Point& b, const Point& c, double w) { return make_bezier({a, (1 / (2 * w)) * ((2 + 2 * w) * b - a - c), c}, {1, w, 1}); };
    std::vector<Curve> u, v;
    const auto node = [](int i, int j) { return Point{double(i), double(j), 0.3 * std::sin(1.0 + 2 * i + 3 * j)}; };
    for (int k = 0; k < 3; ++k) u.push_back(through(node(0, k), node(1, k), node(2, k), 0.7 + 0.3 * k)), v.push_back(through(node(k, 0), node(k, 1), node(k, 2), 1.2 - 0.2 * k));
    const CoonsCurves n{nurbs(A, B, {0, 0.1, 0.4}), nurbs(C, D, {0.1, 0, -0.3}), nurbs(A, C, {0.1, 0, 0.4}), nurbs(B, D, {0.1, 0.1, 0.3})};
    Transform move;
    move.m = {{{1, 0.2, 0, 3}, {-0.3, 1, 0, 1}, {0, 0.5, 2, -1}}};
    // Reversed, cut and moved curves are rational too.
    const CoonsCurves modified{reversed(reversed(r.c0)), segment(r.c1, 0, 1), transformed(r.d0, Transform{}), r.d1};
    return {{"coons", make_coons(r)},
            {"coons over arcs", make_coons(frame_of_arcs())},
            {"cubic blend", make_coons(r, cubic_blend())},
            {"P1", make_coons(r, {}, Part::P1)},
            {"P2", make_coons(r, cubic_blend(), Part::P2)},
            {"modified curves", make_coons(modified)},
            {"moved", transformed(make_coons(r), move)},
            {"translational blend", make_translational_blend(r)},
            {"translational", make_translational(r.c0, r.d0)},
            {"ruled", make_ruled(r.c0, r.c1)},
            {"cone", make_cone(r.c0, {1, 1, 3})},
            {"average", make_coons_hermite(hermite_over(r), Twist::average)},
            {"gregory", make_coons_hermite(hermite_over(r), Twist::gregory)},
            {"gregory over arcs", make_coons_hermite(hermite_over(frame_of_arcs()), Twist::gregory)},
            {"gordon", make_gordon({u, {0, 0.5, 1}, v, {0, 0.5, 1}}, GordonBlend::lagrange)},
            {"gordon, hats", make_gordon({u, {0, 0.5, 1}, v, {0, 0.5, 1}}, GordonBlend::hermite)},
            {"lagrange", make_lagrange(u, {0, 0.3, 1})},
            {"network", make_network({v, u}, Twist::average)},
            {"network, gregory", make_network({v, u}, Twist::gregory)},
            {"nurbs", make_coons(n)}};
}

TEST(RationalEdges, WhatIsSpannedByRationalCurvesIsExactBesideItsEdgesAndLines) {
    for (const auto& [name, patch] : rational_patches()) {
        SCOPED_TRACE(name);
        const auto us = patch.lines_u(), vs = patch.lines_v();
        const auto check = [&](const ParameterLine& line, const Vec2& side) {
            const EdgeSide x(patch, line, side);
            EXPECT_TRUE(x.exact());
            // A number on a break belongs to the cell on its right: then the form of the left one has no oracle here.
            if (side.x > 0 || side.y > 0 || patch.breaks_u().empty()) expect_holds_piece(patch, x, line, 0.4, 0.15, 1e-7), expect_holds_piece(patch, x, line, 0.7, 0, 1e-10);
        };
        for (std::size_t i = 0; i < us.size(); ++i)
            for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
                if (i + 1 < us.size()) check({{us[i], vs[j]}, {us[i], vs[j + 1]}, {1, 0}}, {1, 0});
                if (i > 0) check({{us[i], vs[j + 1]}, {us[i], vs[j]}, {-1, 0}}, {-1, 0}), check({{us[i], vs[j]}, {us[i], vs[j + 1]}, {1, 0}}, {-1, 0});
            }
        for (std::size_t j = 0; j < vs.size(); ++j)
            for (std::size_t i = 0; i + 1 < us.size(); ++i) {
                if (j + 1 < vs.size()) check({{us[i], vs[j]}, {us[i + 1], vs[j]}, {0, 1}}, {0, 1}), check({{us[i], vs[j]}, {us[i + 1], vs[j]}, {0, -1}}, {0, 1});
                if (j > 0) check({{us[i + 1], vs[j]}, {us[i], vs[j]}, {0, -1}}, {0, -1});
            }
        // Between lines there is none.
        const double inside = 0.75 * us[0] + 0.25 * us[1];
        EXPECT_FALSE(EdgeSide(patch, {{inside, vs[0]}, {inside, vs[1]}, {1, 0}}, {1, 0}).exact());
    }
}

TEST(RationalEdges, TheOtherSideOfALineHasTheFormOfItsOwnCell) {
    // Left of a break of the curves: the same surface over the left half alone.
    const CoonsCurves n{nurbs(A, B, {0, 0.1, 0.4}), nurbs(C, D, {0.1, 0, -0.3}), rational(A, C, {0.3, 0, 0.4}), rational(B, D, {0.1, 0.1, 0.3})};
    const Patch coons = make_coons(n);
    ASSERT_EQ(coons.breaks_u(), std::vector<double>{0.375});
    const ParameterLine line{{0.375, 0}, {0.375, 1}, {1, 0}};
    const EdgeSide left(coons, line, {-1, 0}), right(coons, line, {1, 0});
    ASSERT_TRUE(left.exact() && right.exact());
    const auto side_jet = [&](const EdgeSide& side, int axis) { return side.jet(0.3, 0)[axis]; };
    for (int axis = 0; axis < 3; ++axis) {
        // The spline is C2 but for a jump of nothing: its knot is simple, so second derivatives agree too, and third ones do not count here.
        for (const int k : {0, 1, 2, 3, 4, 5}) EXPECT_LE(mag((side_jet(left, axis).c[k] - side_jet(right, axis).c[k]).range()), 1e-11) << k;
    }
    const PointJet from_left = coons.jet(std::nextafter(0.375, 0), 0.3);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(mid(side_jet(left, axis).c[5].range()), from_left[axis].coefficient(2, 0), 1e-9);
}

TEST(RationalEdges, FormulasHaveModelsOnTheirEdges) {
    const CoonsCurves w = frame_of_waves();
    for (const auto& [name, patch] : {std::pair("coons", make_coons(w)), {"cubic", make_coons(w, cubic_blend())}, {"translational blend", make_translational_blend(w)}, {"ruled", make_ruled(w.c0, w.c1)}})
        for (int edge = 0; edge < 4; ++edge) {
            SCOPED_TRACE(name);
            const ParameterLine line = edge_line(patch, edge, 0, 1);
            const EdgeSide side(patch, line, line.cross);
            for (const double middle : {0.015625, 0.5, 0.984375}) expect_holds_piece(patch, side, line, middle, 0.015625, 1e-5);
            const EdgeSide::Jet x = side.jet(0.5, 0.015625);
            for (int axis = 0; axis < 3; ++axis)
                for (const int n : {0, 1, 2}) EXPECT_LT(x[axis].c[n].rest().hi, n == 0 ? 1e-10 : 1e-8) << edge << " " << n;
        }
}

TEST(RationalEdges, CurvesAreQuotientsOfPolynomials) {
    const Curve r = rational(A, B, {0, 0.2, 0.7}), s = rational(C, D, {0.1, 0, -0.5}, 0.6), n = nurbs(A, B, {0, 0.1, 0.4});
    Transform move;
    move.m = {{{1, 0.2, 0, 3}, {-0.3, 1, 0, 1}, {0, 0.5, 2, -1}}};
    for (const Curve& c : {r, n, reversed(r), segment(r, 0.25, 0.875), reparametrized(n, 0, 3), transformed(r, move), linear_combination({-1.5, 2, -0.5}, {r, s, r}), make_bezier({A, B, D}), frame_of_arcs().c0}) {
        std::vector<double> ends{c.begin()};
        for (const Break& b : c.breaks()) ends.push_back(b.t);
        ends.push_back(c.end());
        for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
            Vec3<Quotient> x = c.quotient(Polynomial::variable_u(Interval(ends[k], ends[k + 1])));
            const Polynomial w = common_denominator(x);
            const double t = 0.7 * ends[k] + 0.3 * ends[k + 1], d = t - mid(Interval(ends[k], ends[k + 1]));
            const auto at = [&](const Polynomial& p) {
                Interval sum(0);
                for (int i = p.degree_u(); i >= 0; --i) sum = sum * Interval(d) + p.coefficient(i, 0);
                return sum;
            };
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_TRUE(x[axis].over.exists());
                const Interval value = at(x[axis].over) / at(w);
                EXPECT_NEAR(mid(value), c(t)[axis], 1e-13 * (1 + std::fabs(c(t)[axis])));
                EXPECT_LT(value.hi - value.lo, 1e-12);
            }
        }
    }
    // The same denominator twice is one: r - r/4 is of degree 3 over degree 3.
    const auto same = linear_combination({1, -0.25}, {r, r}).quotient(Polynomial::variable_u({0, 1}));
    EXPECT_EQ(same.x.under.size(), 1u);
    EXPECT_EQ(same.x.over.degree_u(), 3);
    EXPECT_FALSE(make_curve(Wave{A, B, C}).quotient(Polynomial::variable_u({0, 1})).x.over.exists());
}

CoonsCurves turned(CoonsCurves c, int way) {
    if (way & 1) c = {reversed(c.c0), reversed(c.c1), c.d1, c.d0};
    if (way & 2) c = {c.c1, c.c0, reversed(c.d0), reversed(c.d1)};
    if (way & 4) c = {c.d0, c.d1, c.c0, c.c1};
    return c;
}
Curve negative(const Curve& c) { return transformed(c, Transform::scale({-1, -1, -1})); }
HermiteData turned(HermiteData h, int way) {
    if (way & 1) h = {{h.f[3], negative(h.f[2]), negative(h.f[1]), h.f[0]}, {reversed(h.g[0]), reversed(h.g[1]), reversed(h.g[2]), reversed(h.g[3])}};
    if (way & 2) h = {{reversed(h.f[0]), reversed(h.f[1]), reversed(h.f[2]), reversed(h.f[3])}, {h.g[3], negative(h.g[2]), negative(h.g[1]), h.g[0]}};
    if (way & 4) std::swap(h.f, h.g);
    return h;
}

/// What a dense sample of d1 of a and d0 of b shows.
std::array<double, 4> sampled_jumps(const Patch& a, const Patch& b) {
    std::array<double, 4> most{};
    for (int k = 0; k <= 1000; ++k) {
        const double t = k / 1000.0;
        const PointJet x = a.jet(1, t), y = b.jet(0, t);
        const auto part = [](const PointJet& p, int i, int j) { return Point{p.x.coefficient(i, j), p.y.coefficient(i, j), p.z.coefficient(i, j)}; };
        const Point n = cross(part(x, 0, 1), part(x, 1, 0)), m = cross(part(y, 0, 1), part(y, 1, 0));
        most[kC0] = std::max(most[kC0], distance(part(x, 0, 0), part(y, 0, 0)));
        most[kC1] = std::max(most[kC1], distance(part(x, 1, 0), part(y, 1, 0)));
        most[kC2] = std::max(most[kC2], 2 * distance(part(x, 2, 0), part(y, 2, 0)));
        most[kG1] = std::max(most[kG1], std::atan2(length(cross(n, m)), dot(n, m)) * 180 / std::numbers::pi);
    }
    return most;
}
void expect_in_bounds(const Joint& joint, const std::array<double, 4>& truth, double tolerance) {
    for (const int m : {kC0, kC1, kC2, kG1}) {
        const double rounding = m == kC2 ? 1e-11 : m == kG1 ? 1e-10 : 1e-12;
        EXPECT_LE(truth[std::size_t(m)], joint.jumps[m].upper + rounding) << "measure " << m;
        EXPECT_LE(joint.jumps[m].lower, truth[std::size_t(m)] * 1.001 + rounding) << "measure " << m;
        EXPECT_LE(joint.jumps[m].upper, truth[std::size_t(m)] * 1.02 + (m == kG1 ? 1e-7 : 0.1 * tolerance)) << "measure " << m;
    }
}

/// A bump on the common curve, of height h and 0 at its ends.
Curve bumped(const Curve& c, double h) { return linear_combination({1, h}, {c, make_bezier({{0, 0, 0}, {0, 0.3, 1}, {0, 0.3, 1}, {0, 0, 0}})}); }

TEST(RationalEdges, JumpsPlantedBetweenCoonsPatchesLieInTheirBoundsInAllOrientations) {
    const Point E{4, 0.2, 0.1}, F{4.5, 2, 0.3};
    const CoonsCurves left = rational_frame();
    for (int round = 0; round < 16; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const bool gap = round % 2 == 0;
        const double h = std::pow(10.0, -3 - round / 2 % 7) * 2;
        // Cubic blends: the derivatives across the joint are those of the curves at its ends, which agree but for h.
        const auto continued = [&](const Curve& c, const Point& to, const Point& slope) { return make_bezier({c(1), c(1) + (1.0 / (3 * 1.3)) * (c.derivative(1) + slope), to - Point{0.6, 0, 0.1}, to}, {1, 1.3, 0.9, 1}); };
        const CoonsCurves right{continued(left.c0, E, gap ? Point{} : h * Point{0, 0, 1}), continued(left.c1, F, gap ? Point{} : h * Point{0, 0.6, -0.8}), gap ? bumped(left.d1, h) : left.d1, rational(E, F, {0.2, 0, 0.5})};
        const Patch a = make_coons(left, cubic_blend()), b = make_coons(right, cubic_blend());
        const Composite both{{"a", make_coons(turned(left, round % 8), cubic_blend())}, {"b", make_coons(turned(right, (5 * round + round / 8) % 8), cubic_blend())}};
        ContinuityOptions o;
        o.size = bounding_box(both).diagonal(), o.tolerance = 1e-9 * o.size, o.curvature = 1e-9 / o.size, o.capture = 1e-2 * o.size;
        const Continuity found = find_continuity(both, o);
        ASSERT_EQ(found.joints.size(), 1u);
        expect_in_bounds(found.joints[0], sampled_jumps(a, b), o.tolerance);
        if (h > 1e-7) {  // smaller angles are none
            EXPECT_EQ(order_of(found.joints[0], o).text, gap ? "not joined" : "C0");
        }
    }
}

TEST(RationalEdges, JumpsPlantedBetweenGregorysSquaresLieInTheirBoundsInAllOrientations) {
    const CoonsCurves left = rational_frame();
    const HermiteData data = hermite_over(left);
    for (int round = 0; round < 8; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const double h = std::pow(10.0, -3 - round % 7) * 2;
        // The right one continues the left one with its cross derivative, but for a bump.
        const auto continued = [&](const Curve& c, const Point& to) { return make_bezier({c(1), c(1) + (1.0 / (3 * 1.3)) * c.derivative(1), to - Point{0.6, 0, 0.1}, to}, {1, 1.3, 0.9, 1}); };
        const Point E{4, 0.2, 0.1}, F{4.5, 2, 0.3};
        const CoonsCurves right{continued(left.c0, E), continued(left.c1, F), left.d1, rational(E, F, {0.2, 0, 0.5})};
        HermiteData other = hermite_over(right);
        other.f[1] = bumped(data.f[2], h);
        const Patch a = make_coons_hermite(data, Twist::gregory), b = make_coons_hermite(other, Twist::gregory);
        const Composite both{{"a", make_coons_hermite(turned(data, round), Twist::gregory)}, {"b", make_coons_hermite(turned(other, 7 - round), Twist::gregory)}};
        ContinuityOptions o;
        o.size = bounding_box(both).diagonal(), o.tolerance = 1e-9 * o.size, o.curvature = 1e-9 / o.size, o.capture = 1e-2 * o.size;
        const Continuity found = find_continuity(both, o);
        ASSERT_EQ(found.joints.size(), 1u);
        auto truth = sampled_jumps(a, b);
        for (const int m : {kC0, kC1, kG1}) {
            EXPECT_LE(truth[std::size_t(m)], found.joints[0].jumps[m].upper + 1e-10) << "measure " << m;
            EXPECT_LE(found.joints[0].jumps[m].lower, truth[std::size_t(m)] * 1.001 + 1e-10) << "measure " << m;
        }
        EXPECT_LE(found.joints[0].jumps[kC1].upper, truth[kC1] * 1.02 + 0.1 * o.tolerance);
    }
}

TEST(RationalEdges, PromisesOverRationalCurvesAreProvedToRounding) {
    const CoonsCurves r = rational_frame(), arcs = frame_of_arcs();
    for (const CoonsCurves& c : {r, arcs})
        for (const Promise& p : examine(c).promises) EXPECT_LE(bound_residual(make_coons(c), p, 1e-9).upper, 1e-11) << p.what;
    const HermiteData data = hermite_over(r);
    const Patch gregory = make_coons_hermite(data, Twist::gregory);
    const auto promises = examine(data, Twist::gregory).promises;
    EXPECT_EQ(promises.size(), 8u);
    for (const Promise& p : promises) {
        EXPECT_LE(bound_residual(gregory, p, 1e-9).upper, 1e-10) << p.what;
        Promise broken = p;
        broken.curve = bumped(p.curve, 1e-7);
        EXPECT_GT(bound_residual(gregory, broken, 1e-9).lower, 5e-8) << p.what;
    }
}

}  // namespace
}  // namespace isoparm::test
