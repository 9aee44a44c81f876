// flat_lines_test.cpp -- flat lines and axes: where geometry says that they are.
#include "drawing/flat_lines.h"

#include "drawing/axes.h"
#include "drawing/drawn.h"
#include "drawing/overlay.h"
#include "drawing/paint.h"
#include "drawing_tests.h"
#include "error.h"
#include "picture/camera.h"

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
TEST(FlatLines, AreSeenThroughPanesAndNotThroughBodiesOfGlass) {
    for (const bool traced_light : {true, false})
        for (const bool thin : {true, false}) {
            Scene scene = from_above(4, 100, 100, 1);
            SceneObject& pane = add_sheet(scene, 0, 1);
            pane.material = {Material::Kind::glass, 0, 1.5, thin}, pane.color = Color{0.25, 0.25, 0.25};
            if (traced_light) scene.lighting = LightingSettings{};
            const Camera camera = make_camera(scene.camera, drawn_points(scene), 100, 100);
            const TracedScene traced = build_traced_scene(scene, 1e-3, {});
            EXPECT_NEAR(Sight(traced, camera).of({0.3, 0.2, -0.5}), traced_light && thin ? 0.25 : 0, 1e-12);
            EXPECT_EQ(Sight(traced, camera).of({0.3, 0.2, 0.5}), 1);
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

TEST(Axes, BallsOnTicksDoNotHideTheirNumbers) {
    for (const double radius : {0.0, 0.02, 0.05, 0.6}) {
        Scene scene = from_above(4, 800, 800, 1);
        SceneObject& axes = add(scene, Kind::axes);
        axes.axes.axis[0] = Axes::Axis{-1.5, 1.5, std::vector<double>{-1, 0, 1}, {}};
        axes.line.width = 1, axes.line.hidden = Hidden::hide;
        if (radius > 0)
            for (const double x : {-1.0, 0.0, 1.0}) {
                SceneObject& ball = add(scene, Kind::point);
                ball.point = {x, 0, 0}, ball.radius = radius;
            }
        RenderOptions how;
        how.vectors = true;
        const Picture picture = render(scene, how);
        const Drawing& drawing = picture.drawn.at(0).drawing;
        EXPECT_EQ(std::count_if(drawing.begin(), drawing.end(), [](const DrawingItem& item) { return std::holds_alternative<Text>(item.shape) && item.opacity == 1; }), radius < 0.6 ? 3 : 0) << radius << ": large balls hide them, as all else";
    }
}
TEST(Axes, TicksMayHaveNamesInsteadOfNumbers) {
    const Scene scene = scene_from(R"json({ "isoparm": 1, "objects": [{ "axes": { "x": [0, 3], "ticks": [[2, "i+1"], 1, [0, "i-1"]] } }] })json");
    const Axes::Axis& x = *scene.objects[0].axes.axis[0];
    EXPECT_EQ(*x.ticks, (std::vector<double>{0, 1, 2})) << "in order";
    EXPECT_EQ(plain(x.tick_texts[0]), "i\u22121");
    EXPECT_TRUE(x.tick_texts[1].empty());
    EXPECT_EQ(plain(x.tick_texts[2]), "i+1");
    const Camera camera = make_camera(scene.camera, drawn_points(scene), 400, 400);
    std::string texts;
    for (const DrawingItem& item : overlay(scene, scene.objects, build_traced_scene(scene, 1e-3, {}), camera, 1, 20))
        if (const auto* text = std::get_if<Text>(&item.shape)) texts += plain(text->text) + " ";
    EXPECT_EQ(texts, "i\u22121 1 i+1 ");
}

// ---- arrows ---------------------------------------------------------------------------------------------------------

TEST(Arrows, AreTheVectorsOfSurfacesAndCurves) {
    // S = (u, v, u v): S_u = (1, 0, v), S_uv = (0, 0, 1); the parabola (t, t^2, 0) has curvature toward +y at 0.
    const Scene scene = scene_from(R"json({ "isoparm": 1,
        "curves": { "c": { "type": "bezier", "points": [[-1,1,0], [0,-1,0], [1,1,0]] } },
        "surfaces": { "S": { "type": "bilinear", "points": [[0,0,0], [1,0,0], [0,1,0], [1,1,1]] } },
        "objects": [ { "arrow": { "surface": "S", "at": [0.5, 0.5], "along": "u", "scale": 2 } },
                     { "arrow": { "surface": "S", "at": [0.5, 0.5], "along": "uv" } },
                     { "arrow": { "surface": "S", "at": [0, 0], "along": "normal", "length": 3 } },
                     { "arrow": { "curve": "c", "at": 0.5, "along": "normal" } },
                     { "arrow": { "curve": "c", "at": 0.5, "length": 1 } },
                     { "arrow": { "from": [1,2,3], "to": [1,2,4] } } ] })json");
    const Point expected[6][2] = {{{0.5, 0.5, 0.25}, {2.5, 0.5, 1.25}}, {{0.5, 0.5, 0.25}, {0.5, 0.5, 1.25}}, {{0, 0, 0}, {0, 0, 3}},
                                  {{0, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {1, 0, 0}}, {{1, 2, 3}, {1, 2, 4}}};
    ASSERT_EQ(scene.objects.size(), 6u);
    for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_LT(distance(scene.objects[k].arrow.tail, expected[k][0]), 1e-12) << k;
        EXPECT_LT(distance(scene.objects[k].arrow.tip, expected[k][1]), 1e-12) << k;
    }
}
TEST(Arrows, KeepTheirWidthAndPointAtTheirTip) {
    // Shaft and head on the picture, whatever the depth: the same width, the tip where the camera projects it.
    for (const double z : {0.0, 5.0}) {
        Scene scene = from_above(4, 200, 200, 1);
        scene.camera.orthographic.reset();
        SceneObject& o = add(scene, Kind::arrow);
        o.arrow = {{-0.5, 0, z}, {0.5, 0.2, z}};
        o.line.width = 3;
        const Camera camera = make_camera(scene.camera, {}, 200, 200);
        const Drawing d = overlay(scene, scene.objects, build_traced_scene(scene, 1e-3, {}), camera, 1, 8);
        ASSERT_EQ(d.size(), 2u);
        const Vec2 tail = camera.project(o.arrow.tail), tip = camera.project(o.arrow.tip);
        const auto& shaft = std::get<Polyline>(d[0].shape);
        const auto& head = std::get<Filled>(d[1].shape).outline;
        EXPECT_EQ(shaft.width, 3);
        EXPECT_NEAR(apart(shaft.points.front(), tail), 0, 1e-9);
        EXPECT_NEAR(apart(head[0], tip), 0, 1e-9);
        EXPECT_NEAR(apart(head[1], head[3]), 2 * 1.9 * 3, 1e-6);
        EXPECT_LT(apart(shaft.points.back(), tip), apart(head[1], tip)) << "no gap between shaft and head";
        EXPECT_GT(apart(shaft.points.back(), tip), 3) << "the shaft does not stick out of the tip";
    }
}
TEST(Arrows, AreHiddenBySurfaces) {
    Scene scene = from_above(4, 100, 100, 1);
    add_sheet(scene, 0, 1);
    SceneObject& o = add(scene, Kind::arrow);
    o.arrow = {{-0.8, 0, -1}, {0.8, 0, -1}};
    o.line.width = 2;
    const Camera camera = make_camera(scene.camera, {}, 100, 100);
    EXPECT_TRUE(overlay(scene, scene.objects, build_traced_scene(scene, 1e-3, {}), camera, 1, 8).empty());
}

}  // namespace
}  // namespace isoparm
