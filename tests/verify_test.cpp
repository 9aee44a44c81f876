// Meshes against surfaces: intervals that hold known distances, and everything that can be wrong with a mesh found.
#include "verify.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "error.h"
#include "meshes/mesh_defects.h"
#include "meshes/triangle_tree.h"
#include "patches/tensor_bezier.h"
#include "run_program.h"
#include "samples.h"
#include "scene/scene.h"
#include "tessellation_options.h"

namespace isoparm::tests {
namespace {

Composite surface_of(const std::string& scene, const std::string& name) { return load_scene(test::source_folder() + "/scenes/" + scene + ".json").find_surface(name)->patches; }
Composite sphere() { return surface_of("sphere", "sphere"); }
/// The unit square in the plane z = 0.
Composite square() { return {{"square", make_bezier_patch({{{0, 0, 0}, {0, 1, 0}}, {{1, 0, 0}, {1, 1, 0}}})}}; }

/// n x n cells of the square, two triangles each.
TriangleMesh grid(int n) {
    TriangleMesh m;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) m.points.push_back({double(i) / n, double(j) / n, 0});
    const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            m.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return m;
}
TriangleMesh octahedron() {
    return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}
TriangleMesh icosahedron() {
    const double g = (1 + std::sqrt(5.0)) / 2, s = 1 / std::sqrt(1 + g * g), t = g * s;
    return {{{-s, t, 0}, {s, t, 0}, {-s, -t, 0}, {s, -t, 0}, {0, -s, t}, {0, s, t}, {0, -s, -t}, {0, s, -t}, {t, 0, -s}, {t, 0, s}, {-t, 0, -s}, {-t, 0, s}},
            {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8}, {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8}, {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7}, {9, 8, 1}}};
}
double brute_distance(const Point& p, const TriangleMesh& mesh) {
    double least = HUGE_VAL;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = mesh.corners(t);
        least = std::min(least, distance_to_triangle(p, a, b, c));
    }
    return least;
}
void expect_holds(const DirectedDistance& d, double truth, double gap) {
    EXPECT_LE(d.lower, truth * (1 + 1e-12));
    EXPECT_GE(d.upper, truth * (1 - 1e-12));
    EXPECT_LE(d.upper - d.lower, gap * d.upper);
    EXPECT_TRUE(d.narrowed);
}

TEST(TriangleTree, DistancesAreThoseOfAllTriangles) {
    for (int round = 0; round < 40; ++round) {
        Random random(100 + round);
        const double scale = std::pow(10.0, random.integer(-20, 20));
        TriangleMesh mesh;
        const int n = random.integer(1, 60);
        for (int i = 0; i < 3 * n; ++i) {
            Point p = random.point();
            if (i % 3 > 0 && random.integer(0, 3) == 0) p = mesh.points.back() + std::pow(10.0, random.integer(-18, -1)) * scale * random.vector();  // needles, segments, points
            else p = scale * p;
            mesh.points.push_back(p);
        }
        for (int i = 0; i < n; ++i) mesh.triangles.push_back({std::uint32_t(3 * i), std::uint32_t(3 * i + 1), std::uint32_t(3 * i + 2)});
        const TriangleTree tree(mesh);
        for (int k = 0; k < 100; ++k) {
            const Point p = k % 3 ? scale * random.point({}, 2) : mesh.points[std::size_t(random.integer(0, 3 * n - 1))] + 1e-9 * scale * random.vector();
            const double truth = brute_distance(p, mesh), down = tree.distance_down(p), near = tree.nearest(p).distance;
            ASSERT_LE(down, truth + 1e-15 * scale);
            ASSERT_NEAR(near, truth, 1e-7 * scale);  // exact but for needles, whose width counts
            ASSERT_GE(down, truth * (1 - 1e-9) - 1e-6 * scale);  // weak only beside needles
            ASSERT_EQ(tree.any_within(p, near * (1 + 1e-9) + 1e-13 * scale), true);
        }
    }
}

