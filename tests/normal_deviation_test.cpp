// The angle between each triangle and the surface's normals over it: no normal at a random point deviates by more than proved.
#include <gtest/gtest.h>

#include <cmath>

#include "bounds/bound_cell.h"
#include "error.h"
#include "patches/tensor_bezier.h"
#include "samples.h"
#include "tessellation_options.h"

namespace isoparm::tests {
namespace {

Tessellation mesh_of(const Patch& patch, double relative, double degrees) {
    const Composite surface{{"S", patch}};
    TessellationOptions options = options_of(surface, relative, Measure::geometric);
    options.normal_deviation = degrees;
    return tessellate(surface, options);
}

Vec2 inside(const std::array<Vec2, 3>& p, Random& random) {
    double a = random.number(), b = random.number();
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const auto mix = [&](double x, double y, double z) { return x + a * (y - x) + b * (z - x); };
    return {mix(p[0].x, p[1].x, p[2].x), mix(p[0].y, p[1].y, p[2].y)};
}

/// The largest tangent seen over what is proved, for random small triangles of a patch: above 1 is a violation.
double worst_ratio(const Patch& patch, Random& random, int triangles, int& bounded) {
    const Rect r = patch.rect();
    const auto us = patch.breaks_u(), vs = patch.breaks_v();
    const double u1 = us.empty() ? r.u1 : us.front(), v1 = vs.empty() ? r.v1 : vs.front();
    const BoundCell whole(patch, {{r.u0, u1}, {r.v0, v1}});
    double worst = 0;
    for (int i = 0; i < triangles; ++i) {
        const double size = std::pow(2.0, -random.number(1, 9)), place = patch.domain() == Domain::triangle ? 0.5 : 1;
        const double u = r.u0 + (u1 - r.u0) * random.number(0, place * (1 - size)), v = r.v0 + (v1 - r.v0) * random.number(0, place * (1 - size));
        CornerData data;
        for (Vec2& q : data.uv) q = {u + place * size * random.number() * (u1 - r.u0), v + place * size * random.number() * (v1 - r.v0)};
        const Vec2 &a = data.uv[0], &b = data.uv[1], &c = data.uv[2];
        if ((b.x - a.x) * (c.y - a.y) < (b.y - a.y) * (c.x - a.x)) std::swap(data.uv[1], data.uv[2]);
        for (int k = 0; k < 3; ++k) data.points[k] = patch.point(data.uv[k].x, data.uv[k].y);
        data.slack = 1e-14;
        const BoundCell* cell = &whole;
        const TriangleBound proof = BoundCell::bound(patch, cell, data, 0, Measure::geometric);
        if (!std::isfinite(proof.turn)) continue;
        ++bounded;
        for (int s = 0; s < 8; ++s) {
            const Vec2 p = inside(data.uv, random);
            const PointFrame f = patch.frame(p.x, p.y);
            const auto d = [&](int i, int j) { return Point{f.x.coefficient(i, j), f.y.coefficient(i, j), f.z.coefficient(i, j)}; };
            const Point n = cross(d(1, 0), d(0, 1));
            const double along = dot(n, proof.unit), seen = along > 0 ? length(cross(n, proof.unit)) / along : HUGE_VAL;
            worst = std::max(worst, seen / (proof.turn + 1e-9));
        }
    }
    return worst;
}

class NormalDeviation : public testing::TestWithParam<PatchType> {};

TEST_P(NormalDeviation, NoNormalTurnsFartherThanProved) {
    Random random(4);
    int bounded = 0;
    for (int i = 0; i < 3; ++i) ASSERT_LE(worst_ratio(GetParam().make(random).patch, random, 40, bounded), 1);
    EXPECT_GT(bounded, 0);
}

INSTANTIATE_TEST_SUITE_P(EveryType, NormalDeviation, testing::ValuesIn(patch_types()), name_of);

// A paraboloid turns by the same everywhere, and the tangent of its normal is linear: what is proved of small triangles is nearly what is true.
TEST(NormalDeviationOfATriangle, IsNearlyAttained) {
    const Patch patch = make_bezier_patch({{{0, 0, 1}, {0, 0.5, 0}, {0, 1, 1}}, {{0.5, 0, 0}, {0.5, 0.5, -1}, {0.5, 1, 0}}, {{1, 0, 1}, {1, 0.5, 0}, {1, 1, 1}}});
    Random random(5);
    int bounded = 0;
    const double ratio = worst_ratio(patch, random, 4000, bounded);
    EXPECT_LE(ratio, 1);
    EXPECT_GT(ratio, 0.4);
    EXPECT_GT(bounded, 2000);
}

TEST(NormalDeviationOfAMesh, IsKeptAndReported) {
    Random random(6);
    const Patch patch = make_bezier_patch({{{0, 0, 0}, {0, 1, 0.5}, {0, 2, 0}}, {{1, 0, 0.5}, {1, 1, 1}, {1, 2, 0.2}}, {{2, 0, 0}, {2, 1, 0.3}, {2, 2, 0}}});
    const Tessellation coarse = mesh_of(patch, 1e-2, 0), fine = mesh_of(patch, 1e-2, 3);
    EXPECT_GT(coarse.normal_deviation, 3);
    EXPECT_LE(fine.normal_deviation, 3);
    EXPECT_GT(fine.normal_deviation, 1);
    EXPECT_EQ(fine.normals_unproved, 0u);
    EXPECT_GT(fine.mesh.triangle_count(), coarse.mesh.triangle_count());
    EXPECT_LE(fine.certified_error, fine.tolerance);
}

// At a pole nothing is proved about normals: such triangles are few, smaller than the tolerance, and counted.
TEST(NormalDeviationOfAMesh, GivesUpAtSingularPointsAndSaysSo) {
    const Patch pole = make_bezier_patch({{{0, 0, 1}, {1, 0, 1}, {1, 0, 0}}, {{0, 0, 1}, {1, 1, 1}, {1, 1, 0}}, {{0, 0, 1}, {0, 1, 1}, {0, 1, 0}}});
    const Tessellation t = mesh_of(pole, 1e-3, 5);
    EXPECT_LE(t.normal_deviation, 5);
    EXPECT_GT(t.normals_unproved, 0u);
    EXPECT_LT(t.normals_unproved, t.mesh.triangle_count() / 10);
    EXPECT_EQ(t.topology.t_junctions, 0u);
}

TEST(NormalDeviationOfAMesh, RefusesWhatIsNoAngle) {
    Random random(7);
    const Patch patch = patch_types().front().make(random).patch;
    EXPECT_THROW(mesh_of(patch, 1e-2, 90), Error);
    EXPECT_THROW(mesh_of(patch, 1e-2, -1), Error);
    TessellationOptions options;
    options.tolerance = 0.1, options.measure = Measure::geometric, options.normal_deviation = 5, options.quality = Quality::optimal;
    EXPECT_THROW(tessellate({{"S", patch}}, options), Error);
}

}  // namespace
}  // namespace isoparm::tests
