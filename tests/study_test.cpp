// The methods of a study: every mesh is watertight and certified by the same rule, grids and quadtrees are what they say, slopes are fitted
// exactly.
#include "study.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "composite.h"
#include "curves/line.h"
#include "error.h"
#include "meshes/leaf_mesh.h"
#include "meshes/mesh_error.h"
#include "patches/tensor_bezier.h"
#include "run_program.h"
#include "scene/scene.h"
#include "study/study_methods.h"
#include "tessellate.h"

namespace isoparm {
namespace {

Composite patches_of(const std::string& scene, const std::string& surface) {
    return load_scene(test::source_folder() + "/scenes/" + scene + ".json").find_surface(surface)->patches;
}
Composite first_of(const std::string& scene) {
    return load_scene(test::source_folder() + "/scenes/" + scene + ".json").surfaces.front().patches;
}

/// Two cubic sheets that share an edge; the second one runs along it at another speed, so that parameters differ.
Composite two_sheets(double shift) {
    const auto point = [](double x, double y) { return Point{x, y, 0.3 * x * y - 0.2 * x * x + 0.4 * y * y}; };
    Grid<Point> left(2), right(2);
    for (const double y : {0.0, 0.5, 1.0}) left[0].push_back(point(0, y)), left[1].push_back(point(1, y));
    // The edge of the left one is a parabola with control points at y = 0, 1/2, 1; degree 2 has one reparametrisation only, so the right
    // one is rational.
    const Grid<Point> edge_right = {left[1], {point(2, 0), point(2, 0.5), point(2, 1)}};
    Grid<double> weights = {{1, 1 + shift, (1 + shift) * (1 + shift)}, {1, 1 + shift, (1 + shift) * (1 + shift)}};
    if (shift == 0) return {{"left", make_bezier_patch(left)}, {"right", make_bezier_patch(edge_right)}};
    return {{"left", make_bezier_patch(left)}, {"right", make_bezier_patch(edge_right, weights)}};
}

struct Sample {
    std::string name;
    Composite surface;
};
std::vector<Sample> samples() {
    return {{"teapot", first_of("teapot")},
            {"sphere", patches_of("sphere", "sphere")},
            {"side-vertex", first_of("side_vertex")},
            {"coons", first_of("coons")},
            {"two sheets", two_sheets(0)},
            {"two sheets, other speed", two_sheets(1)}};
}

// ---- laws of every method

TEST(Study, EveryMethodProvesItsToleranceAndSeesNoLargerError) {
    for (const Sample& s : samples())
        for (const StudyMethod& m : study_methods()) {
            SCOPED_TRACE(s.name + ", " + m.name);
            const double tolerance = 1e-2 * bounding_box(s.surface).diagonal();
            const StudyResult result = run_study(m, {s.surface, tolerance});
            const StudyRun& r = result.run;
            ASSERT_TRUE(r.reached) << r.reason;
            EXPECT_LE(r.certified_error, tolerance);
            EXPECT_LE(r.sampled_error, r.certified_error);
            EXPECT_GT(r.sampled_error, 0);
            EXPECT_GE(r.certified_parametric, r.sampled_error);
            EXPECT_GT(r.triangles, r.optimal);
            EXPECT_GT(r.angles.median, r.angles.least);
            ASSERT_EQ(result.certified.size(), result.mesh.parts.size());
            for (std::size_t p = 0; p < result.mesh.parts.size(); ++p) {
                ASSERT_EQ(result.certified[p].size(), result.mesh.parts[p].triangles.size() + result.mesh.parts[p].left_out.size());
                for (std::size_t i = 0; i < result.certified[p].size(); ++i)
                    ASSERT_LE(result.sampled[p][i], result.certified[p][i]) << p << " " << i;
            }
        }
}

TEST(Study, EveryMethodIsWatertightAlikeInsideAndAcrossSharedEdges) {
    for (const Sample& s : samples()) {
        std::map<std::string, std::size_t> loops;
        for (const StudyMethod& m : study_methods()) {
            SCOPED_TRACE(s.name + ", " + m.name);
            const StudyMesh made = m.make({s.surface, 1e-2 * bounding_box(s.surface).diagonal()});
            EXPECT_EQ(made.topology.t_junctions, 0u);
            EXPECT_EQ(made.topology.non_manifold_edges, 0u);
            EXPECT_EQ(made.topology.degenerate_triangles, 0u);
            loops[m.name] = made.topology.boundary_loops;
        }
        for (const auto& [name, n] : loops) EXPECT_EQ(n, loops["fast"]) << s.name << ", " << name;
    }
}

TEST(Study, TheOptimumIsThatOfTessellate) {
    const Composite surface = first_of("coons");
    const StudyRun r = run_study(*find_study_method("uniform"), {surface, 0.01}).run;
    EXPECT_EQ(r.optimal, tessellate(surface, {.tolerance = 0.01, .measure = Measure::parametric, .max_triangles = 1000000, .progress = {}}).surfaces.at(0).optimal_triangles);
    EXPECT_DOUBLE_EQ(r.ratio(), double(r.triangles) / r.optimal);
}

TEST(Study, FastIsTessellate) {
    const Composite surface = first_of("coons");
    const StudyResult r = run_study(*find_study_method("fast"), {surface, 0.01});
    const Tessellation t = tessellate(surface, {.tolerance = 0.01, .measure = Measure::geometric, .max_triangles = 1000000, .progress = {}});
    EXPECT_EQ(r.run.triangles, t.mesh.triangle_count());
    EXPECT_EQ(r.mesh.positions, t.mesh.positions);
    EXPECT_LE(r.run.certified_error, t.certified_error);
}

TEST(Study, ABudgetIsRecordedNotThrown) {
    const Composite surface = first_of("coons");
    for (const StudyMethod& m : study_methods()) {
        StudyInput input{surface, 1e-9};
        input.max_triangles = 2000;
        const StudyRun r = run_study(m, input).run;
        EXPECT_FALSE(r.reached) << m.name;
        EXPECT_NE(r.reason.find("was not reached"), std::string::npos) << m.name << ": " << r.reason;
        EXPECT_EQ(r.triangles, 0u);
    }
}

// ---- the certificate

TEST(MeshError, AMovedVertexIsCharged) {
    const Composite surface = first_of("coons");
    Mesh mesh = run_study(*find_study_method("uniform"), {surface, 0.02}).mesh;
    const double before = MeshProver(surface)(mesh, 0.02)->geometric;
    EXPECT_LE(before, 0.02);
    mesh.positions[mesh.parts[0].vertex[mesh.parts[0].triangles[17][1]]].z += 0.05;
    const auto after = MeshProver(surface)(mesh, 0.02);
    EXPECT_GE(after->geometric, 0.05 - before);
    EXPECT_FALSE(MeshProver(surface)(mesh, 0.02, true).has_value());
}

TEST(MeshError, ATriangleAcrossABreakHasNoBound) {
    Grid<Point> points(3);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) points[i].push_back(Point{double(i), double(j), double(i == 1 && j == 1)});
    const Composite surface = {{"roof", make_bspline_patch(1, 1, {0, 0, 0.5, 1, 1}, {0, 0, 0.5, 1, 1}, points)}};
    Mesh mesh;
    MeshPart part;
    part.uv = {{0, 0}, {1, 0}, {0, 1}};
    part.vertex = {0, 1, 2};
    part.triangles = {{0, 1, 2}};
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    mesh.parts = {part};
    EXPECT_TRUE(std::isinf(MeshProver(surface)(mesh, 10)->geometric));
}

TEST(MeshError, ASegmentLeftOutThatIsNoEdgeHasNoBound) {
    // A lune: its two short sides are points, so one cell gives nothing but a segment.
    const Composite surface = {{"lune", make_bezier_patch({{{0, 0, 0}, {0, 0, 0}}, {{1, -1, 0}, {1, 1, 0}}, {{2, 0, 0}, {2, 0, 0}}})}};
    const StudyMesh made = make_uniform({surface, 100});
    EXPECT_GT(made.mesh.triangle_count(), 0u) << "a mesh without triangles was certified";
}

// ---- grids and quadtrees

TEST(UniformGrid, HasTheSameVerticesOnEveryPatchAndTheSmallestN) {
    const Composite surface = two_sheets(0);
    const double tolerance = 1e-3;
    const StudyMesh made = make_uniform({surface, tolerance});
    const double n = std::sqrt(double(made.mesh.triangle_count()) / 4);
    EXPECT_EQ(n, std::floor(n));
    for (const MeshPart& part : made.mesh.parts)
        for (const Vec2& p : part.uv) {
            EXPECT_NEAR(p.x * n, std::round(p.x * n), 1e-9);
            EXPECT_NEAR(p.y * n, std::round(p.y * n), 1e-9);
        }
    const Topology topology = find_topology(surface, 1e-7);
    EXPECT_FALSE(MeshProver(surface)(made.mesh, 0.5 * made.certified_error, true).has_value());
    EXPECT_TRUE(MeshProver(surface)(made.mesh, tolerance, true).has_value());
}

TEST(UniformGrid, OfATriangularPatchHasNSquaredTriangles) {
    const StudyMesh made = make_uniform({first_of("side_vertex"), 0.05});
    const double n = std::sqrt(double(made.mesh.triangle_count()));
    EXPECT_EQ(n, std::floor(n));
    EXPECT_EQ(made.mesh.positions.size(), std::size_t((n + 1) * (n + 2) / 2));
}

/// The longest edge of each triangle in the domain, as a power of a half of it.
double level_of(const MeshPart& part, std::size_t t) {
    const auto& c = part.triangles[t];
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
        const Vec2 &a = part.uv[c[k]], &b = part.uv[c[(k + 1) % 3]];
        longest = std::max({longest, std::fabs(a.x - b.x), std::fabs(a.y - b.y)});
    }
    return -std::log2(longest);
}

