// Exact forms at edges are the surface there, and jumps planted at random lie in the bounds: the oracle is a dense sample, the patches are continued in Bezier form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cages.h"
#include "continuity.h"
#include "curves/bezier.h"
#include "curves/bspline.h"
#include "curves/modify.h"
#include "joints/edge_cells.h"
#include "patches/coons_hermite.h"
#include "patches/bbg.h"
#include "patches/nielson.h"
#include "patches/side_vertex.h"
#include "patches/tensor_bezier.h"
#include "patches/transformed.h"
#include "promises.h"
#include "samples.h"
#include "subdivision.h"

namespace isoparm::test {
namespace {

/// What EdgeSide says at s, against the derivatives that the patch itself computes there. False where it has no exact form.
bool expect_edge_jets(const Patch& patch, int edge, double t0, double t1) {
    const ParameterLine line = edge_line(patch, edge, t0, t1);
    const EdgeSide side(patch, line, line.cross);
    if (!side.exact()) return false;
    for (const double s : {0.125, 0.625}) {
        const EdgeSide::Jet x = side.jet(s, 0);
        const Vec2 at = side.at(s), a{line.to.x - line.from.x, line.to.y - line.from.y}, c = line.cross;
        const PointJet y = patch.jet(at.x, at.y);
        for (int axis = 0; axis < 3; ++axis) {
            const auto f = [&](int i, int j) { return y[axis].coefficient(i, j); };
            const double expected[6] = {f(0, 0), f(1, 0) * a.x + f(0, 1) * a.y, f(1, 0) * c.x + f(0, 1) * c.y, f(2, 0) * a.x * a.x + f(1, 1) * a.x * a.y + f(0, 2) * a.y * a.y,
                                        2 * f(2, 0) * a.x * c.x + f(1, 1) * (a.x * c.y + a.y * c.x) + 2 * f(0, 2) * a.y * c.y, f(2, 0) * c.x * c.x + f(1, 1) * c.x * c.y + f(0, 2) * c.y * c.y};
            const double size = 1 + std::fabs(f(2, 0)) + std::fabs(f(1, 1)) + std::fabs(f(0, 2));
            for (int n = 0; n < 6; ++n) {
                const Interval got = x[axis].c[n].range();
                EXPECT_LE(got.lo, expected[n] + 1e-12 * size) << "edge " << edge << ", " << t0 << " to " << t1 << ", coefficient " << n;
                EXPECT_GE(got.hi, expected[n] - 1e-12 * size) << "edge " << edge << ", " << t0 << " to " << t1 << ", coefficient " << n;
                EXPECT_LT(got.hi - got.lo, 1e-10 * size);
            }
        }
    }
    return true;
}

TEST(EdgeForms, LimitSurfacesAreExactOnTheDyadicPartsOfTheirEdges) {
    Cage creased = cube_cage();
    creased.creases.push_back({0, 1, 2.5});
    int exact = 0, vertices = 0;
    for (const auto& [cage, scheme] : {std::pair(fan_cage(5), Scheme::catmull_clark), {creased, Scheme::catmull_clark}, {prism_cage(), Scheme::catmull_clark}, {fan_cage(7, true), Scheme::loop}})
        for (const Member& m : make_subdivision(cage, scheme, 1'000'000).patches)
            for (int edge = 0; edge < m.patch.edges(); ++edge) {
                const EdgeCuts cuts = dyadic_cuts(m.patch, edge);
                vertices += cuts.starts + cuts.ends;
                std::vector<double> t{0};
                t.insert(t.end(), cuts.inner.begin(), cuts.inner.end());
                t.push_back(1);
                ASSERT_TRUE(std::is_sorted(t.begin(), t.end()));
                // A second derivative beside an extraordinary vertex is the larger the nearer: as far as 2^-6 here.
                for (std::size_t k = 0; k + 1 < t.size(); ++k)
                    if (t[k + 1] - t[k] > 0.01) exact += expect_edge_jets(m.patch, edge, t[k], t[k + 1]);
            }
    EXPECT_GT(exact, 300);
    EXPECT_GT(vertices, 50);
}

TEST(EdgeForms, GregorysSquareIsRationalOnItsEdges) {
    const auto b = [](std::vector<Point> p) { return make_bezier(std::move(p)); };
    const HermiteData data{{b({{0, 0, 0}, {0, 1, 1}, {0, 2, 0}}), b({{2, 0, 2}, {2, 0.5, 9}, {2.1, 0, 2}, {2, 0, 2}}), b({{2, 0, -2}, {2, 0.3, 5}, {2, 0, -2}}), b({{2, 0, 0}, {2, 1, 1}, {2, 2, 0}})},
                           {b({{0, 0, 0}, {1, 0, 1}, {2, 0, 0}}), b({{0, 2, 2}, {0.2, 2, -3}, {0, 2, 2}}), b({{0, 2, -2}, {0, 2, 4}, {0, 2.2, 1}, {0, 2, -2}}), b({{0, 2, 0}, {1, 2, 1}, {2, 2, 0}})}};
    const Patch gregory = make_coons_hermite(data, Twist::gregory);
    for (int edge = 0; edge < 4; ++edge) EXPECT_TRUE(expect_edge_jets(gregory, edge, 0, 1)) << edge;
    // Not on other lines.
    EXPECT_FALSE(EdgeSide(gregory, {{0.5, 0}, {0.5, 1}, {1, 0}}, {1, 0}).exact());
}

Transform affine(const std::array<double, 4>& x, const std::array<double, 4>& y, const std::array<double, 4>& z) {
    Transform t;
    t.m = {x, y, z};
    return t;
}
std::array<Curve, 3> quartic_edges() {
    const auto b = [](std::vector<Point> p) { return make_bezier(std::move(p)); };
    return {b({{0, 2, 0}, {0.1, 1.5, 0.8}, {-0.2, 1, 0.3}, {0, 0, 0.1}}), b({{0, 0, 0.1}, {0.7, 0.1, 0.7}, {1.2, 0, 0.2}, {1.5, -0.1, 0.4}, {2, 0, 0}}), b({{2, 0, 0}, {1, 1.2, 0.9}, {0, 2, 0}})};
}
/// Along E_k from where its neighbour ends to where the other one begins, with a bulge of its own.
std::array<Curve, 3> median_derivatives(const std::array<Curve, 3>& E) {
    std::vector<Curve> D;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        const Point first = -1.0 * E[j].derivative(1) - 0.5 * E[k].derivative(0), last = E[i].derivative(0) + 0.5 * E[k].derivative(1);
        D.push_back(make_bezier({first, 0.5 * (first + last) + Point{0.3, -0.2, 1.0 + double(k)}, last}));
    }
    return {D[0], D[1], D[2]};
}

TEST(EdgeForms, TrianglesWithSingularVerticesAreRationalBesideTheirEdges) {
    const auto E = quartic_edges();
    const auto D = median_derivatives(E);
    // Normals of cubic edges in a common plane at each vertex: those of the C1 surface there.
    const std::array<Curve, 3> flat{make_bezier({{0, 2, 0}, {0, 1, 1}, {0, 0, 0}}), make_bezier({{0, 0, 0}, {1, 0, 1}, {2, 0, 0}}), make_bezier({{2, 0, 0}, {1, 1, 2}, {0, 2, 0}})};
    const auto N = tests::normals_of(flat, median_derivatives(flat));
    const Function square = Function::polynomial({0, 0, 1}), mixed = Function::polynomial({0, 0.5, -1, 1.5});
    const std::pair<const char*, Patch> patches[] = {{"bbg_c1", make_bbg_c1(E, D)}, {"nielson_c1", make_nielson_c1(E, D)}, {"nielson_g1", make_nielson_g1(flat, N)},
        {"side_vertex", make_side_vertex(E, square)}, {"seed", make_side_vertex(E, square, SideVertexForm::seed)}, {"H = t/2 - t^2 + 3/2 t^3", make_side_vertex(E, mixed)},
        {"seed, the same", make_side_vertex(E, mixed, SideVertexForm::seed)}, {"moved", transformed(make_nielson_g1(flat, N), affine({1, 0.2, 0, 3}, {-0.3, 1, 0, 1}, {0, 0.5, 2, -1}))}};
    for (const auto& [name, patch] : patches)
        for (int edge = 0; edge < 3; ++edge) {
            SCOPED_TRACE(name);
            EXPECT_TRUE(expect_edge_jets(patch, edge, 0, 1));
            EXPECT_TRUE(expect_edge_jets(patch, edge, 0.75, 0.25));  // backwards
            const ParameterLine line = edge_line(patch, edge, 0, 1);
            EXPECT_TRUE(EdgeSide(patch, {line.from, line.to, {-line.cross.x, -line.cross.y}}, line.cross).exact());
        }
    // Edges of several pieces: one form each.
    const auto spline = [](std::vector<Point> p) { return make_bspline(3, {0, 0, 0, 0, 0.375, 1, 1, 1, 1}, std::move(p)); };
    const std::array<Curve, 3> S{spline({{0, 2, 0}, {0, 1.5, 0.5}, {0.1, 1, 0.8}, {0, 0.5, 0.2}, {0, 0, 0}}), spline({{0, 0, 0}, {0.5, 0, 0.4}, {1, 0.2, 0.1}, {1.5, 0, 0}, {2, 0, 0}}),
                                 spline({{2, 0, 0}, {1.5, 0.5, 0}, {1, 1.2, 0.7}, {0.5, 1.5, 0.1}, {0, 2, 0}})};
    for (const auto& [name, patch] : {std::pair("side_vertex", make_side_vertex(S, square)), {"nielson_c1", make_nielson_c1(S, median_derivatives(S))}})
        for (int edge = 0; edge < 3; ++edge) {
            SCOPED_TRACE(name);
            EXPECT_EQ(form_breaks(patch, edge), std::vector<double>{0.375});
            EXPECT_TRUE(expect_edge_jets(patch, edge, 0, 0.375));
            EXPECT_TRUE(expect_edge_jets(patch, edge, 1, 0.375));
        }
    for (const Promise& p : examine_nielson(S, median_derivatives(S)).promises) EXPECT_LE(bound_residual(make_nielson_c1(S, median_derivatives(S)), p, 1e-9).upper, 1e-11) << p.what;
    EXPECT_FALSE(EdgeSide(patches[1].second, {{0.5, 0}, {0.5, 0.5}, {1, 0}}, {1, 0}).exact());
}

/// Two triangles along E3 whose cross derivatives continue each other but for h at its middle.
TEST(EdgeForms, JumpsPlantedBetweenTrianglesLieInTheirBounds) {
    const auto E = quartic_edges();
    const auto D = median_derivatives(E);
    const Point p[3] = {D[2](0), 2 * D[2](0.5) - 0.5 * (D[2](0) + D[2](1)), D[2](1)};
    const Curve back = make_bezier({{0, 2, 0}, {1, 1.2, 0.9}, {2, 0, 0}});
    const Point far = E[2](0) + E[2](1) - E[0](1), tangent_b = -1.0 * p[0] - 0.5 * back.derivative(1), tangent_a = 0.5 * back.derivative(0) - p[2];
    // From B' = A to C' and from C' to A' = B, with the tangents that D3' asks for.
    const std::array<Curve, 3> F{make_bezier({E[2](0), E[2](0) + (1 / 3.0) * tangent_b, far, far}), make_bezier({far, far, E[2](1) + (1 / 3.0) * tangent_a, E[2](1)}), back};
    ContinuityOptions o;
    o.size = 4, o.tolerance = 1e-10, o.curvature = 1e-9, o.capture = 0.04;
    for (const bool nielson : {false, true})
        for (const double h : {1e-3, 1e-6, 1e-9, 0.0}) {
            auto G = median_derivatives(F);
            G[2] = make_bezier({-1.0 * p[2], -1.0 * p[1] + Point{0, 0, 2 * h}, -1.0 * p[0]});
            const Composite pair{{"a", nielson ? make_nielson_c1(E, D) : make_bbg_c1(E, D)}, {"b", nielson ? make_nielson_c1(F, G) : make_bbg_c1(F, G)}};
            const Continuity found = find_continuity(pair, o);
            ASSERT_EQ(found.joints.size(), 1u);
            const auto& jumps = found.joints[0].jumps;
            EXPECT_LT(jumps[kC0].upper, 1e-12);
            EXPECT_LE(jumps[kC1].lower, h * 1.0001 + 2e-14);
            EXPECT_GE(jumps[kC1].upper, h * 0.9999);
            EXPECT_LE(jumps[kC1].upper, 1.02 * h + 1e-11);
            if (h > 0) EXPECT_GE(jumps[kC1].lower, 0.98 * h);
            const std::string order = order_of(found.joints[0], o).text;
            EXPECT_EQ(order, h == 0 ? "C1" : h > 1e-8 ? "C0" : "G1") << h;
        }
}

TEST(EdgeForms, NielsonsNormalsAreProvedAndWrongOnesRefused) {
    const std::array<Curve, 3> E{make_bezier({{0, 2, 0}, {0, 1, 1}, {0, 0, 0}}), make_bezier({{0, 0, 0}, {1, 0, 1}, {2, 0, 0}}), make_bezier({{2, 0, 0}, {1, 1, 2}, {0, 2, 0}})};
    const auto N = tests::normals_of(E, median_derivatives(E));
    const Patch patch = make_nielson_g1(E, N);
    int normals = 0;
    for (const Promise& p : examine_nielson_g1(E, N).promises) {
        const JumpBound kept = bound_residual(patch, p, 1e-9);
        EXPECT_LE(kept.upper, 1e-9) << p.what;
        if (p.derivative != kNormal) continue;
        ++normals;
        Promise turned = p;  // by an angle of 1e-5
        turned.curve = transformed(p.curve, affine({1, -1e-5, 0, 0}, {1e-5, 1, 0, 0}, {0, 0, 1, 0}));
        const JumpBound broken = bound_residual(patch, turned, 1e-9);
        EXPECT_GT(broken.lower, 1e-4) << p.what;
        EXPECT_LE(broken.upper, 1.02 * broken.lower) << p.what;
        double most = 0;  // by samples
        for (int k = 0; k <= 200; ++k) {
            const double s = k / 200.0;
            const Point n = turned.curve(s), m = p.curve(s);
            most = std::max(most, std::atan2(length(cross(n, m)), std::fabs(dot(n, m))) * 180 / M_PI);
        }
        EXPECT_NEAR(broken.lower, most, 1e-3 * most) << p.what;
    }
    EXPECT_EQ(normals, 3);
}

using Rows = std::vector<Point>;
Point at(const Rows& c, double t) {
    Rows b = c;
    for (std::size_t n = b.size() - 1; n > 0; --n)
        for (std::size_t i = 0; i < n; ++i) b[i] = (1 - t) * b[i] + t * b[i + 1];
    return b[0];
}
Rows combined(const Rows& a, double x, const Rows& b, double y) {
    Rows r;
    for (std::size_t j = 0; j < a.size(); ++j) r.push_back(x * a[j] + y * b[j]);
    return r;
}
Rows slopes(const Rows& c) {
    Rows r;
    for (std::size_t j = 0; j + 1 < c.size(); ++j) r.push_back(double(c.size() - 1) * (c[j + 1] - c[j]));
    return r;
}
/// One of the eight ways in which a square lies on itself.
Grid<Point> turned(const Grid<Point>& g, int way) {
    const std::size_t m = g.size(), n = g[0].size();
    Grid<Point> r(way & 4 ? n : m, std::vector<Point>(way & 4 ? m : n));
    for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j < n; ++j) (way & 4 ? r[j][i] : r[i][j]) = g[way & 1 ? m - 1 - i : i][way & 2 ? n - 1 - j : j];
    return r;
}

