// What a certified mesh promises: soundness over random patches of every type, watertight joints, one result for every
// number of threads, and budgets that end with a message. ISOPARM_SOUNDNESS=N sets the random patches of each type.
#include "tessellation_options.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <cstdlib>

#include "bound.h"
#include "curves/bezier.h"
#include "curves/modify.h"
#include "error.h"
#include "patches/coons.h"
#include "patches/tensor_bezier.h"
#include "patches/transformed.h"
#include "samples.h"
#include "shapes.h"
#include "topology.h"

namespace isoparm::tests {
namespace {

Tessellation tessellate_relative(const Composite& surface, double relative, Measure measure = Measure::parametric) {
    return tessellate(surface, options_of(surface, relative, measure));
}

/// Largest |S - L| at random points of every triangle, minus what was certified: never positive.
double worst_excess(const Composite& surface, const Tessellation& t, Random& random, int samples) {
    double excess = -1;
    for (const auto& part : t.mesh.parts)
        for (const auto& triangle : part.triangles)
            for (int i = 0; i < samples; ++i) {
                double w[3] = {random.number(), random.number(), random.number()};
                const double sum = w[0] + w[1] + w[2];
                double u = 0, v = 0;
                Point flat;
                for (int k = 0; k < 3; ++k) {
                    u += w[k] / sum * part.uv[triangle[k]].x;
                    v += w[k] / sum * part.uv[triangle[k]].y;
                    flat += w[k] / sum * t.mesh.positions[part.vertex[triangle[k]]];
                }
                const double d = distance(surface[part.member].patch.point(u, v), flat);
                excess = std::max(excess, d - part.certified_error);
            }
    return excess;
}

/// Area of the triangles of a part in the domain: that of what they cover when none is folded over.
double covered(const MeshPart& part) {
    double area = 0;
    for (const auto& t : part.triangles) {
        const Vec2 &a = part.uv[t[0]], &b = part.uv[t[1]], &c = part.uv[t[2]];
        area += 0.5 * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    }
    return area;
}

class Soundness : public testing::TestWithParam<PatchType> {};

TEST_P(Soundness, NoSampleLiesFartherThanCertified) {
    const char* wanted = std::getenv("ISOPARM_SOUNDNESS");
    const int patches = wanted ? std::atoi(wanted) : 4;
    for (int i = 0; i < patches; ++i) {
        Random random(1000 + std::uint64_t(i));
        const Composite surface{{"S", GetParam().make(random).patch}};
        const double relative = i % 2 == 0 ? 0.1 : 0.02;
        const Tessellation t = tessellate_relative(surface, relative);
        ASSERT_LE(t.certified_error, t.tolerance) << "seed " << 1000 + i;
        ASSERT_LE(t.sampled_error, t.certified_error) << "seed " << 1000 + i;
        ASSERT_LE(worst_excess(surface, t, random, 4), 1e-12 * (1 + t.tolerance)) << "seed " << 1000 + i;
        ASSERT_EQ(t.topology.t_junctions, 0u) << "seed " << 1000 + i;
        const Rect r = surface[0].patch.rect();
        const double whole = surface[0].patch.domain() == Domain::triangle ? 0.5 : (r.u1 - r.u0) * (r.v1 - r.v0);
        ASSERT_LE(covered(t.mesh.parts[0]), whole * (1 + 1e-12)) << "seed " << 1000 + i;
        ASSERT_EQ(t.topology.degenerate_triangles, 0u) << "seed " << 1000 + i;
        ASSERT_EQ(t.topology.non_manifold_edges, 0u) << "seed " << 1000 + i;
    }
}

// Single triangles of all sizes, so also those that a tessellation never keeps.
TEST_P(Soundness, BoundHoldsOnRandomTriangles) {
    for (int i = 0; i < 40; ++i) {
        Random random(77 + std::uint64_t(i));
        const Patch patch = GetParam().make(random).patch;
        const auto us = patch.breaks_u(), vs = patch.breaks_v();
        const Rect r = patch.rect();
        const double u1 = us.empty() ? r.u1 : us.front(), v1 = vs.empty() ? r.v1 : vs.front();
        std::array<Vec2, 3> p;
        const double size = std::pow(2.0, -random.number(0, 8));
        const double u0 = i % 3 == 0 ? r.u0 : r.u0 + (u1 - r.u0) * random.number(0, 1 - size), v0 = i % 3 == 0 ? r.v0 : r.v0 + (v1 - r.v0) * random.number(0, 1 - size);
        for (auto& q : p) {
            double a = random.number() * size, b = random.number() * size;
            if (patch.domain() == Domain::triangle && i % 3 != 0) a *= 0.5, b *= 0.5;
            q = {u0 + (u1 - r.u0) * a, v0 + (v1 - r.v0) * b};
            if (patch.domain() == Domain::triangle && q.x + q.y > 1) q = {0.5 * q.x, 0.5 * q.y};
        }
        std::array<Point, 3> x;
        for (int k = 0; k < 3; ++k) x[k] = patch.point(p[k].x, p[k].y);
        const double bound = bound_triangle(patch, p, x).parametric;
        for (int s = 0; s < 60; ++s) {
            double w[3] = {random.number(), random.number(), random.number()};
            const double sum = w[0] + w[1] + w[2];
            Vec2 q{0, 0};
            Point flat;
            for (int k = 0; k < 3; ++k) q = {q.x + w[k] / sum * p[k].x, q.y + w[k] / sum * p[k].y}, flat += w[k] / sum * x[k];
            ASSERT_LE(distance(patch.point(q.x, q.y), flat), bound * (1 + 1e-12) + 1e-13 * size_of_sample(patch)) << "seed " << 77 + i;
        }
    }
}
INSTANTIATE_TEST_SUITE_P(EveryType, Soundness, testing::ValuesIn(patch_types()), name_of);

TEST(Bound, AOnePercentSmallerBoundIsCaught) {
    // A parabolic cylinder: the error at the hypotenuse's middle is exactly 1/8 |S_uu| h^2, so the bound is attained.
    const Patch patch = make_bezier_patch({{{0, 0, 0}, {0, 1, 0}}, {{0.5, 0, 1}, {0.5, 1, 1}}, {{1, 0, 0}, {1, 1, 0}}});
    const std::array<Vec2, 3> p{Vec2{0, 0}, {1, 0}, {1, 1}};
    const std::array<Point, 3> x{patch.point(0, 0), patch.point(1, 0), patch.point(1, 1)};
    const double bound = bound_triangle(patch, p, x).parametric, truth = distance(patch.point(0.5, 0), 0.5 * x[0] + 0.5 * x[1]);
    EXPECT_GE(bound, truth);
    EXPECT_LT(0.99 * bound, truth);
}

TEST(Bound, SimplexMaximumIsExact) {
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
        const double a = random.number(-1, 1), b = random.number(-1, 1), c = random.number(-1, 1);
        double sampled = 0;
        for (int p = 0; p <= 60; ++p)
            for (int q = 0; q <= 60 - p; ++q) {
                const double l0 = p / 60.0, l1 = q / 60.0, l2 = 1 - l0 - l1;
                sampled = std::max(sampled, a * l0 * l1 + b * l1 * l2 + c * l2 * l0);
            }
        const double m = simplex_maximum(a, b, c);
        EXPECT_GE(m, sampled - 1e-15);
        EXPECT_LE(m, sampled + 2e-3);
    }
}

TEST(Bound, WhatIsNotANumberHasNoBound) {
    for (int k = 0; k < 3; ++k) {
        double c[3] = {1, 1, 1};
        c[k] = NAN;
        EXPECT_EQ(simplex_maximum(c[0], c[1], c[2]), HUGE_VAL);
    }
}

// Samples on the triangles cannot see a triangle that is missing. Knots such as k of [0,49] are no edge_point() of a
// rounded k/49, so each must be found again exactly.
TEST(Tessellate, TheDomainIsCoveredWhateverTheKnots) {
    Random random(9);
    for (int i = 0; i < 24; ++i) {
        const int spans = i < 4 ? 49 + i : 6;
        double knot = i < 4 ? 0 : random.number(-3, 3);
        std::vector<double> knots(3, knot);
        for (int k = 1; k < spans; ++k) knots.push_back(knot += i < 4 ? 1 : random.number(0.1, 1.1));
        knots.insert(knots.end(), 3, knot + 1);
        Grid<Point> points(std::size_t(spans + 2), std::vector<Point>(2));
        for (std::size_t k = 0; k < points.size(); ++k)
            for (std::size_t j = 0; j < 2; ++j) points[k][j] = {double(k), 4.0 * double(j), random.number(-1, 1)};
        const Patch patch = make_bspline_patch(2, 1, knots, {0, 0, 1, 1}, points);
        const auto t = patch.edge_breaks(0), u = patch.breaks_u();
        for (std::size_t k = 0; k < u.size(); ++k) EXPECT_EQ(patch.edge_point(0, t[k]).x, u[k]);
        const Tessellation mesh = tessellate_relative({{"S", patch}}, 1e-2);
        const double whole = knots.back() - knots.front();
        EXPECT_NEAR(covered(mesh.mesh.parts[0]), whole, 1e-12 * whole) << i;
        EXPECT_EQ(mesh.topology.t_junctions, 0u);
        EXPECT_EQ(mesh.topology.boundary_loops, 1u);
    }
}

// Proofs take triangles that cover the domain once. Rows of different lengths, as towards a pole, beside a dense rim tempt strips to fold over.
TEST(Tessellate, EveryTriangleTurnsTheSameWayInTheDomain) {
    Random random(38);
    std::size_t triangles = 0;
    for (int k = 0; k < 12; ++k) {
        Grid<Point> net(4, std::vector<Point>(4));
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) net[i][j] = {i / 3.0 * (k % 4 == 3 ? 1 : j / 3.0), j / 3.0, j == 0 && k % 4 != 3 ? 0 : 0.25 * (2 * random.number() - 1)};
        if (k % 4 == 1) std::swap(net[0], net[3]), std::swap(net[1], net[2]);
        if (k % 4 == 2)
            for (auto& row : net) std::swap(row[0], row[3]), std::swap(row[1], row[2]);
        const Composite surface{{"s", make_bezier_patch(net)}};
        for (double relative = 4e-3; relative > 3e-4; relative *= 0.83) {
            const Tessellation t = tessellate_relative(surface, relative, k % 2 ? Measure::parametric : Measure::geometric);
            for (const MeshPart& part : t.mesh.parts) {
                auto all = part.triangles;
                if (part.flipped)
                    for (auto& c : all) std::swap(c[1], c[2]);
                all.insert(all.end(), part.left_out.begin(), part.left_out.end());
                triangles += all.size();
                for (const auto& c : all) {
                    const Vec2 &p = part.uv[c[0]], &q = part.uv[c[1]], &r = part.uv[c[2]];
                    EXPECT_GT((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x), 0) << "net " << k << " at " << relative;
                }
            }
        }
    }
    EXPECT_GT(triangles, 10000u);
}
TEST(Tessellate, NothingSmallerThanTheToleranceIsLost) {
    const Patch plane = make_bezier_patch({{{0, 0, 0}, {0, 1, 0}}, {{1, 0, 0}, {1, 1, 0}}});
    const Patch tiny = transformed(plane, Transform::translate({10, 0, 0}) * Transform::scale({1e-8, 1e-8, 1e-8}));
    const Patch lune = make_bezier_patch({{{10, 0, 0}, {9.9995, 1, 0}, {10, 2, 0}}, {{10, 0, 0}, {10.0005, 1, 0}, {10, 2, 0}}});  // two poles
    const Patch point = transformed(plane, Transform::translate({10, 0, 0}) * Transform::scale({0, 0, 0}));
    for (const Patch& thin : {tiny, lune, point}) {
        const Tessellation t = tessellate({{"plane", plane}, {"thin", thin}}, {1e-2, Measure::parametric, 1000, {}});
        EXPECT_GT(t.mesh.parts[1].triangles.size(), 0u);
    }
}

