// panels_test.cpp -- panels beside each other, and the picture as a whole: threads, sheets over each other.
#include "panels.h"

#include <tbb/global_control.h>

#include "camera.h"
#include "drawing_tests.h"
#include "error.h"

namespace isoparm {
namespace {

using namespace test;

// ---- panels ---------------------------------------------------------------------------------------------------------

constexpr const char* kPanels = R"json({ "isoparm": 1, "curves": { "c": { "type": "line", "points": [[0,0,0], [2,0,0]] } }, "layout": "1x2",
    "panels": [ { "objects": [{ "point": [0,0,0], "radius": 0.2 }], "title": "(a)" }, { "objects": [{ "point": [2,0,0], "radius": 0.2 }, { "curve": "c", "radius": 0.01 }], "title": "(b)" } ],
    "camera": { "eye": [1,0,10], "target": [1,0,0], "up": [0,1,0], "orthographic": true, "fit": true },
    "image": { "width": 200, "height": 80, "samples": 16, "background": "transparent" } })json";

TEST(Panels, ShareOneCameraThatFitsAll) {
    const Scene scene = scene_from(kPanels);
    const auto views = views_of(scene, 200, 80, {});
    ASSERT_EQ(views.size(), 2u);
    EXPECT_EQ(views[0].width, 100);
    EXPECT_EQ(views[1].x, 100);
    EXPECT_EQ(views[0].height, views[1].height);
    EXPECT_LT(views[0].height, 80) << "room for titles";
    const Camera a = make_camera(views[0].camera, views[0].fitted, 100, views[0].height), b = make_camera(views[1].camera, views[1].fitted, 100, views[1].height);
    EXPECT_EQ(a.half_height, b.half_height);
    EXPECT_EQ(a.eye, b.eye);
    const Image image = render(scene, {}).image;
    const Vec2 first = a.project({0, 0, 0}), second = b.project({2, 0, 0});
    EXPECT_EQ(image.at(int(first.x), int(first.y))[3], 1);
    EXPECT_EQ(image.at(100 + int(second.x), int(second.y))[3], 1);
    EXPECT_EQ(image.at(100 + int(first.x), int(first.y) + 3)[3], 0) << "the first panel's ball";
    double title = 0;
    for (int y = views[0].height; y < 80; ++y)
        for (int x = 0; x < 200; ++x) title += image.at(x, y)[3];
    EXPECT_GT(title, 1);
}
TEST(Panels, ACropIsAPartOfTheWhole) {
    const Scene scene = scene_from(kPanels);
    const Image whole = render(scene, {}).image;
    RenderOptions options;
    options.crop = {60, 11, 171, 79};
    const Image part = render(scene, options).image;
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x)
            for (int k = 0; k < 4; ++k) ASSERT_EQ(part.at(x, y)[k], whole.at(x + 60, y + 11)[k]) << x << ' ' << y;
}
TEST(Panels, TooSmallPicturesAreRefused) {
    RenderOptions options;
    options.width = options.height = 1;
    EXPECT_THROW(render(scene_from(kPanels), options), Error);
}

// ---- the whole ------------------------------------------------------------------------------------------------------

TEST(RenderThreads, TheVectorsAreTheSameForEveryNumber) {
    std::vector<Image> images;
    for (const int threads : {1, 3}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        Scene scene = from_above(3, 90, 60, 4);
        add_sheet(scene, 0, 0.6).label.text = parse_math_text("S");
        add_line(scene, {-1.5, -1, -1}, {1.5, 1, 1}, 2).label.text = parse_math_text("c_0");
        SceneObject& axes = add(scene, Kind::axes);
        axes.line.width = 1;
        axes.axes.axis[0] = Axes::Axis{0, 1, {}, parse_math_text("t")};
        images.push_back(render(scene, {}).image);
    }
    EXPECT_EQ(images[0].pixels, images[1].pixels);
}

TEST(Translucency, ThreeSheetsCompositeFrontToBackWithTheirOwnColours) {
    // Each sheet alone and opaque gives its colour in this light; the sky above it is free, so that the uppermost is as
    // bright as alone, and what is below differs only by what the sheets above take of its light.
    const Color colors[3] = {{0.8, 0, 0}, {0, 0.8, 0}, {0, 0, 0.8}};
    const double opacity[3] = {0.3, 0.5, 0.7};  // from below
    Scene scene = from_above(1, 16, 16, 64);
    for (int k = 0; k < 3; ++k) add_sheet(scene, 0.1 * k, opacity[k]).color = colors[k];
    const Image image = render(scene, {}).image;
    const float* p = image.at(8, 8);
    const double through_top = 1 - opacity[2], through_two = through_top * (1 - opacity[1]);
    EXPECT_NEAR(p[3], 1 - through_two * (1 - opacity[0]), 1e-6);
    Scene alone = from_above(1, 16, 16, 64);
    add_sheet(alone, 0.2, 1).color = colors[2];
    const double blue = render(alone, {}).image.at(8, 8)[2];
    // Gloss and rim are white: they add to every channel, each seen through what is above it.
    Scene black = alone;
    black.objects[0].color = Color{0, 0, 0};
    const double gloss = render(black, {}).image.at(8, 8)[0];
    const double green_seen = (p[1] - gloss * opacity[2]) / (through_top * opacity[1]), red_seen = (p[0] - gloss * opacity[2]) / (through_two * opacity[0]);
    EXPECT_NEAR(p[2], opacity[2] * blue, 0.06) << "blue is in front";
    EXPECT_GT(p[2] + 0.02, opacity[2] * blue);
    EXPECT_GT(green_seen, 0.5 * blue) << "no heavy shadow";
    EXPECT_LT(green_seen, 1.1 * blue);
    EXPECT_GT(red_seen, 0.35 * blue);
    EXPECT_LT(red_seen, 1.3 * blue);
}

}  // namespace
}  // namespace isoparm
