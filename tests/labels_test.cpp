// Labels, flat lines, axes and panels: where geometry says that they are.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "axes.h"
#include "camera.h"
#include "curves/bezier.h"
#include "drawn.h"
#include "error.h"
#include "flat_lines.h"
#include "labels.h"
#include "math_text.h"
#include "overlay.h"
#include "paint.h"
#include "panels.h"
#include "patches/tensor_bezier.h"
#include "picture.h"
#include "run_program.h"
#include "text_cairo.h"

namespace isoparm {
namespace {

using Kind = SceneObject::Kind;

Scene scene_from(const std::string& text) {
    const test::TemporaryFolder t;
    test::write_all(t / "scene.json", text);
    return load_scene(t / "scene.json");
}
/// Seen from above, `height` scene units high, transparent, one pixel to a pixel.
Scene from_above(double height, int width, int pixels, int samples) {
    Scene scene;
    scene.camera.eye = Point{0, 0, 10};
    scene.camera.target = Point{0, 0, 0};
    scene.camera.up = Point{0, 1, 0};
    scene.camera.orthographic = height;
    scene.image.width = width;
    scene.image.height = pixels;
    scene.image.samples = samples;
    return scene;
}
SceneObject& add(Scene& scene, Kind kind) {
    SceneObject& o = scene.objects.emplace_back();
    o.kind = kind;
    return o;
}
SceneObject& add_sheet(Scene& scene, double z, double opacity) {
    const std::string name = "sheet" + std::to_string(scene.surfaces.size());
    Surface& s = scene.surfaces.emplace_back();
    s.name = name;
    s.patches = {{name, make_bezier_patch({{{-1, -1, z}, {-1, 1, z}}, {{1, -1, z}, {1, 1, z}}})}};
    SceneObject& o = add(scene, Kind::surface);
    o.name = name;
    o.opacity = opacity;
    return o;
}
SceneObject& add_line(Scene& scene, const Point& a, const Point& b, double width) {
    const std::string name = "line" + std::to_string(scene.curves.size());
    scene.curves.push_back({name, make_bezier({a, b})});
    SceneObject& o = add(scene, Kind::curve);
    o.name = name;
    o.line.width = width;
    o.color = Color{1, 0, 0};
    return o;
}
double sum(const Image& image, int channel, int x0 = 0, int x1 = 1 << 20) {
    double all = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = x0; x < std::min(x1, image.width); ++x) all += image.at(x, y)[channel];
    return all;
}
std::string plain(const MathText& text) {
    std::string all;
    for (const TextRun& r : text) all += r.text;
    return all;
}

// ---- texts ----------------------------------------------------------------------------------------------------------

TEST(MathText, SubscriptsAreSmallUprightDigitsBelow) {
    const MathText t = parse_math_text("P_{01}");
    ASSERT_EQ(t.size(), 2u);
    EXPECT_EQ(t[0].text, "P");
    EXPECT_TRUE(t[0].italic);
    EXPECT_EQ(t[1].text, "01");
    EXPECT_FALSE(t[1].italic);
    EXPECT_LT(t[1].rise, 0);
    EXPECT_LT(t[1].scale, 0.8);
}
TEST(MathText, SuperscriptsStandOverSubscripts) {
    const MathText t = parse_math_text("H_i^{(3)}(t)");
    ASSERT_GE(t.size(), 5u);
    EXPECT_EQ(t[1].begins, TextRun::Begins::subscript);
    EXPECT_EQ(t[2].begins, TextRun::Begins::over_subscript);
    EXPECT_GT(t[2].rise, 0);
    EXPECT_EQ(plain(t), "Hi(3)(t)");
    EXPECT_EQ(t.back().scale, 1);
    // Side by side they would be wider.
    EXPECT_LT(text_box(t, 100).advance, text_box(parse_math_text("H_{i(3)}(t)"), 100).advance);
}
TEST(MathText, GreekProseAndMinus) {
    EXPECT_EQ(plain(parse_math_text("\\alpha-\\Delta")), "α−Δ");
    EXPECT_FALSE(parse_math_text("yellow triangle").at(0).italic);
    EXPECT_FALSE(parse_math_text("(a)", true).at(0).italic);
    const MathText mixed = parse_math_text("(a) sides $E_1$");
    EXPECT_FALSE(mixed.at(0).italic);
    EXPECT_EQ(mixed.at(1).text, "E");
    EXPECT_TRUE(mixed.at(1).italic);
    EXPECT_TRUE(parse_math_text("\\mathbf{S}").at(0).bold);
    EXPECT_EQ(plain(number_text(-0.25, 2)), "−0.25");
    EXPECT_EQ(plain(number_text(2.5, 2)), "2.5");
    EXPECT_EQ(plain(number_text(-1e-12, 1)), "0");
}
TEST(MathText, FaultsSayWhere) {
    for (const auto& [text, offset] : {std::pair<std::string, std::size_t>{"P_{0", 2}, {"P_", 1}, {"a}", 1}, {"x \\alhpa", 2}, {"a $b", 2}}) {
        try {
            parse_math_text(text);
            ADD_FAILURE() << text;
        } catch (const MathTextError& e) {
            EXPECT_EQ(e.offset, offset) << text;
        }
    }
}
TEST(MathText, LettersGrowInProportionToTheirSize) {
    const MathText t = parse_math_text("P_{00}");
    const TextBox small = text_box(t, 10), large = text_box(t, 100);
    EXPECT_NEAR(large.advance, 10 * small.advance, 0.02 * large.advance);
    EXPECT_NEAR(large.top, 10 * small.top, 0.02 * -large.top);
    EXPECT_GT(small.advance, 5);
    EXPECT_LT(small.top, -4);
}

// ---- where labels are -----------------------------------------------------------------------------------------------

TEST(Labels, TheAnchorIsWhereTheRasterHasThePoint) {
    // The centroid of a small ball in the raster against the projection that anchors its label.
    for (const bool orthographic : {true, false})
        for (const Point& p : {Point{0.3, -0.2, 0.4}, {-0.8, 0.5, -0.3}, {0.9, 0.9, 0.9}, {0, 0, 0}}) {
            Scene scene;
            scene.camera.eye = Point{3, -4, 2.5};
            scene.camera.target = Point{0, 0, 0};
            if (orthographic) scene.camera.orthographic = 4;
            scene.image.width = 160;
            scene.image.height = 120;
            scene.image.samples = 64;
            SceneObject& o = add(scene, Kind::point);
            o.point = p;
            o.radius = 0.06;
            const Camera camera = make_camera(scene.camera, drawn_points(scene), 160, 120);
            const Image image = render(scene, {}).image;
            double x = 0, y = 0, all = 0;
            for (int j = 0; j < 120; ++j)
                for (int i = 0; i < 160; ++i) {
                    const double a = image.at(i, j)[3];
                    x += a * (i + 0.5), y += a * (j + 0.5), all += a;
                }
            ASSERT_GT(all, 1);
            const Vec2 anchor = camera.project(p);
            EXPECT_NEAR(x / all, anchor.x, 0.5);
            EXPECT_NEAR(y / all, anchor.y, 0.5);
        }
}

TEST(Labels, StandApartAndInsideThePicture) {
    const MathText text = parse_math_text("P_{00}");
    Label label;
    label.text = text;
    std::vector<LabelRequest> requests;
    for (const double x : {2.0, 30.0, 60.0, 100.0, 104.0, 140.0, 199.0})
        for (const double y : {2.0, 60.0, 119.0}) requests.push_back({&label, -1, {{{x, y}, 1, {}, 2}}, 9, {}});
    Drawing drawing;
    place_labels(requests, {}, 200, 120, drawing);
    ASSERT_EQ(drawing.size(), requests.size());
    const TextBox box = text_box(text, 9);
    for (std::size_t i = 0; i < drawing.size(); ++i) {
        const Vec2 a = std::get<Text>(drawing[i].shape).at;
        EXPECT_GE(a.x + box.left, 0);
        EXPECT_LE(a.x + box.right, 200);
        EXPECT_GE(a.y + box.top, 0);
        EXPECT_LE(a.y + box.bottom, 120);
        for (std::size_t j = 0; j < i; ++j) {
            const Vec2 b = std::get<Text>(drawing[j].shape).at;
            EXPECT_FALSE(std::fabs(a.x - b.x) < box.right - box.left && std::fabs(a.y - b.y) < box.bottom - box.top) << i << ' ' << j;
        }
    }
}

TEST(Labels, KeepOffLinesAndTurnAwayFromTheMiddle) {
    Label label;
    label.text = parse_math_text("A");
    Drawing drawing;
    std::vector<Obstacle> line;  // to the right of the point
    for (int x = 50; x < 100; x += 2) line.push_back({{double(x), 50}, 1});
    place_labels({{&label, -1, {{{50, 50}, 1, {1, 0.2}, 2}}, 12, {}}}, line, 100, 100, drawing);
    const Vec2 at = std::get<Text>(drawing.at(0).shape).at;
    const TextBox box = text_box(label.text, 12);
    EXPECT_TRUE(at.y + box.top > 51 || at.y + box.bottom < 49 || at.x + box.right < 50);
    drawing.clear();
    place_labels({{&label, -1, {{{50, 50}, 1, {0, -1}, 2}}, 12, {}}}, {}, 100, 100, drawing);
    EXPECT_LT(std::get<Text>(drawing.at(0).shape).at.y, 50) << "above";
    drawing.clear();
    label.side = 6;
    place_labels({{&label, 6, {{{50, 50}, 1, {0, -1}, 2}}, 12, {}}}, {}, 100, 100, drawing);
    EXPECT_GT(std::get<Text>(drawing.at(0).shape).at.y + box.top, 52) << "below, as asked";
}

TEST(Labels, BehindASurfaceAreFainterOrAbsent) {
    std::vector<double> opacity;
    for (const Hidden hidden : {Hidden::show, Hidden::ghost, Hidden::hide}) {
        Scene scene = from_above(4, 100, 100, 1);
        add_sheet(scene, 1, 1);
        SceneObject& o = add(scene, Kind::point);
        o.label.text = parse_math_text("A");
        o.label.hidden = hidden;
        const Camera camera = make_camera(scene.camera, drawn_points(scene), 100, 100);
        const TracedScene traced = build_traced_scene(scene, 1e-3, {});
        const Drawing d = overlay(scene, scene.objects, traced, camera, 1, 8);
        opacity.push_back(d.empty() ? 0 : d.at(0).opacity);
    }
    EXPECT_EQ(opacity[0], 1);
    EXPECT_NEAR(opacity[1], 0.4, 1e-12);
    EXPECT_EQ(opacity[2], 0);
}

TEST(Labels, ABallDoesNotHideItsOwnLabel) {
    Scene scene = from_above(4, 100, 100, 1);
    SceneObject& o = add(scene, Kind::point);
    o.radius = 0.5;
    o.label.text = parse_math_text("A");
    const Camera camera = make_camera(scene.camera, drawn_points(scene), 100, 100);
    const TracedScene traced = build_traced_scene(scene, 1e-3, {});
    const Drawing d = overlay(scene, scene.objects, traced, camera, 1, 8);
    ASSERT_EQ(d.size(), 1u);
    EXPECT_EQ(d[0].opacity, 1);
    const Text& t = std::get<Text>(d[0].shape);
    const TextBox box = text_box(t.text, t.size);
    const double dx = std::max({t.at.x + box.left - 50, 50 - t.at.x - box.right, 0.0}), dy = std::max({t.at.y + box.top - 50, 50 - t.at.y - box.bottom, 0.0});
    EXPECT_GE(std::hypot(dx, dy), 12.5) << "clear of the ball of 12.5 pixels";
}

TEST(Labels, NetsAreLabelledWithTheirIndices) {
    const auto texts = [](const std::string& definition) {
        const Scene s = scene_from("{ \"isoparm\": 1, \"surfaces\": {}, " + definition + ", \"objects\": [{ \"net\": \"N\", \"labels\": \"P\" }] }");
        std::string all;
        for (const Label& l : s.objects[0].net_labels) all += plain(l.text) + " ";
        return all;
    };
    EXPECT_EQ(texts(R"("curves": { "N": { "type": "bezier", "points": [[0,0,0], [1,0,0], [2,1,0]] } })"), "P0 P1 P2 ");
    const auto surface = [](const std::string& definition) {
        const Scene s = scene_from("{ \"isoparm\": 1, \"surfaces\": { \"N\": " + definition + "}, \"objects\": [{ \"net\": \"N\", \"labels\": {\"text\": \"P\", \"size\": 9} }] }");
        std::string all;
        for (const Label& l : s.objects[0].net_labels) all += plain(l.text) + " ";
        EXPECT_EQ(s.objects[0].net_labels[0].size, 9);
        return all;
    };
    EXPECT_EQ(surface(R"({ "type": "bezier", "points": [[[0,0,0], [0,1,0], [0,2,0]], [[1,0,0], [1,1,0], [1,2,0]]] })"), "P00 P01 P02 P10 P11 P12 ");
    EXPECT_EQ(surface(R"({ "type": "bezier_triangle", "degree": 2, "points": [[0,0,0], [1,0,0], [2,0,0], [0,1,0], [1,1,0], [0,2,0]] })"),
              "P200 P110 P020 P101 P011 P002 ");
}

// ---- paint ----------------------------------------------------------------------------------------------------------

TEST(Paint, BlendsInLinearLightAndOverNothing) {
    Image image{4, 4, std::vector<float>(64, 0)};
    for (int i = 0; i < 8; ++i)  // the upper half white, the lower transparent
        for (int k = 0; k < 4; ++k) image.pixels[4 * i + k] = 1;
    paint({{Filled{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}}, {0.5, 0, 0}, 0.25}}, 0, 0, image);
    EXPECT_NEAR(image.at(1, 0)[0], 0.25 * 0.5 + 0.75, 1e-6);
    EXPECT_NEAR(image.at(1, 0)[1], 0.75, 1e-6);
    EXPECT_EQ(image.at(1, 0)[3], 1);
    EXPECT_NEAR(image.at(1, 3)[0], 0.125, 1e-6);  // premultiplied
    EXPECT_NEAR(image.at(1, 3)[3], 0.25, 1e-6);
}
TEST(Paint, CoversTheAreaThatGeometryHas) {
    Image image{40, 30, std::vector<float>(4800, 0)};
    paint({{Filled{{{3.25, 4.5}, {33.25, 4.5}, {3.25, 24.5}}}, {1, 1, 1}, 1}}, 0, 0, image);
    EXPECT_NEAR(sum(image, 3), 300, 0.02 * 300);  // Cairo counts in 255ths and samples each pixel 15 x 17 times
    Image line{40, 30, std::vector<float>(4800, 0)};
    paint({{Polyline{{{5.3, 15.2}, {35.3, 15.2}}, 2.5, {}, false}, {1, 1, 1}, 1}}, 0, 0, line);
    EXPECT_NEAR(sum(line, 3), 75, 0.02 * 75);
}

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