TEST(Tessellate, SphereIsClosedAndOnTheUnitSphere) {
    for (const double relative : {1e-1, 1e-2, 1e-3, 1e-4}) {
        const Tessellation t = tessellate_relative(sphere(), relative);
        EXPECT_LE(t.certified_error, t.tolerance);
        EXPECT_EQ(t.topology.boundary_edges, 0u);
        EXPECT_EQ(t.topology.t_junctions, 0u);
        EXPECT_EQ(t.topology.non_manifold_edges, 0u);
        EXPECT_EQ(t.topology.degenerate_triangles, 0u);
        double volume = 0;
        std::size_t edges = 0;
        for (const auto& part : t.mesh.parts)
            for (const auto& c : part.triangles) {
                const Point &a = t.mesh.positions[part.vertex[c[0]]], &b = t.mesh.positions[part.vertex[c[1]]], &d = t.mesh.positions[part.vertex[c[2]]];
                volume += dot(a, cross(b, d)) / 6;
                edges += 3;
            }
        for (const auto& p : t.mesh.positions) EXPECT_NEAR(length(p), 1, 1e-14);
        // Euler: V - E + F = 2. All triangles wind the same way, so the volume is that of a ball less a shell.
        EXPECT_EQ(t.mesh.positions.size() + t.mesh.triangle_count() - edges / 2, 2u);
        const double ball = 4 * M_PI / 3;
        EXPECT_LT(std::abs(volume), ball);
        EXPECT_GT(std::abs(volume), ball - 4 * M_PI * t.tolerance);
    }
}

