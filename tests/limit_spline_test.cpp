// A bicubic patch is the Catmull-Clark limit of its own control points; other smooth patches are so to fourth order.
#include "subdivision/limit_spline.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "commands/command.h"
#include "curves/bezier.h"
#include "error.h"
#include "limit.h"
#include "patches/tensor_bezier.h"
#include "patches/three_curves.h"
#include "scene/json.h"

namespace isoparm {
namespace {

/// A Bezier patch of degree n each way over the unit square with bumps.
Patch bumps(int n) {
    Grid<Point> grid(n + 1);
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) grid[i].emplace_back(double(i) / n, double(j) / n, 0.4 * ((i * 7 + j * 5 + i * j) % 4));
    return make_bezier_patch(grid);
}

TEST(LimitSpline, BicubicPatchesAreLimitsOfTheirControlPoints) {
    const SplineReport r = compare_with_spline({"S", bumps(3)});
    ASSERT_EQ(r.levels.size(), 5u);
    for (const SplineLevel& l : r.levels) {
        EXPECT_LT(l.deviation, 1e-14) << l.m;
        EXPECT_LT(*l.normal_degrees, 1e-11) << l.m;
        EXPECT_FALSE(l.ratio);  // rounding has none
    }
    // The corner of the first cell: (1 4 1)/6 each way of nine control points.
    const Cage c = interpolating_cage(bumps(3), 2, 3);
    EXPECT_EQ(c.positions.size(), 30u);
    EXPECT_EQ(c.faces.size(), 20u);
    EXPECT_LT(distance(LimitSurface(c, Scheme::catmull_clark)(4 + 1, 0, 0).p, Point(0, 0, 0)), 1e-15);
}

TEST(LimitSpline, SmoothPatchesAreApproximatedToFourthOrder) {
    const SplineReport r = compare_with_spline({"S", bumps(4)});
    ASSERT_TRUE(r.levels.back().ratio);
    EXPECT_NEAR(*r.levels.back().ratio, 16, 1.5);
    EXPECT_LT(*r.levels.back().normal_degrees, 1e-2);
}

// A second derivative that jumps inside a cell, at every halving: nothing of the fourth order is left.
TEST(LimitSpline, PatchesThatAreNotSmoothAreNot) {
    const Patch kinked = make_bspline_patch(2, 2, {0, 0, 0, 1, 3, 3, 3}, {0, 0, 0, 1, 1, 1},
                                           {{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, {{1, 0, 1}, {1, 1, 1}, {1, 2, 0}}, {{2, 0, -1}, {2, 1, 2}, {2, 2, 0}}, {{3, 0, 0}, {3, 1, 0}, {3, 2, 1}}});
    const SplineReport r = compare_with_spline({"S", kinked});  // its break, at a third, is never at a corner of cells
    ASSERT_TRUE(r.levels.back().ratio);
    EXPECT_LT(*r.levels.back().ratio, 6);
}

TEST(LimitSpline, TrianglesHaveNoGrid) {
    const Curve a = make_bezier({{1, 0, 0}, {0, 1, 0}}), b = make_bezier({{0, 1, 0}, {0, 0, 0}}), c = make_bezier({{0, 0, 0}, {1, 0, 0}});
    const SplineReport r = compare_with_spline({"T", make_three_curves({a, b, c})});
    EXPECT_TRUE(r.levels.empty());
    EXPECT_NE(r.refused.find("on a triangle"), std::string::npos);
}

TEST(LimitSpline, RefusesSizesThatCannotBeMeasured) {
    for (const double size : {0.0, 1e-200, 1e160}) {
        const SplineReport r = compare_with_spline({"S", make_bezier_patch({{{0, 0, 0}, {0, size, 0}}, {{size, 0, 0}, {size, size, 0.5 * size}}})});
        EXPECT_TRUE(r.levels.empty()) << size;
        EXPECT_NE(r.refused.find("expected one between 1e-70 and 1e70"), std::string::npos) << r.refused;
    }
}

TEST(LimitSpline, TheCommandRefusesWhatIsForCages) {
    const std::string scene = std::string(ISOPARM_SOURCE_DIR) + "/scenes/coons.json";
    for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{"--levels", "3"}, {"--samples", "9"}, {"--scheme", "nonsense"}}) {
        std::vector<std::string> arguments{"--scene", scene, "--surface", "S"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        try {
            limit_command.run(arguments);
            ADD_FAILURE() << "accepted " << more[0];
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::usage);
            EXPECT_NE(std::string(e.what()).find(more[0] + " beside --scene"), std::string::npos) << e.what();
        }
    }
}

TEST(LimitSpline, TheCommandComparesScenes) {
    const std::string scene = std::string(ISOPARM_SOURCE_DIR) + "/scenes/coons.json", folder = testing::TempDir() + "isoparm_limit_spline";
    testing::internal::CaptureStdout();
    EXPECT_EQ(limit_command.run({"--scene", scene, "--surface", "S", "--json", "-o", folder}), kSuccess);
    const Json j = Json::parse(testing::internal::GetCapturedStdout(), "out");
    EXPECT_LT(j.at("patches", "")[0].at("levels", "")[4].at("deviation", "").number(), 1e-14);
    testing::internal::CaptureStdout();
    EXPECT_EQ(limit_command.run({folder + "/cage-0.obj", "--samples", "3"}), kSuccess);
    EXPECT_NE(testing::internal::GetCapturedStdout().find("324 faces: 256 regular"), std::string::npos);
    std::filesystem::remove_all(folder);
    for (const std::vector<std::string>& bad : std::vector<std::vector<std::string>>{{"--scene", scene}, {"--scene", scene, "--surface", "nobody"}, {"x.obj", "--scene", scene, "--surface", "S"}})
        EXPECT_THROW(limit_command.run(bad), Error);
}

}  // namespace
}  // namespace isoparm
