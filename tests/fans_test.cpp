// What bounding the triangles at a collapsed edge as one promises: few triangles on cones, and a bound that samples of the surface, taken here
// without anything of the mesher, do not exceed in either direction.
#include <gtest/gtest.h>

#include <cmath>

#include "curves/bezier.h"
#include "error.h"
#include "mesh.h"
#include "patches/cone.h"
#include "patches/tensor_bezier.h"
#include "samples.h"
#include "tessellation_options.h"

namespace isoparm::tests {
namespace {

Tessellation meshed(const Composite& surface, double relative, bool fans, Quality quality = Quality::fast) {
    TessellationOptions options = options_of(surface, relative, Measure::geometric);
    options.fans = fans, options.quality = quality;
    return tessellate(surface, options);
}

double to_mesh(const Mesh& mesh, const Point& x) {
    double least = HUGE_VAL;
    for (const MeshPart& part : mesh.parts)
        for (const auto& t : part.triangles)
            least = std::min(least, distance_to_triangle(x, mesh.positions[part.vertex[t[0]]], mesh.positions[part.vertex[t[1]]], mesh.positions[part.vertex[t[2]]]));
    return least;
}

/// The largest distance of samples of the patch from the mesh; of middles of triangles from samples, less what lies between those.
void expect_within(const Composite& surface, const Tessellation& t) {
    constexpr int n = 48;
    const Rect r = surface[0].patch.rect();
    std::vector<Point> samples;
    for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= n; ++k) samples.push_back(surface[0].patch.point(r.u0 + (r.u1 - r.u0) * i / n, r.v0 + (r.v1 - r.v0) * k / n));
    for (const Point& x : samples) ASSERT_LE(to_mesh(t.mesh, x), t.certified_error);
    double apart = 0;  // of neighbours among the samples
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const auto at = [&](int a, int b) { return samples[std::size_t(a * (n + 1) + b)]; };
            apart = std::max({apart, distance(at(i, k), at(i + 1, k + 1)), distance(at(i + 1, k), at(i, k + 1))});
        }
    for (const MeshPart& part : t.mesh.parts)
        for (const auto& c : part.triangles) {
            const Point middle = (t.mesh.positions[part.vertex[c[0]]] + t.mesh.positions[part.vertex[c[1]]] + t.mesh.positions[part.vertex[c[2]]]) / 3.0;
            double least = HUGE_VAL;
            for (const Point& x : samples) least = std::min(least, distance(x, middle));
            ASSERT_LE(least, t.certified_error + apart);
        }
    EXPECT_LE(t.sampled_error, t.certified_error);
    EXPECT_LE(t.certified_error, t.tolerance);
    EXPECT_EQ(t.topology.t_junctions, 0u);
    EXPECT_EQ(t.topology.non_manifold_edges, 0u);
}

/// Points of degree (3,3) whose edge `edge` is one point: 0: v = 0, 1: u = 1, 2: v = 1, 3: u = 0.
Patch with_pole(Random& random, int edge) {
    std::vector<std::vector<Point>> net(4, std::vector<Point>(4));
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            const double along = (edge % 2 ? j : i) / 3.0, up = (edge == 0 ? 3 - j : edge == 1 ? i : edge == 2 ? j : 3 - i) / 3.0;
            net[std::size_t(i)][std::size_t(j)] = {(1 - up) * std::cos(2 * along), (1 - up) * std::sin(2 * along), up + (up < 1 ? 0.2 : 0.0) * random.point().x};
        }
    return make_bezier_patch(net);
}

TEST(Fans, ConesTakeAsManyTrianglesAsTheirCurveHasChords) {
    const Composite cone{{"cone", make_cone(make_bezier({{0, 0, 0}, {1, 2, 0.3}, {3, 2, -0.2}, {4, 0, 0}}), {1, 0, 3})}};
    const Tessellation alone = meshed(cone, 1e-4, false), together = meshed(cone, 1e-4, true), finer = meshed(cone, 1e-6, true);
    EXPECT_LT(together.mesh.triangle_count() * 5, alone.mesh.triangle_count());
    EXPECT_LT(finer.mesh.triangle_count(), 15 * together.mesh.triangle_count()) << "chords grow with the root of the tolerance";
    expect_within(cone, together);
}