// Two Coons patches that meet in every way two quads can: 4 edges x 4 edges x 2 directions.
TEST(Tessellate, SharedEdgesAreFoundInEveryOrientation) {
    const auto net = [](int edge, bool backwards, const std::vector<Point>& shared, const Point& away) {
        std::vector<std::vector<Point>> p(4, std::vector<Point>(4));
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                const int along = edge == 0 || edge == 2 ? i : j, across = edge == 0 ? j : edge == 2 ? 3 - j : edge == 3 ? i : 3 - i;
                p[i][j] = shared[backwards ? 3 - along : along] + (across / 3.0) * away + Point{0, 0, 0.3 * across * along / 9.0};
                if (across == 0) p[i][j] = shared[backwards ? 3 - along : along];
            }
        return make_bezier_patch(p);
    };
    const std::vector<Point> shared{{0, 0, 0}, {0, 1, 0.7}, {0, 2, -0.5}, {0, 3, 0.2}};
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
            for (const bool backwards : {false, true}) {
                const Composite pair{{"a", net(a, false, shared, {2, 0, 0.4})}, {"b", net(b, backwards, shared, {-2, 0, 0.8})}};
                const Tessellation t = tessellate_relative(pair, 1e-3);
                EXPECT_EQ(t.topology.boundary_loops, 1u) << a << " " << b << " " << backwards;
                EXPECT_EQ(t.topology.t_junctions, 0u);
                EXPECT_EQ(t.topology.non_manifold_edges, 0u);
            }
}