TEST(Verify, PolyhedraInTheUnitSphereAreAsFarAsTheirInradiusTells) {
    // Inscribed, the middles of faces are farthest both ways: 1 minus the inradius, which is 1/sqrt 3 and, for the icosahedron, sqrt((5 + 2 sqrt 5)/15).
    for (const auto& [mesh, inradius] : {std::pair{octahedron(), 1 / std::sqrt(3.0)}, std::pair{icosahedron(), std::sqrt((5 + 2 * std::sqrt(5.0)) / 15)}})
        for (const double gap : {0.2, 0.05, 0.01}) {
            VerifyOptions options;
            options.gap = gap;
            const Verification v = verify(mesh, sphere(), options);
            expect_holds(v.surface_to_mesh, 1 - inradius, gap);
            expect_holds(v.mesh_to_surface, 1 - inradius, gap);
            EXPECT_TRUE(v.stopped.empty());
            EXPECT_LT(v.normals.most, 3);  // faces are parallel to the sphere above their middles
            EXPECT_EQ(v.normals.against, 0u);
            EXPECT_TRUE(v.border.empty());
        }
}
TEST(Verify, AMeshOutsideOfTheSphere) {
    // The circumscribed cube: its corners are sqrt 3 - 1 away, and (1,1,1)/sqrt 3 of the sphere is 1 - 1/sqrt 3 from each of three faces.
    TriangleMesh cube;
    for (int i = 0; i < 8; ++i) cube.points.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
    for (const auto& f : std::vector<std::array<std::uint32_t, 4>>{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
        cube.triangles.push_back({f[0], f[1], f[2]}), cube.triangles.push_back({f[0], f[2], f[3]});
    const Verification v = verify(cube, sphere(), {});
    expect_holds(v.mesh_to_surface, std::sqrt(3.0) - 1, 0.05);
    expect_holds(v.surface_to_mesh, 1 - 1 / std::sqrt(3.0), 0.05);
    EXPECT_NEAR(std::fabs(v.mesh_to_surface.at.x * v.mesh_to_surface.at.y * v.mesh_to_surface.at.z), 1, 1e-9);
}

class VerifyOwn : public testing::TestWithParam<std::pair<const char*, const char*>> {};
TEST_P(VerifyOwn, WhatIsCertifiedIsConfirmed) {
    const Composite surface = surface_of(GetParam().first, GetParam().second);
    for (const double relative : {3e-2, 1e-2}) {
        VerifyOptions options;
        options.gap = 0.2;
        const Tessellation t = tessellate(surface, options_of(surface, relative, Measure::geometric));
        const TriangleMesh mesh = triangles_of(t.mesh);
        const Verification v = verify(mesh, surface, options);
        // The certificate, the interval and what random points tell must agree.
        EXPECT_LE(v.lower(), t.certified_error);
        EXPECT_LE(v.upper(), t.certified_error * 1.25);
        EXPECT_TRUE(v.surface_to_mesh.narrowed && v.mesh_to_surface.narrowed) << v.stopped;
        EXPECT_GE(brute_distance(v.surface_to_mesh.at, mesh), v.surface_to_mesh.lower * (1 - 1e-9));
        Random random(5);
        for (int k = 0; k < 400; ++k) {
            const Member& m = surface[std::size_t(random.integer(0, int(surface.size()) - 1))];
            const Vec2 uv = random_parameter(random, m.patch);
            ASSERT_LE(brute_distance(m.patch.point(uv.x, uv.y), mesh), v.surface_to_mesh.upper);
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Scenes, VerifyOwn, testing::Values(std::pair("coons", "S"), std::pair("sphere", "sphere"), std::pair("cone", "cone")),
                         [](const auto& i) { return std::string(i.param.first); });

TEST(Verify, AVertexMovedIsAsFarAsItMoved) {
    TriangleMesh mesh = grid(8);
    const double d = 0.0371;
    mesh.points[4 * 9 + 4].z = d;  // the tip of a pyramid over the square
    const Verification v = verify(mesh, square(), {});
    expect_holds(v.mesh_to_surface, d, 0.05);
    EXPECT_EQ(v.mesh_to_surface.at, mesh.points[4 * 9 + 4]);
    double most = 0;
    for (int i = 0; i <= 200; ++i)
        for (int j = 0; j <= 200; ++j) most = std::max(most, brute_distance({0.375 + 0.25 * i / 200, 0.375 + 0.25 * j / 200, 0}, mesh));
    EXPECT_GE(v.surface_to_mesh.upper, most);
    EXPECT_LE(v.surface_to_mesh.lower, most * 1.001);
    EXPECT_TRUE(v.surface_to_mesh.narrowed);
}
TEST(Verify, AHoleIsSeenFromTheSurfaceAlone) {
    TriangleMesh mesh = grid(8);
    mesh.triangles.erase(mesh.triangles.begin() + 2 * (8 * 3 + 3));  // a right triangle with legs 1/8: its incircle has the radius 1/8 (1 - sqrt(1/2))
    const Verification v = verify(mesh, square(), {});
    expect_holds(v.surface_to_mesh, 0.125 * (1 - std::sqrt(0.5)), 0.05);
    EXPECT_LE(v.mesh_to_surface.upper, 1e-10);
    const MeshDefects d = find_defects(mesh, 1e-9);
    EXPECT_EQ(d.boundary_loops, 2u);
    EXPECT_EQ(d.open_edges.size(), 32u + 3);
    EXPECT_EQ(count_holes(mesh, d, v.border, 1e-9), 1u);
    EXPECT_EQ(d.t_junctions.size(), 0u);
}
TEST(Verify, AMissingPatchIsAHoleAndFar) {
    Composite surface = sphere();
    TessellationOptions how;
    how.tolerance = 0.01;
    Composite seven(surface.begin(), surface.end() - 1);
    const TriangleMesh mesh = triangles_of(tessellate(seven, how).mesh);
    const Verification v = verify(mesh, surface, {});
    // The middle of an octant, (1,1,1)/sqrt 3, sees the quarter circles around it at 2 sin(35.26/2 degrees), and the mesh's chords a little nearer.
    const double away = 2 * std::sin(0.5 * std::asin(1 / std::sqrt(3.0)));
    EXPECT_LE(v.surface_to_mesh.lower, away + 0.01);
    EXPECT_GE(v.surface_to_mesh.upper, away - 0.01);
    EXPECT_TRUE(v.surface_to_mesh.narrowed);
    EXPECT_LE(v.mesh_to_surface.upper, 0.0106);
    EXPECT_EQ(v.surface_to_mesh.member, 7u);
    const MeshDefects d = find_defects(mesh, 1e-9);
    EXPECT_EQ(d.boundary_loops, 1u);
    EXPECT_EQ(count_holes(mesh, d, v.border, 0.05), 1u);
}
TEST(Verify, RandomTrianglesNeverLeaveTheirInterval) {
    const Composite surface = surface_of("coons", "S");
    const double size = bounding_box(surface).diagonal();
    for (int round = 0; round < 4; ++round) {
        Random random(round);
        TriangleMesh mesh;
        for (int i = 0; i < 60; ++i) mesh.points.push_back({random.number(-1, 4), random.number(-1, 4), random.number(-1, 2)});
        for (std::uint32_t i = 0; i < 40; ++i) mesh.triangles.push_back({std::uint32_t(random.integer(0, 59)), std::uint32_t(random.integer(0, 59)), std::uint32_t(random.integer(0, 59))});
        VerifyOptions options;
        options.gap = 0.1;
        const Verification v = verify(mesh, surface, options);
        EXPECT_LE(v.upper(), 3 * size);
        EXPECT_TRUE(v.surface_to_mesh.narrowed && v.mesh_to_surface.narrowed) << v.stopped;
        for (int k = 0; k < 2000; ++k) {
            const Vec2 uv = random_parameter(random, surface[0].patch);
            ASSERT_LE(brute_distance(surface[0].patch.point(uv.x, uv.y), mesh), v.surface_to_mesh.upper);
        }
        TessellationOptions how;
        how.tolerance = 1e-3 * size;
        const TriangleTree fine(triangles_of(tessellate(surface, how).mesh));
        for (int k = 0; k < 2000; ++k) {
            const auto [a, b, c] = mesh.corners(std::size_t(random.integer(0, 39)));
            double s = random.number(), r = random.number();
            if (s + r > 1) s = 1 - s, r = 1 - r;
            ASSERT_LE(fine.nearest(a + s * (b - a) + r * (c - a)).distance, v.mesh_to_surface.upper + how.tolerance);
        }
    }
}
TEST(Verify, ScaleAndPlaceDoNotMatter) {
    for (const double scale : {1e-30, 1e-6, 1e9, 1e30}) {
        Composite surface{{"bump", make_bezier_patch({{{0, 0, 0}, {0, scale, 0}}, {{scale, 0, 0}, {scale, scale, scale}}})}};
        TriangleMesh mesh = grid(1);
        for (Point& p : mesh.points) p = scale * Point{p.x, p.y, p.x * p.y};
        const Verification v = verify(mesh, surface, {});
        // z = xy over the diagonal x = y: the chord is 1/4 above in height at the middle, where the normal is (-1,-1,2): less is the distance.
        EXPECT_TRUE(v.surface_to_mesh.narrowed && v.mesh_to_surface.narrowed) << v.stopped;
        EXPECT_GT(v.lower(), 0.15 * scale);
        EXPECT_LT(v.upper(), 0.25 * scale);
    }
    TriangleMesh far = grid(2);
    for (Point& p : far.points) p.x = 1e60;
    EXPECT_THROW(verify(far, square(), {}), Error);
}
TEST(Verify, ASmallBudgetGivesAWiderInterval) {
    VerifyOptions options;
    options.max_triangles = 300;
    options.gap = 0.001;
    const Verification v = verify(icosahedron(), sphere(), options);
    const double truth = 1 - std::sqrt((5 + 2 * std::sqrt(5.0)) / 15);
    EXPECT_LE(v.lower(), truth);
    EXPECT_GE(v.upper(), truth);
    EXPECT_FALSE(v.mesh_to_surface.narrowed);
    EXPECT_NE(v.stopped.find("--max-triangles"), std::string::npos) << v.stopped;
    EXPECT_LE(v.finer_triangles, 600u);
}
TEST(Verify, ALimitWithinTheIntervalNarrowsItFurther) {
    const double truth = 1 - 1 / std::sqrt(3.0);
    for (const double factor : {0.99, 1.01}) {
        VerifyOptions options;
        options.limit = factor * truth;
        const Verification v = verify(octahedron(), sphere(), options);
        EXPECT_TRUE(factor > 1 ? v.upper() <= *options.limit : v.lower() > *options.limit) << v.lower() << " " << v.upper();
        EXPECT_LE(v.lower(), truth);
        EXPECT_GE(v.upper(), truth);
    }
}
TEST(Verify, TheResultDoesNotDependOnThreads) {
    const Composite surface = surface_of("coons", "S");
    TessellationOptions how;
    how.tolerance = 2e-2;
    const TriangleMesh mesh = triangles_of(tessellate(surface, how).mesh);
    std::vector<Verification> all;
    for (const std::size_t threads : {1, 2, 7}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        all.push_back(verify(mesh, surface, {}));
    }
    for (const Verification& v : all)
        for (const auto way : {&Verification::surface_to_mesh, &Verification::mesh_to_surface}) {
            EXPECT_EQ((v.*way).lower, (all[0].*way).lower);
            EXPECT_EQ((v.*way).upper, (all[0].*way).upper);
            EXPECT_EQ((v.*way).at, (all[0].*way).at);
        }
}

TEST(MeshDefects, AGoodMeshHasNone) {
    const MeshDefects d = find_defects(icosahedron(), 1e-9);
    EXPECT_EQ(d.open_edges.size() + d.boundary_loops + d.non_manifold_edges + d.non_manifold_vertices + d.inconsistent_edges + d.degenerate_triangles + d.duplicate_triangles + d.unused_vertices +
                  d.equal_vertices + d.t_junctions.size(),
              0u);
    EXPECT_EQ(d.components, 1u);
    const TriangleShapes s = measure_shapes(icosahedron());
    EXPECT_NEAR(s.least_angle, 60, 1e-12);
    EXPECT_NEAR(s.most_aspect, 1, 1e-12);
}
TEST(MeshDefects, AFlippedTriangle) {
    TriangleMesh mesh = icosahedron();
    std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
    EXPECT_EQ(find_defects(mesh, 1e-9).inconsistent_edges, 3u);
    EXPECT_EQ(verify(mesh, sphere(), {}).normals.against, 1u);
}
TEST(MeshDefects, ATJunction) {
    TriangleMesh mesh = grid(1);  // the diagonal 0-3, with a vertex on one side of it only
    mesh.points.push_back({0.5, 0.5 + 1e-8, 0});
    mesh.triangles = {{0, 2, 3}, {0, 4, 1}, {4, 3, 1}};
    const MeshDefects d = find_defects(mesh, 1e-7);
    ASSERT_EQ(d.t_junctions.size(), 1u);
    EXPECT_EQ(d.t_junctions[0].vertex, 4u);
    EXPECT_EQ(d.t_junctions[0].edge, (MeshDefects::Edge{0, 3}));
    EXPECT_EQ(find_defects(mesh, 1e-9).t_junctions.size(), 0u);
    EXPECT_EQ(find_defects(grid(3), 1e-3).t_junctions.size(), 0u);
}
TEST(MeshDefects, DuplicateDegenerateUnusedAndEqual) {
    TriangleMesh mesh = grid(1);
    mesh.points.push_back({0, 0, 0});    // equal to the first, used by nothing
    mesh.points.push_back({0.5, 0, 0});  // between 0 and 2
    mesh.triangles.push_back({mesh.triangles[0][1], mesh.triangles[0][2], mesh.triangles[0][0]});
    mesh.triangles.push_back({0, 0, 1});
    mesh.triangles.push_back({0, 5, 2});
    const MeshDefects d = find_defects(mesh, 1e-9);
    EXPECT_EQ(d.duplicate_triangles, 1u);
    EXPECT_EQ(d.degenerate_triangles, 2u);
    EXPECT_EQ(d.unused_vertices, 1u);
    EXPECT_EQ(d.equal_vertices, 1u);
}
TEST(MeshDefects, EdgesOfThreeTrianglesAndVerticesWhereFansTouch) {
    TriangleMesh book = grid(1);
    book.points.push_back({0, 1, 1});
    book.triangles.push_back({0, 3, 4});
    EXPECT_EQ(find_defects(book, 1e-9).non_manifold_edges, 1u);
    TriangleMesh tie{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
    const MeshDefects d = find_defects(tie, 1e-9);
    EXPECT_EQ(d.non_manifold_vertices, 1u);
    EXPECT_EQ(d.components, 2u);
    EXPECT_EQ(d.boundary_loops, 1u);  // both triangles' sides hang together at the vertex
}
TEST(MeshDefects, ShapesOfARightTriangle) {
    // Sides 3, 4, 5: inradius 1, least angle asin(3/5), aspect 5/(2 sqrt 3).
    const TriangleShapes s = measure_shapes({{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}});
    EXPECT_NEAR(s.least_angle, std::asin(0.6) * 180 / M_PI, 1e-12);
    EXPECT_NEAR(s.most_aspect, 5 / (2 * std::sqrt(3.0)), 1e-14);
}

}  // namespace
}  // namespace isoparm::tests
