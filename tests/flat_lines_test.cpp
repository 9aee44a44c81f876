// flat_lines_test.cpp -- flat lines and axes: where geometry says that they are.
#include "flat_lines.h"

#include "axes.h"
#include "camera.h"
#include "drawing_tests.h"
#include "drawn.h"
#include "error.h"
#include "overlay.h"
#include "paint.h"

namespace isoparm {
namespace {

using namespace test;

// ---- lines ----------------------------------------------------------------------------------------------------------

TEST(FlatLines, AreAsWideAsAskedAndScaleWithThePicture) {
    Scene scene = from_above(2, 100, 100, 1);
    add_line(scene, {-0.8, 0.1, 0}, {0.8, 0.1, 0}, 3);  // 80 pixels long, round ends
    EXPECT_NEAR(sum(render(scene, {}).image, 0), 80 * 3 + 2.25 * std::numbers::pi, 2);
    RenderOptions twice;
    twice.width = twice.height = 200;
    EXPECT_NEAR(sum(render(scene, twice).image, 0), 4 * (80 * 3 + 2.25 * std::numbers::pi), 8);
}
TEST(FlatLines, AreCutWhereSurfacesHideThem) {
    // The sheet covers the pixels 25 to 75 of the line from 10 to 90.
    for (const auto& [opacity, passed] : {std::pair{1.0, 0.0}, {0.75, 0.25}}) {
        for (const double z : {-0.5, 0.5}) {
            Scene scene = from_above(4, 100, 100, 1);
            SceneObject& sheet = add_sheet(scene, 0, opacity);
            sheet.color = Color{0, 0, 0};
            add_line(scene, {-1.6, 0, z}, {1.6, 0, z}, 2);
            Scene without = scene;
            without.objects.pop_back();
            const double red = sum(render(scene, {}).image, 0, 25, 75) - sum(render(without, {}).image, 0, 25, 75);
            EXPECT_NEAR(red, 2 * 50 * (z > 0 ? 1 : passed), 6) << opacity << ' ' << z;
        }
    }
}
TEST(FlatLines, OnASurfaceAreNotHiddenByIt) {
    Scene scene = from_above(4, 100, 100, 1);
    scene.camera.eye = Point{6, -9, 3};
    scene.camera.up = Point{0, 0, 1};
    add_sheet(scene, 0, 1);
    add_line(scene, {-1, 0.3, 0}, {1, 0.3, 0}, 2);
    const Camera camera = make_camera(scene.camera, drawn_points(scene), 100, 100);
    const TracedScene traced = build_traced_scene(scene, 1e-3, {});
    const Drawing d = overlay(scene, scene.objects, traced, camera, 1, 8);
    ASSERT_EQ(d.size(), 1u) << "one piece";
    EXPECT_EQ(d[0].opacity, 1);
    const auto& points = std::get<Polyline>(d[0].shape).points;
    const Vec2 a = camera.project({-1, 0.3, 0}), b = camera.project({1, 0.3, 0});
    EXPECT_NEAR(points.front().x, a.x, 1e-9);
    EXPECT_NEAR(points.back().y, b.y, 1e-9);
    EXPECT_LE(points.size(), 4u) << "straight";
}

TEST(FlatLines, DotsBoundariesAndNets) {
    Scene scene = from_above(4, 100, 100, 4);
    scene.camera.orthographic = 4;
    SceneObject& dot = add(scene, Kind::point);
    dot.point = {1.5, 1.5, 0};
    dot.line.width = 10;
    EXPECT_NEAR(sum(render(scene, {}).image, 3), 25 * std::numbers::pi, 2);
    scene.objects.clear();
    SceneObject& sheet = add_sheet(scene, 0, 0);  // 50 pixels a side
    sheet.boundary = true;
    sheet.line.width = 2;
    EXPECT_NEAR(sum(render(scene, {}).image, 3), 4 * 50 * 2, 8);
    scene.objects.clear();
    SceneObject& net = add(scene, Kind::net);
    net.net.points = {{-1, 0, 0}, {1, 0, 0}};
    net.net.rods = {{0, 1}};
    net.radius = 1e-3;
    net.line.width = 2;
    EXPECT_NEAR(sum(render(scene, {}).image, 3), 50 * 2 + std::numbers::pi, 3);
}

// ---- axes -----------------------------------------------------------------------------------------------------------

TEST(Axes, TicksAreRoundAndNotTooClose) {
    EXPECT_EQ(round_ticks(0, 3, 0.7), (std::vector<double>{0, 1, 2, 3}));
    EXPECT_EQ(round_ticks(-0.2, 1, 0.15), (std::vector<double>{-0.2, 0, 0.2, 0.4, 0.2 * 3, 0.8, 1}));
    EXPECT_EQ(round_ticks(0, 100, 30).size(), 3u);  // 0, 50, 100
    EXPECT_TRUE(round_ticks(0, 1, 0).empty());
    EXPECT_LE(round_ticks(0, 1, 1e-9).size(), 1000u);
}
TEST(Axes, TicksStandWhereTheyBelong) {
    const Scene scene = scene_from(R"json({ "isoparm": 1, "objects": [{ "axes": { "x": [0, 3], "y": [0, 1], "ticks": { "x": [1, 2], "y": false }, "names": ["t", "H"] } }],
        "camera": { "eye": [0,0,5], "target": [0,0,0], "up": [0,1,0], "orthographic": 4 } })json");
    const Camera camera = make_camera(scene.camera, drawn_points(scene), 400, 400);  // 100 pixels a unit
    const TracedScene traced = build_traced_scene(scene, 1e-3, {});
    const Drawing d = overlay(scene, scene.objects, traced, camera, 1, 20);
    std::vector<double> ticks;
    std::string texts;
    for (const DrawingItem& item : d) {
        if (const auto* line = std::get_if<Polyline>(&item.shape); line && line->points.size() == 2 && line->points[0].x == line->points[1].x && std::fabs(line->points[0].y - line->points[1].y) < 10)
            ticks.push_back(line->points[0].x);
        if (const auto* text = std::get_if<Text>(&item.shape)) texts += plain(text->text) + " ";
    }
    EXPECT_EQ(ticks, (std::vector<double>{camera.project({1, 0, 0}).x, camera.project({2, 0, 0}).x}));
    EXPECT_EQ(texts, "1 2 t H ");
}

}  // namespace
}  // namespace isoparm
