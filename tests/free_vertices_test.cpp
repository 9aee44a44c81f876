// Meshes whose vertices leave the surface: fewer triangles, and still no point of either set farther from the other than certified.
#include "tessellation/free_vertices.h"

#include <gtest/gtest.h>

#include <cmath>

#include "certificate.h"
#include "error.h"
#include "samples.h"
#include "shapes.h"
#include "tessellation_options.h"

namespace isoparm::tests {
namespace {

TessellationOptions at(const Composite& surface, double relative, Measure measure = Measure::geometric) { return options_of(surface, relative, measure); }

TEST(FreeVertices, HalveTheTrianglesOfASphereAndStayWithinTheTolerance) {
    const Composite surface{{"S", octant()}};
    const TessellationOptions options = at(surface, 3e-3);
    const Tessellation on = tessellate(surface, options), t = tessellate_free(surface, options);
    EXPECT_LT(t.mesh.triangle_count(), 0.6 * on.mesh.triangle_count());
    EXPECT_LT(t.mesh.triangle_count(), 1.6 * t.surfaces[0].optimal_triangles);
    EXPECT_LE(t.certified_error, t.tolerance);
    EXPECT_EQ(t.tolerance, options.tolerance);
    EXPECT_LE(t.sampled_error, t.certified_error);
    EXPECT_GT(t.sampled_error, 0.8 * t.certified_error);
    EXPECT_EQ(t.topology.t_junctions, 0u);
    double out = 0, in = 0;  // of the mesh's points, from the sphere
    const MeshPart& part = t.mesh.parts[0];
    Random random(5);
    for (const auto& c : part.triangles)
        for (int s = 0; s < 60; ++s) {
            double w[3] = {random.number(), random.number(), s % 2 ? 0 : random.number()};
            if (s < 3) w[0] = s == 0, w[1] = s == 1, w[2] = s == 2;
            Point x;
            for (int k = 0; k < 3; ++k) x += w[k] / (w[0] + w[1] + w[2]) * t.mesh.positions[part.vertex[c[k]]];
            out = std::max(out, length(x) - 1), in = std::max(in, 1 - length(x));
        }
    EXPECT_LE(std::max(out, in), t.certified_error);
    EXPECT_GT(out, 0.5 * t.certified_error);  // both sides are used
    EXPECT_GT(in, 0.5 * t.certified_error);
    for (int s = 0; s < 300; ++s) {  // of the sphere's points, from the mesh
        const Vec2 p = random_parameter(random, surface[0].patch);
        const Point q = surface[0].patch.point(p.x, p.y);
        double least = HUGE_VAL;
        for (const auto& c : part.triangles) least = std::min(least, distance_to_triangle(q, t.mesh.positions[part.vertex[c[0]]], t.mesh.positions[part.vertex[c[1]]], t.mesh.positions[part.vertex[c[2]]]));
        EXPECT_LE(least, t.certified_error);
    }
}

TEST(FreeVertices, NeverNeedMoreTrianglesAndAlwaysHaveACertificate) {
    for (const char* name : {"coons", "ruled", "bezier_triangle", "cone", "bspline"})
        for (const PatchType& type : patch_types()) {
            if (std::string(name) != type.name) continue;
            for (const Measure measure : {Measure::geometric, Measure::parametric}) {
                Random random(4000);
                const Composite surface{{"S", type.make(random).patch}};
                TessellationOptions options = at(surface, 0.02, measure);
                options.bounds = true;
                const Tessellation on = tessellate(surface, options), t = tessellate_free(surface, options);
                EXPECT_LE(t.mesh.triangle_count(), on.mesh.triangle_count()) << name;
                EXPECT_LE(t.certified_error, options.tolerance) << name;
                Certificate c = make_certificate(surface, t, measure == Measure::geometric);
                EXPECT_TRUE(check_certificate(surface, c).proved()) << name;
                for (Point& p : c.points) p.z += 1.5 * options.tolerance;  // too far
                EXPECT_FALSE(check_certificate(surface, c).proved()) << name;
            }
        }
}

TEST(FreeVertices, FarFromTheOriginTheyEndAsSoon) {
    // Claims that leave no room for rounding were sought for ever there.
    Random random(31);
    for (const double away : {0.0, 1e6, 1e9}) {
        std::vector<std::vector<Point>> net(4, std::vector<Point>(4));
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) net[i][j] = Point{away + i, away + j, away + 2 * random.number()};
        const Composite surface{{"S", make_bezier_patch(net)}};
        const TessellationOptions options = at(surface, 1e-3);
        const Tessellation on = tessellate(surface, options), t = tessellate_free(surface, options);
        EXPECT_LE(t.certified_error, options.tolerance) << away;
        EXPECT_LE(t.mesh.triangle_count(), on.mesh.triangle_count()) << away;
        EXPECT_LT(t.seconds_tessellate, 60) << away;
    }
}
TEST(FreeVertices, SharedEdgesStayShared) {
    const Composite surface = sphere();
    const Tessellation t = tessellate_free(surface, at(surface, 1e-2));
    EXPECT_EQ(t.topology.boundary_edges, 0u);
    EXPECT_EQ(t.topology.non_manifold_edges, 0u);
    for (const Point& p : t.mesh.positions) EXPECT_NEAR(length(p), 1, t.certified_error);
    TessellationOptions normals = at(surface, 1e-2);
    normals.normal_deviation = 5;
    EXPECT_THROW(tessellate_free(surface, normals), Error);
}

}  // namespace
}  // namespace isoparm::tests