TEST(PlantedJumps, LieInTheirBoundsWhateverTheyAreAndHoweverThePatchesAreTurned) {
    std::mt19937 random(20261122);
    const auto number = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
    const auto vector = [&](double s) { return Point{number(-s, s), number(-s, s), number(-s, s)}; };
    for (int round = 0; round < 64; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const int kind = round % 4, q = 2 + round % 3, p = 2 + round / 8 % 3;  // which derivative jumps, 3: none; degrees
        const double h = std::pow(10.0, -3 - round / 4 % 7) * number(1, 5);
        Rows edge, first, second;  // position and derivatives across, on the edge
        for (int j = 0; j <= q; ++j) {
            edge.push_back({number(-.1, .1), j / double(q) + number(-.05, .05), number(-.3, .3)});
            first.push_back(Point{1, 0, 0} + vector(0.3)), second.push_back(vector(0.8));
        }
        const auto grid = [&](const Rows& e, const Rows& d, const Rows& s, double side) {  // rows going away from the edge, along -d or d
            Grid<Point> g{e, combined(e, 1, d, side / p)};
            g.push_back(combined(combined(s, 1.0 / (p * (p - 1)), g[1], 2), 1, e, -1));
            for (int i = 3; i <= p; ++i) g.push_back(combined(g[2], 1, Rows(std::size_t(q) + 1, Point{side * 0.4 * (i - 2), 0, 0} + vector(0.1)), 1));
            return g;
        };
        const Rows jump(std::size_t(q) + 1, h * normalized(vector(1)));
        const Grid<Point> a = grid(edge, first, second, -1), b = grid(kind == 0 ? combined(edge, 1, jump, 1) : edge, kind == 1 ? combined(first, 1, jump, 1) : first,
                                                                       kind == 2 ? combined(second, 1, jump, 1) : second, 1);
        const Composite both{{"a", make_bezier_patch(turned(a, round % 8))}, {"b", make_bezier_patch(turned(b, round / 8 % 8))}};
        ContinuityOptions o;
        o.size = bounding_box(both).diagonal(), o.tolerance = 1e-9 * o.size, o.curvature = 1e-9 / o.size, o.capture = 1e-2 * o.size;
        const Continuity found = find_continuity(both, o);
        ASSERT_EQ(found.joints.size(), 1u);
        const Joint& joint = found.joints[0];
        // What the rounded poles have.
        const Rows x1 = combined(a[0], p, a[1], -p), y1 = combined(b[1], p, b[0], -p), xs = slopes(a[0]), ys = slopes(b[0]);
        const auto bend = [&](const Grid<Point>& g) { return combined(combined(g[2], 1, g[1], -2), p * (p - 1.0), g[0], p * (p - 1.0)); };
        const Rows x2 = bend(a), y2 = bend(b);
        double truth[4] = {0, 0, 0, 0};
        for (int k = 0; k <= 400; ++k) {
            const double t = k / 400.0;
            const Point n = cross(at(xs, t), at(x1, t)), m = cross(at(ys, t), at(y1, t));
            truth[kC0] = std::max(truth[kC0], distance(at(a[0], t), at(b[0], t))), truth[kC1] = std::max(truth[kC1], distance(at(x1, t), at(y1, t)));
            truth[kC2] = std::max(truth[kC2], distance(at(x2, t), at(y2, t))), truth[kG1] = std::max(truth[kG1], std::atan2(length(cross(n, m)), dot(n, m)) * 180 / M_PI);
        }
        for (const int m : {kC0, kC1, kC2, kG1}) {
            const double rounding = m == kG1 ? 1e-12 : 3e-14;
            EXPECT_LE(truth[m], joint.jumps[m].upper + rounding) << "measure " << m << ", planted " << kind << ", " << h;
            EXPECT_LE(joint.jumps[m].lower, truth[m] * 1.001 + rounding) << "measure " << m << ", planted " << kind << ", " << h;
            EXPECT_LE(joint.jumps[m].upper, truth[m] * 1.02 + (m == kG1 ? 1e-7 : 0.1 * o.tolerance)) << "measure " << m << ", planted " << kind << ", " << h;
        }
        const std::string order = order_of(joint, o).text;
        if (kind == 3 || kind == 2) EXPECT_EQ(order, kind == 3 || truth[kC2] <= o.tolerance ? "C2" : "C1");
        if (kind == 0 && h > 1.1 * o.tolerance) EXPECT_EQ(order, "not joined");
        if (kind == 1 && truth[kG1] > 1.1e-6) EXPECT_EQ(order, truth[kC1] <= o.tolerance ? "C1" : "C0") << truth[kC1];
    }
}

}  // namespace
}  // namespace isoparm::test