TEST(Tessellate, PartOfAnEdgeIsShared) {
    // One long edge against two patches of half the length each, one of them reversed, and another parametrisation.
    const std::vector<Point> curve{{0, 0, 0}, {1, 0, 1}, {2, 0, -1}, {3, 0, 0}};
    const Curve whole = make_bezier(curve);
    const auto below = [&](const Curve& top, const Point& shift) {
        return make_coons({transformed(top, Transform::translate(shift)), top, make_bezier({top(0) + shift, top(0)}), make_bezier({top(1) + shift, top(1)})});
    };
    const Curve left = segment(whole, 0, 0.4), right = reversed(segment(whole, 0.4, 1));
    // The same cubic arc, run faster at its end: a rational curve by a Moebius map of the parameter.
    const Curve bent = make_bezier(curve, {1, 2, 4, 8});
    for (const Curve& top : {whole, bent}) {
        const Composite c{{"whole", below(top, {0, -2, 0})}, {"left", below(left, {0, 2, 0})}, {"right", below(right, {0, 2, 0})}};
        const Tessellation t = tessellate_relative(c, 1e-3);
        EXPECT_EQ(t.topology.boundary_loops, 1u);
        EXPECT_EQ(t.topology.t_junctions, 0u);
        EXPECT_LE(t.certified_error, t.tolerance);
        Random random(3);
        EXPECT_LE(worst_excess(c, t, random, 5), 1e-12);
    }
}

