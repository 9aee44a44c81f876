// Figures of smoothness: colours say the curvature, stripes follow the mirror, combs stand for curvature, and the bar says the numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drawing/comb.h"
#include "picture/color_map.h"
#include "picture/curvature_map.h"
#include "curves/arc.h"
#include "curves/bspline.h"
#include "curves/line.h"
#include "error.h"
#include "drawing/jump_heat.h"
#include "drawing/legend.h"
#include "patches/tensor_bezier.h"
#include "picture/picture.h"
#include "drawing/twist_arrows.h"
#include "run_program.h"

namespace isoparm::test {
namespace {

using What = ColorBy::What;

/// z = (a x^2 + b y^2) / 2 over [-1,1]^2: at the middle k = a, b along x and y, toward the normal, which is up.
Patch paraboloid(double a, double b) {
    const auto z = [&](int i, int j) { return 0.5 * (i == 1 ? -a : a) + 0.5 * (j == 1 ? -b : b); };  // Bezier: x^2 has -1 in the middle
    Grid<Point> p(3, std::vector<Point>(3));
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) p[i][j] = {i - 1.0, j - 1.0, z(i, j)};
    return make_bezier_patch(p);
}
double lightness(const Color& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

TEST(CurvatureMap, CurvaturesAreThoseOfAParaboloid) {
    const Patch p = paraboloid(3, -0.5);
    const Vec2 middle{0.5, 0.5};
    EXPECT_NEAR(curvature_of(p, middle, What::gaussian, false), -1.5, 1e-13);
    EXPECT_NEAR(curvature_of(p, middle, What::mean, false), 1.25, 1e-13);
    EXPECT_NEAR(curvature_of(p, middle, What::k1, false), 3, 1e-13);
    EXPECT_NEAR(curvature_of(p, middle, What::k2, false), -0.5, 1e-13);
    EXPECT_NEAR(curvature_of(p, middle, What::gaussian, true), -1.5, 1e-13) << "the same from both sides";
    EXPECT_NEAR(curvature_of(p, middle, What::k1, true), 0.5, 1e-13) << "seen from below";
    EXPECT_NEAR(curvature_of(p, middle, What::k2, true), -3, 1e-13);
}
TEST(CurvatureMap, DivergingColoursAreEvenAndBalanced) {
    for (int k = 0; k < 50; ++k) {
        const double x = k / 50.0, y = (k + 1) / 50.0;
        const double orange = std::cbrt(lightness(diverging(x))) - std::cbrt(lightness(diverging(y))), blue = std::cbrt(lightness(diverging(-x))) - std::cbrt(lightness(diverging(-y)));
        EXPECT_GT(orange, 0.002) << "darker outward at " << x;
        EXPECT_GT(blue, 0.002) << x;
        EXPECT_NEAR(std::cbrt(lightness(diverging(y))), std::cbrt(lightness(diverging(-y))), 0.05) << "sides of one lightness at " << y;
    }
    EXPECT_GT(diverging(0.8).x, diverging(0.8).z) << "orange above";
    EXPECT_LT(diverging(-0.8).x, diverging(-0.8).z) << "blue below";
    EXPECT_EQ(diverging(7), diverging(1));
}
TEST(CurvatureMap, RangesAreRoundAndCoverNearlyAll) {
    ColorBy by;
    by.what = What::gaussian;
    const ColorScale saddle = settled(by, {{"S", paraboloid(2, -2)}}, {});
    EXPECT_EQ(saddle.low, -4);  // -4 at the middle, nearer to 0 elsewhere
    EXPECT_EQ(saddle.high, 4);
    EXPECT_FALSE(saddle.below || saddle.above);
    by.what = What::k1;
    const ColorScale bowl = settled(by, {{"S", paraboloid(1, 1)}}, {});
    EXPECT_EQ(bowl.low, 0);
    EXPECT_EQ(bowl.high, 1);
    EXPECT_EQ(bowl.color(0.25), viridis(0.25));
    by.range = {{-0.5, 0.25}};
    const ColorScale given = settled(by, {{"S", paraboloid(1, 1)}}, {});
    EXPECT_TRUE(given.above && !given.below);
    EXPECT_EQ(given.color(0.25), diverging(0.5)) << "both sides to one scale";
    by.range.reset();
    const ColorScale flat = settled(by, {{"S", paraboloid(0, 0)}}, {});
    EXPECT_LT(flat.low, flat.high);
}
TEST(CurvatureMap, ALegendHasItsNumbersAndFitsItsRoom) {
    ColorScale s;
    s.by.what = What::mean;
    s.low = -4e-5, s.high = 4e-5, s.above = true;
    const Drawing d = legends({s}, 800, 600, 20);
    std::string texts;
    for (const DrawingItem& item : d) {
        if (const auto* t = std::get_if<Text>(&item.shape)) {
            for (const TextRun& run : t->text) texts += run.text;
            texts += "|";
        }
        if (const auto* f = std::get_if<Filled>(&item.shape)) {
            for (const Vec2& p : f->outline) EXPECT_TRUE(p.x > 800 - legend_width(20) && p.x < 800 && p.y > 0 && p.y < 600);
        }
    }
    for (const char* part : {"|2|", "4|", "\xE2\x88\x92" "4|", "mean curvature", "5"}) EXPECT_NE(texts.find(part), std::string::npos) << part << " in " << texts;
}
TEST(CurvatureMap, StripesAreTheAnglesOfMirroredRays) {
    ColorBy by;
    by.what = What::isophotes;
    by.stripes = 36;  // pairs: dark for the first 5 degrees of every 10
    by.direction = Point(0, 0, 2);
    Camera camera;
    camera.right = {1, 0, 0}, camera.up = {0, 0, 1}, camera.forward = {0, 1, 0};
    for (int degree = 1; degree < 180; degree += 3) {
        const double a = (degree + 0.5) * std::numbers::pi / 180;
        EXPECT_EQ(in_dark_stripe(by, {std::sin(a), 0, std::cos(a)}, camera.forward, camera), degree % 10 < 5) << degree;
        // A mirror turned by half an angle turns the ray by the whole; the lamps run along `right`.
        ColorBy mirror = by;
        mirror.what = What::reflection;
        mirror.direction.reset();
        const auto dark = [&](double turn) { return in_dark_stripe(mirror, {0, -std::cos(turn / 2), std::sin(turn / 2)}, camera.forward, camera); };
        EXPECT_EQ(dark(a), dark(a + 2 * std::numbers::pi / 36));
        EXPECT_NE(dark(a), dark(a + std::numbers::pi / 36));
    }
}
TEST(Comb, TeethAreAsLongAsTheCurvature) {
    const Curve arc = make_arc({1, 1, 0}, {3, 1, 0}, {1, 3, 0});
    Comb comb;
    comb.teeth = 9, comb.scale = 0.5;
    const auto teeth = comb_teeth(arc, comb, 10);
    ASSERT_EQ(teeth.size(), 9u);
    for (const auto& [foot, tip] : teeth) {
        EXPECT_NEAR(distance(foot, {1, 1, 0}), 2, 1e-13);
        EXPECT_NEAR(distance(tip, {1, 1, 0}), 2.25, 1e-12) << "outward by scale / radius";
    }
    // A break where the curvature jumps from 0 has a tooth of each side; a line has none to be seen.
    const auto kinked = comb_teeth(make_bspline(2, {0, 0, 0, 1, 1, 2, 2, 2}, {{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1.5, 0, 0}, {2, 1, 0}}), comb, 10);
    ASSERT_EQ(kinked.size(), 10u);
    EXPECT_LT(distance(kinked[4][0], kinked[4][1]), 1e-12);
    EXPECT_GT(distance(kinked[5][0], kinked[5][1]), 0.4);
    comb.scale.reset();
    for (const auto& [foot, tip] : comb_teeth(make_line({0, 0, 0}, {1, 2, 3}), comb, 10)) EXPECT_EQ(foot, tip);
    double longest = 0;
    for (const auto& [foot, tip] : comb_teeth(arc, comb, 10)) longest = std::max(longest, distance(foot, tip));
    EXPECT_NEAR(longest, 1.25, 1e-12) << "an eighth of the scene";
}

TEST(JumpHeat, IsTheAngleAndTheCurvatureThatWerePlanted) {
    // A roof of two planes that differ by 30 degrees, run in opposite directions; then a plane that goes on as a parabola of curvature 0.7.
    const double c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
    const Patch left = make_bezier_patch({{{-1, 0, 0}, {-1, 2, 0}}, {{0, 0, 0}, {0, 2, 0}}}), right = make_bezier_patch({{{0, 2, 0}, {0, 0, 0}}, {{c, 2, s}, {c, 0, s}}});
    const Composite roof{{"a", left}, {"b", right}};
    const auto edges = hot_edges(roof, JumpHeat::Of::g1, 3);
    ASSERT_EQ(edges.size(), 1u);
    for (const double x : edges[0].jumps) EXPECT_NEAR(x, 30, 1e-10);
    for (const Point& p : edges[0].points) EXPECT_LT(std::hypot(p.x, p.z), 1e-14);
    JumpHeat heat;
    heat.of = JumpHeat::Of::g1;
    EXPECT_EQ(scale_of(heat, edges, 3).high, 30);
    heat.top = 20;
    EXPECT_TRUE(scale_of(heat, edges, 3).above);
    // What is rounding for its size has no colours of its own, whatever the size.
    for (const double size : {1e-6, 1.0, 1e6}) {
        JumpHeat curvature;
        curvature.of = JumpHeat::Of::g2;
        const std::vector<HotEdge> smooth{{{{0, 0, 0}, {1, 0, 0}}, {1e-8 / size, 0}}}, bent{{{{0, 0, 0}, {1, 0, 0}}, {0.3 / size, 0}}};
        EXPECT_DOUBLE_EQ(scale_of(curvature, smooth, size).high, rounded_up(1 / size));
        EXPECT_NEAR(scale_of(curvature, bent, size).high, 0.3 / size, 1e-9 / size);
    }
    const Patch bend = make_bezier_patch({{{0, 0, 0}, {0, 2, 0}}, {{0.5, 0, 0}, {0.5, 2, 0}}, {{1, 0, 0.35}, {1, 2, 0.35}}});
    const auto bent = hot_edges({{"a", left}, {"b", bend}}, JumpHeat::Of::g2, 3);
    ASSERT_EQ(bent.size(), 1u);
    for (const double x : bent[0].jumps) EXPECT_NEAR(x, 0.7, 1e-12);
    // The same as a line between cells.
    const Patch spline = make_bspline_patch(2, 1, {0, 0, 0, 1, 1, 2, 2, 2}, {0, 0, 1, 1}, {{{-1, 0, 0}, {-1, 2, 0}}, {{-0.5, 0, 0}, {-0.5, 2, 0}}, {{0, 0, 0}, {0, 2, 0}}, {{0.5, 0, 0}, {0.5, 2, 0}}, {{1, 0, 0.35}, {1, 2, 0.35}}});
    const auto line = hot_edges({{"s", spline}}, JumpHeat::Of::g2, 3);
    ASSERT_EQ(line.size(), 1u);
    for (const double x : line[0].jumps) EXPECT_NEAR(x, 0.7, 1e-9);
}

std::string scene_of(const std::string& object) {
    return R"({ "isoparm": 1, "surfaces": { "S": { "type": "bezier", "points": [[[-1,-1,2],[-1,0,0],[-1,1,2]], [[0,-1,0],[0,0,-2],[0,1,0]], [[1,-1,2],[1,0,0],[1,1,2]]] } },
      "curves": { "c": { "type": "bezier", "points": [[0,0,0],[1,1,0],[2,0,0]] } }, "objects": [)" + object + R"(],
      "camera": { "eye": [0,0,9], "target": [0,0,0], "up": [0,1,0], "fov": 35 }, "image": { "width": 64, "height": 48, "samples": 4 } })";
}
TEST(Smoothness, PicturesShowTheColoursOfTheMap) {
    const TemporaryFolder t;
    // z = 2 (x^2 + y^2) / 2 - ...: the middle looks straight at the camera, K = 4 there.
    write_all(t / "s.json", scene_of(R"({ "surface": "S", "color_by": "gaussian", "range": [-8, 8] })"));
    for (const bool exact : {false, true}) {
        RenderOptions options;
        options.exact = exact;
        const Picture p = render(load_scene(t / "s.json"), options);
        const float* pixel = p.image.at(32, 24);
        const double K = curvature_of(load_scene(t / "s.json").surfaces[0].patches[0].patch, {0.5, 0.5}, What::gaussian, false);
        const Color expected = diverging(K / 8);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(pixel[k], expected[k], 0.04) << exact << ": a pixel is a twentieth of the surface";
    }
    write_all(t / "z.json", scene_of(R"({ "surface": "S", "color_by": "reflection", "stripes": 60 })"));
    const Picture zebra = render(load_scene(t / "z.json"), {});
    int dark = 0, light = 0;
    for (int x = 16; x < 48; ++x) (zebra.image.at(x, 20)[1] < 0.2f ? dark : light) += 1;
    for (int y = 10; y < 38; ++y) (zebra.image.at(32, y)[1] < 0.2f ? dark : light) += 1;
    EXPECT_GT(dark, 8);
    EXPECT_GT(light, 8);
}
// Scene s004_incompatible_twists: x_uv = (0, 0, 2 (a-2)), x_vu = (0, 0, 2 (b-2)) at (0,0), their opposites at the corners beside; a = 7, b = -3.
TEST(TwistArrows, AreBothMixedDerivativesWhereTheyDisagree) {
    const std::string path = std::string(ISOPARM_SOURCE_DIR) + "/scenes/s004_incompatible_twists.json";
    const auto arrows = [&](const std::map<std::string, double>& set, TwistArrows how) {
        const Scene s = load_scene(path, set);
        return twist_arrows(*s.find_surface("square"), how, 3);
    };
    TwistArrows how{true, 0.1, 3, false};
    const auto all = arrows({}, how);
    ASSERT_EQ(all.size(), 4u);
    for (const TwistArrow& t : all) {
        const double sign = (t.foot.x == 0) == (t.foot.y == 0) ? 1 : -1;
        EXPECT_LT(distance(t.tip_f - t.foot, {0, 0, sign}), 1e-15);
        EXPECT_LT(distance(t.tip_g - t.foot, {0, 0, -sign}), 1e-15);
        EXPECT_EQ(t.gap, "gap 20");
    }
    how.scale.reset();
    EXPECT_NEAR(distance(arrows({}, how)[0].foot, arrows({}, how)[0].tip_f), 0.5, 1e-15) << "a sixth of the size";
    EXPECT_EQ(arrows({{"b", 6}}, how)[0].gap, "gap 2");
    EXPECT_TRUE(arrows({{"b", 7}}, how).empty()) << "twists that agree";
    how.on = false;
    EXPECT_TRUE(arrows({}, how).empty());
}
TEST(TwistArrows, MoveWithTheSurfaceAndAreDrawn) {
    const TemporaryFolder t;
    const auto scene = [](const std::string& objects) {
        return R"({ "isoparm": 1, "curves": {
          "a0": { "type": "line", "points": [[0,0,0],[0,1,0]] }, "a1": { "type": "line", "points": [[1,0,0],[1,1,0]] },
          "b0": { "type": "line", "points": [[0,0,0],[1,0,0]] }, "b1": { "type": "line", "points": [[0,1,0],[1,1,0]] },
          "A": { "type": "bezier", "points": [[1,0,0],[1,0,1],[1,0,0]] }, "B": { "type": "bezier", "points": [[0,1,0],[0,1,0],[0,1,0]] } },
          "surfaces": { "N": { "type": "network", "a": ["a0","a1"], "b": ["b0","b1"], "cross": { "A": ["A","A"], "B": ["B","B"] } },
            "far": { "type": "transform", "surface": "N", "scale": [2,2,-3], "translate": [5,0,0] }, "both": { "type": "composite", "members": ["N", "far"] },
            "plain": { "type": "coons", "c0": "b0", "c1": "b1", "d0": "a0", "d1": "a1" } },
          "objects": [)" + objects + R"(],
          "camera": { "eye": [0.5,-9,1], "target": [0.5,0,0], "up": [0,0,1], "fov": 30 }, "image": { "width": 160, "height": 120, "samples": 4, "background": "white" } })";
    };
    write_all(t / "s.json", scene(R"({ "surface": "both", "twists": { "width": 4, "scale": 0.5, "legend": true } })"));
    const Scene s = load_scene(t / "s.json");
    const auto arrows = twist_arrows(*s.find_surface("both"), {true, 1.0, 3, false}, 1);
    ASSERT_EQ(arrows.size(), 8u);
    EXPECT_LT(distance(arrows[0].tip_f - arrows[0].foot, {0, 0, 2}), 1e-14);
    EXPECT_LT(distance(arrows[4].foot, {5, 0, 0}), 1e-14);
    EXPECT_LT(distance(arrows[4].tip_f - arrows[4].foot, {0, 0, -6}), 1e-14);
    EXPECT_EQ(arrows[4].gap, "gap 2") << "as check has it, of the data before the map";

    const Image image = render(s, {}).image;
    int blue = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) blue += image.at(x, y)[2] > 0.3f && image.at(x, y)[0] < 0.1f;
    EXPECT_GT(blue, 40) << "pixels of the arrows x_uv";

    const auto fails = [&](const std::string& object, const std::string& message) {
        write_all(t / "s.json", scene(object));
        try {
            load_scene(t / "s.json");
            ADD_FAILURE() << object;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
        }
    };
    fails(R"({ "surface": "plain", "twists": true })", "expected a surface whose data have twists");
    fails(R"({ "surface": "N", "twists": 3 })", "expected true, or arrows");
    fails(R"({ "surface": "N", "twists": { "scale": 0 } })", "a positive scale");
    fails(R"({ "surface": "N", "twists": { "scale": -1e300 } })", "a positive scale");
    fails(R"({ "surface": "N", "twists": { "width": 0 } })", "a width");
    fails(R"({ "surface": "N", "twists": { "size": 1 } })", "size");
    fails(R"({ "curve": "A", "twists": true })", "twists");
}