TEST(Quadtree, IsRestrictedInsidePatchesAndAcrossTheEdgesTheyShare) {
    // The left sheet is flat but for its far corner, the right one bends throughout: leaves differ.
    const Grid<Point> left = {{{0, 0, 2}, {0, 1, 0}, {0, 2, 0}}, {{1, 0, 0}, {1, 1, 0}, {1, 2, 0}}, {{2, 0, 0}, {2, 1, 0}, {2, 2, 0}}};
    const Grid<Point> right = {{{2, 0, 0}, {2, 1, 0}, {2, 2, 0}}, {{3, 0, 1}, {3, 1, -3}, {3, 2, 4}}, {{4, 0, 0}, {4, 1, 0}, {4, 2, 0}}};
    const Composite surface = {{"left", make_bezier_patch(left)}, {"right", make_bezier_patch(right)}};
    const StudyMesh made = make_quadtree({surface, 2e-3});
    EXPECT_EQ(made.topology.t_junctions, 0u);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<double>> levels;  // of the triangles beside each mesh edge
    double coarsest = 1e9, finest = 0;
    for (const MeshPart& part : made.mesh.parts)
        for (std::size_t t = 0; t < part.triangles.size(); ++t) {
            const double level = level_of(part, t);
            EXPECT_EQ(level, std::round(level)) << "a leaf is no half of a half";
            coarsest = std::min(coarsest, level), finest = std::max(finest, level);
            for (int k = 0; k < 3; ++k) {
                const auto a = part.vertex[part.triangles[t][k]], b = part.vertex[part.triangles[t][(k + 1) % 3]];
                levels[{std::min(a, b), std::max(a, b)}].push_back(level);
            }
        }
    EXPECT_GE(finest - coarsest, 2) << "all leaves are alike: nothing was tested";
    for (const auto& [edge, beside] : levels) {
        if (beside.size() == 2) {
            EXPECT_LE(std::fabs(beside[0] - beside[1]), 1);
        }
    }
}