TEST(Tessellate, SeamOfAClosedPatchIsOneEdge) {
    // A full cylinder as one rational patch of four quarter arcs: u = 0 and u = 1 coincide.
    const double s = std::sqrt(0.5);
    const double ring[9][3] = {{1, 0, 1}, {1, 1, s}, {0, 1, 1}, {-1, 1, s}, {-1, 0, 1}, {-1, -1, s}, {0, -1, 1}, {1, -1, s}, {1, 0, 1}};
    std::vector<std::vector<Point>> p;
    std::vector<std::vector<double>> w;
    for (const auto& r : ring) p.push_back({{r[0], r[1], 0}, {r[0], r[1], 2}}), w.push_back({r[2], r[2]});
    const Composite c{{"cylinder", make_bspline_patch(2, 1, {0, 0, 0, .25, .25, .5, .5, .75, .75, 1, 1, 1}, {0, 0, 1, 1}, p, w)}};
    for (const double relative : {0.3, 1e-2, 1e-3}) {
        const Tessellation t = tessellate_relative(c, relative);
        EXPECT_EQ(t.topology.boundary_loops, 2u);
        EXPECT_EQ(t.topology.t_junctions, 0u);
        EXPECT_EQ(t.topology.non_manifold_edges, 0u);
    }
}

TEST(Tessellate, TouchingSheetsStayManifold) {
    // Four sheets through one line: two surfaces that touch, not a branching one.
    const auto sheet = [](double x, double z) { return make_bezier_patch({{{0, 0, 0}, {0, 1, 0}}, {{x, 0, z}, {x, 1, z}}}); };
    const Composite c{{"a", sheet(1, 0.1)}, {"b", sheet(-1, 0.1)}, {"c", sheet(1, -0.1)}, {"d", sheet(-1, -0.1)}};
    const Tessellation t = tessellate_relative(c, 1e-2);
    EXPECT_EQ(t.topology.non_manifold_edges, 0u);
    EXPECT_EQ(t.topology.t_junctions, 0u);
    EXPECT_EQ(t.topology.boundary_edges, 12u);  // three open edges a sheet; the shared line is inside both surfaces
}

TEST(Tessellate, ThreeSheetsOnOneEdgeMakeAManifoldWithAnOpenEdge) {
    const auto sheet = [](double x, double z) { return make_bezier_patch({{{0, 0, 0}, {0, 1, 0}}, {{x, 0, z}, {x, 1, z}}}); };
    const Composite c{{"a", sheet(1, 0)}, {"b", sheet(-1, 0)}, {"c", sheet(0.1, 1)}};
    const Tessellation t = tessellate_relative(c, 1e-2);
    EXPECT_EQ(t.topology.non_manifold_edges, 0u);
    EXPECT_EQ(t.topology.t_junctions, 0u);
    EXPECT_GE(t.topology.boundary_edges, 6u + 4u);  // the rims on the common line are split apart
}

TEST(Tessellate, SizesThatDoublesCannotSquareAreRefused) {
    for (const double size : {1e-100, 1e100})
        EXPECT_THROW(tessellate_relative({{"S", transformed(octant(), Transform::scale({size, size, size}))}}, 1e-2), Error);
    for (const double size : {1e-60, 1e60}) {
        const Tessellation t = tessellate_relative({{"S", transformed(octant(), Transform::scale({size, size, size}))}}, 1e-2);
        EXPECT_LE(t.certified_error, t.tolerance);
    }
}