TEST(Smoothness, WrongKeysAreRefused) {
    const TemporaryFolder t;
    const auto fails = [&](const std::string& object, const std::string& message) {
        write_all(t / "s.json", scene_of(object));
        try {
            load_scene(t / "s.json");
            ADD_FAILURE() << object;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
        }
    };
    fails(R"({ "surface": "S", "color_by": "gauss" })", "expected one of: ");
    fails(R"({ "surface": "S", "color_by": "mean", "range": [1, 1] })", "expected from < to");
    fails(R"({ "surface": "S", "color_by": "mean", "stripes": 3 })", "found \"stripes\" with a curvature");
    fails(R"({ "surface": "S", "color_by": "isophotes", "legend": true })", "found \"legend\" with stripes");
    fails(R"({ "surface": "S", "color_by": "isophotes", "direction": [0,0,0] })", "expected a direction that is not zero");
    fails(R"({ "surface": "S", "legend": true })", "found \"legend\" without \"color_by\"");
    fails(R"({ "surface": "S", "jumps": { "of": "c0" } })", "expected one of: ");
    fails(R"({ "surface": "S", "jumps": {} })", "what jumps");
    fails(R"({ "surface": "S", "jumps": { "of": "g1", "top": 0 } })", "a positive number");
    fails(R"({ "curve": "c", "comb": { "teeth": 1 } })", "a number of teeth, a whole number from 2");
    fails(R"({ "curve": "c", "comb": { "scale": 0 } })", "positive scale");
    fails(R"({ "curve": "c", "comb": 3 })", "found 3, expected true, or a comb");
}

}  // namespace
}  // namespace isoparm::test