TEST(LeafMesh, AHangingVertexOfOnePatchIsAVertexOfTheOther) {
    const Composite surface = two_sheets(0);
    const Topology topology = find_topology(surface, 1e-9);
    std::vector<Leaves> leaves = {Leaves(surface[0].patch, 1), Leaves(surface[1].patch, 4)};
    Leaves& fine = leaves[1];
    fine.list.clear();
    for (std::uint32_t i = 0; i < 4; ++i)
        for (std::uint32_t j = 0; j < 4; ++j) fine.list.push_back({{LatticePoint{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}, 4});
    const LeafMesh made = mesh_of(surface, topology, leaves);
    const MeshTopology t = analyse(made.mesh, made.open_edges);
    EXPECT_EQ(t.t_junctions, 0u);
    EXPECT_EQ(t.boundary_loops, 1u);
    EXPECT_EQ(made.mesh.parts[0].triangles.size(), 7u) << "a rectangle with three further vertices, from its middle";
    EXPECT_EQ(made.mesh.parts[1].triangles.size(), 32u);
    ASSERT_EQ(made.leaf[1].size(), 32u);
    EXPECT_EQ(made.leaf[1].back(), 15u);
}

// ---- numbers

TEST(StudyNumbers, AnOrderIsFittedExactly) {
    std::vector<double> n, e;
    for (const double h : {0.5, 0.25, 0.125, 0.03125}) n.push_back(2 / (h * h)), e.push_back(7 * h * h);
    const auto second = fit_order(n, e);
    ASSERT_TRUE(second);
    EXPECT_NEAR(second->order, 2, 1e-12);
    EXPECT_EQ(second->points, 4u);
    for (double& x : e) x = std::pow(x, 1.5);
    EXPECT_NEAR(fit_order(n, e)->order, 3, 1e-12);
    e[1] = 0;  // not positive: left out
    EXPECT_EQ(fit_order(n, e)->points, 3u);
    EXPECT_FALSE(fit_order({10}, {1}));
    EXPECT_FALSE(fit_order({10, 10}, {1, 2}));
    // Least squares, not end points: residuals that are symmetric cancel.
    EXPECT_NEAR(fit_order({1, 2, 4, 8}, {1 * 1.1, 0.5 / 1.1, 0.25 / 1.1, 0.125 * 1.1})->order, 2, 1e-12);
}

TEST(StudyNumbers, AnglesOfAnEquilateralAndARightTriangle) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}, {0, 1, 0}};
    MeshPart part;
    part.uv.resize(4);
    part.vertex = {0, 1, 2, 3};
    part.triangles = {{0, 1, 2}, {0, 1, 3}};
    mesh.parts = {part};
    const AngleQuantiles a = smallest_angles(mesh);
    EXPECT_NEAR(a.least, 45, 1e-12);
    part.triangles = {{0, 1, 2}};
    mesh.parts = {part};
    EXPECT_NEAR(smallest_angles(mesh).median, 60, 1e-12);
}

TEST(StudyNumbers, DefaultTolerancesAreHalfDecadesOfTheDiagonal) {
    const auto t = default_tolerances(2);
    ASSERT_EQ(t.size(), 8u);
    EXPECT_NEAR(t.front(), 2 * std::pow(10, -1.5), 1e-15);
    EXPECT_NEAR(t.back(), 2e-5, 1e-19);
}

}  // namespace
}  // namespace isoparm