TEST(Tessellate, OpenEdgesThatDoNotMeetAreCountedAsTJunctionsByAnalyse) {
    // Must-fail case of the integer check: two triangles against one edge that was not split.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    MeshPart part;
    part.uv.resize(5);
    part.vertex = {0, 1, 2, 3, 4};
    part.triangles = {{0, 1, 3}, {0, 4, 2}, {2, 4, 1}};
    mesh.parts.push_back(part);
    EXPECT_EQ(analyse(mesh, {{0, 3}, {1, 3}, {0, 4}, {1, 4}}).t_junctions, 3u);
}

TEST(TessellateThreads, SameMeshForEveryNumberOfThreads) {
    std::vector<Tessellation> results;
    for (const int threads : {1, 2, 7}) {
        tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
        results.push_back(tessellate_relative(sphere(), 1e-3, Measure::geometric));
    }
    for (const auto& r : results) {
        ASSERT_EQ(r.mesh.positions.size(), results[0].mesh.positions.size());
        for (std::size_t i = 0; i < r.mesh.positions.size(); ++i) ASSERT_TRUE(r.mesh.positions[i] == results[0].mesh.positions[i]);
        for (std::size_t k = 0; k < r.mesh.parts.size(); ++k) {
            ASSERT_EQ(r.mesh.parts[k].triangles, results[0].mesh.parts[k].triangles);
            ASSERT_EQ(r.mesh.parts[k].vertex, results[0].mesh.parts[k].vertex);
        }
        EXPECT_EQ(r.certified_error, results[0].certified_error);
        EXPECT_EQ(r.sampled_error, results[0].sampled_error);
    }
}

TEST(Tessellate, BudgetEndsWithWhatWasReachedAndWhatIsNeeded) {
    TessellationOptions options;
    options.tolerance = 1e-12;
    try {
        tessellate(sphere(), options);
        FAIL() << "a tolerance of 1e-12 needs about 1e12 triangles";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::budget);
        EXPECT_NE(std::string(e.what()).find("triangles would be needed"), std::string::npos) << e.what();
    }
    options.tolerance = 0;
    EXPECT_THROW(tessellate(sphere(), options), Error);
}

TEST(Tessellate, BudgetRefusesAtOnceWhatIsClearlyTooMuchAndNothingThatFits) {
    std::vector<std::vector<Point>> net(4, std::vector<Point>(4));
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) net[i][j] = {i / 3.0, j / 3.0, 0.3 * i * i - 0.2 * j * j + 0.03 * i * j * j};
    const Composite surface{{"bicubic", make_bezier_patch(net)}};
    const auto bicubic = [&](Measure measure, double tolerance, std::size_t most) {
        TessellationOptions options;
        options.tolerance = tolerance, options.measure = measure, options.max_triangles = most, options.study = false;
        return tessellate(surface, options).mesh.triangle_count();
    };
    for (const Measure measure : {Measure::geometric, Measure::parametric}) {
        const std::size_t needed = bicubic(measure, 1e-3, 1'000'000);
        for (const double share : {1.0, 1.1, 1.5}) EXPECT_LE(bicubic(measure, 1e-3, std::size_t(share * double(needed))), std::size_t(share * double(needed)));
        const auto begin = std::chrono::steady_clock::now();
        try {
            bicubic(measure, 1e-10, 10'000'000);
            FAIL() << "1e-3 takes " << needed << " triangles, 1e-10 ten million times as many";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::budget);
            const std::string text = e.what();
            const double told = std::stod(text.substr(text.find("about ") + 6)), likely = 1e7 * double(needed);
            EXPECT_TRUE(told > 0.5 * likely && told < 2 * likely) << text << " where " << likely << " are likely";
            EXPECT_EQ(text.find("certified error"), std::string::npos) << "it was tried: " << text;
        }
        EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 5);
    }
}

}  // namespace
}  // namespace isoparm::tests