/// At a coarse tolerance too: there single triangles would take more than at a finer one.
TEST(Fans, FinerConesHaveMoreTriangles) {
    const Composite cone{{"cone", make_cone(make_bezier({{0, 0, 0}, {1, 2, 0.3}, {3, 2, -0.2}, {4, 0, 0}}), {1, 0, 3})}};
    std::size_t coarser = 0;
    for (const double relative : {1e-1, 3e-2, 1e-2, 3e-3, 1e-3}) {
        const Tessellation t = meshed(cone, relative, true);
        EXPECT_GT(t.mesh.triangle_count(), coarser) << relative;
        EXPECT_LT(double(t.mesh.triangle_count()), 3 / std::sqrt(relative)) << relative;
        expect_within(cone, t);
        coarser = t.mesh.triangle_count();
    }
}

TEST(Fans, KeepTheirBoundOnEveryEdgeAndInBothQualities) {
    Random random(7);
    for (int edge = 0; edge < 4; ++edge)
        for (const Quality quality : {Quality::fast, Quality::optimal}) {
            if (quality == Quality::optimal && edge % 3 != 0) continue;  // slow
            SCOPED_TRACE(edge);
            const Composite surface{{"pole", with_pole(random, edge)}};
            for (const double relative : {2e-3, 4e-3}) expect_within(surface, meshed(surface, relative, true, quality));
        }
}

TEST(Fans, TwoPolesAndTwoCollapsedEdgesThatMeet) {
    std::vector<std::vector<Point>> lune(4, std::vector<Point>(4)), corner(4, std::vector<Point>(4));
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            const double wide = j == 0 || j == 3 ? 0 : 1;
            lune[std::size_t(i)][std::size_t(j)] = {wide * (i - 1.5) / 3, 0.3 * wide * (i == 1 || i == 2), j / 3.0};
            corner[std::size_t(i)][std::size_t(j)] = i == 0 || j == 0 ? Point{0, 0, 0} : Point{i / 3.0, j / 3.0, 0.2 * i * j / 9.0};
        }
    for (const auto& net : {lune, corner}) {
        const Composite surface{{"s", make_bezier_patch(net)}};
        expect_within(surface, meshed(surface, 1e-3, true));
    }
}

TEST(Fans, BoundsOfSingleTrianglesAndNormalsDoWithout) {
    const Composite cone{{"cone", make_cone(make_bezier({{0, 0, 0}, {1, 2, 0.3}, {3, 2, -0.2}, {4, 0, 0}}), {1, 0, 3})}};
    TessellationOptions options = options_of(cone, 1e-3, Measure::geometric);
    options.bounds = true;
    const std::size_t alone = tessellate(cone, options).mesh.triangle_count();
    options.fans = true;
    EXPECT_EQ(tessellate(cone, options).mesh.triangle_count(), alone);
}

TEST(Fans, TheBudgetCountsTrianglesOfTheMeshAlone) {
    const Composite cone{{"cone", make_cone(make_bezier({{0, 0, 0}, {1, 2, 0.3}, {3, 2, -0.2}, {4, 0, 0}}), {1, 0, 3})}};
    TessellationOptions options = options_of(cone, 1e-4, Measure::geometric);
    options.fans = true, options.study = false;
    const std::size_t n = tessellate(cone, options).mesh.triangle_count();
    options.max_triangles = n;
    try {
        EXPECT_EQ(tessellate(cone, options).mesh.triangle_count(), n);
        options.max_triangles = n - 1;
        tessellate(cone, options);
        FAIL() << n << " triangles are more than " << n - 1;
    } catch (const Error& e) {
        const std::string text = e.what();
        EXPECT_EQ(e.kind(), ErrorKind::budget);
        EXPECT_EQ(options.max_triangles, n - 1) << text;
        EXPECT_EQ(text.find("certified error is 0"), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace isoparm::tests
