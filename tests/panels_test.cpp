// panels_test.cpp -- panels beside each other, and the picture as a whole: threads, sheets over each other.
#include "drawing/insets.h"

#include <tbb/global_control.h>

#include "drawing/legend.h"
#include "drawing/text_cairo.h"
#include "drawing_tests.h"
#include "error.h"
#include "picture/camera.h"
#include "picture/layout.h"
#include "samples.h"

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

TEST(Panels, HaveOneScaleAlsoWhereOnlyOneHasALegend) {
    Scene scene = scene_from(R"json({ "isoparm": 1, "surfaces": { "S": { "type": "bilinear", "points": [[0,0,0], [1,0,0], [0,1,0], [1,1,1]] } },
        "panels": [ { "objects": [{ "surface": "S" }] }, { "objects": [{ "surface": "S", "color_by": "mean", "legend": true }] } ] })json");
    const auto views = views_of(scene, 800, 400, {});
    const Camera a = camera_of(views[0]), b = camera_of(views[1]);
    EXPECT_EQ(a.eye, b.eye);
    EXPECT_EQ(a.half_height / a.height, b.half_height / b.height) << "scene units a pixel";
    EXPECT_GT(a.width, b.width) << "the legend's room";
    for (const Point& p : {Point{0, 0, 0}, {1, 1, 1}, {1, 0, 0}, {0, 1, 0}}) {
        EXPECT_GT(b.project(p).x, 0);
        EXPECT_LT(b.project(p).x, b.width);
    }
}
TEST(Panels, AreMarkedUnlessTheirTitlesAre) {
    const auto marks = [](const std::string& keys, const std::string& title = "") {
        std::string panels;
        for (int k = 0; k < 3; ++k) panels += std::string(k ? "," : "") + R"({ "objects": [{ "point": [0,0,0] }] )" + (title.empty() ? "" : ", \"title\": \"" + title + "\"") + "}";
        const Scene scene = scene_from("{ \"isoparm\": 1, " + keys + " \"panels\": [" + panels + "] }");
        std::string all;
        for (const DrawingItem& item : titles_of(scene, views_of(scene, 600, 200, {}))) all += plain(std::get<Text>(item.shape).text) + "|";
        return all;
    };
    EXPECT_EQ(marks(""), "(a)|(b)|(c)|");
    EXPECT_EQ(marks("", "x"), "(a)\u2002x|(b)\u2002x|(c)\u2002x|");
    EXPECT_EQ(marks("", "(i) x"), "(i) x|(i) x|(i) x|");
    EXPECT_EQ(marks("\"marks\": false,", "x"), "x|x|x|");
    EXPECT_EQ(marks("\"marks\": \"i.\","), "i.|ii.|iii.|");
    EXPECT_EQ(marks("\"marks\": { \"text\": \"A\", \"place\": \"inside\" },", "x"), "A|x|B|x|C|x|");
}
TEST(Legends, OfSeveralBarsAndLargeLettersFitIntoHalfThePicture) {
    std::vector<SceneObject> objects(3);
    for (std::size_t k = 0; k < 3; ++k) objects[k].color_by.legend = true, objects[k].color_by.what = ColorBy::What(1 + k);
    for (const double letter : {10.0, 170.0}) {
        const LegendRoom room = legend_room(objects, letter, 600);
        EXPECT_LE(room.width, 300);
        EXPECT_NEAR(room.width, 3 * legend_width(room.letter), 1);
        EXPECT_LE(room.letter, letter);
        std::vector<ColorScale> scales(3);
        for (const DrawingItem& item : legends(scales, 600, 400, room.letter))
            if (const auto* text = std::get_if<Text>(&item.shape)) {
                EXPECT_GT(text->at.x, 299);
                EXPECT_LT(text->at.x + (text->turned ? 0 : text_box(text->text, text->size).advance), 600);
                if (text->turned) EXPECT_LT(text_box(text->text, text->size).advance, 400);
            }
    }
    objects[1].color_by = objects[0].color_by = ColorBy{ColorBy::What::mean, {{-1, 1}}, 24, {}, true};
    EXPECT_NEAR(legend_room(objects, 10, 600).width, 2 * legend_width(10), 1) << "what two share is drawn once";
}

// ---- insets ---------------------------------------------------------------------------------------------------------

/// Middle of what is red in a box of the picture.
Vec2 red_middle(const Image& image, int x0, int y0, int x1, int y1) {
    double sum = 0, x = 0, y = 0;
    for (int j = y0; j < y1; ++j)
        for (int i = x0; i < x1; ++i) {
            const float* c = image.at(i, j);
            const double red = c[1] < 0.6f ? 1 : 0;  // lit or not
            sum += red, x += red * (i + 0.5), y += red * (j + 0.5);
        }
    return {x / sum, y / sum};
}
TEST(Insets, AnchorAndRasterAgreeInPanelsAndInsets) {
    // The ball is small: the middle of its picture is where the camera of its view projects it, to half a pixel.
    for (const bool orthographic : {true, false}) {
        Scene scene = scene_from(std::string(R"json({ "isoparm": 1, "panels": [ { "objects": [{ "point": [0,0,0], "color": "#000" }] },
            { "objects": [{ "point": [0.5,0.3,0.2], "radius": 0.02, "color": "#f00" }], "insets": [{ "around": [0.49,0.3,0.19], "zoom": 3, "place": "below left", "size": 0.4, "color": "#000" }] } ],
            "camera": { "eye": [1,-3,2], "target": [0.2,0.1,0], )json") + (orthographic ? "\"orthographic\": 2" : "\"fov\": 35") + R"json( }, "image": { "width": 640, "height": 300, "samples": 16 } })json");
        const auto views = views_of(scene, 640, 300, {});
        ASSERT_EQ(views.size(), 3u);
        const Image image = render(scene, {}).image;
        for (const View* v : {&views[1], &views[2]}) {
            const bool inset = v == &views[2];
            const Vec2 at = camera_of(*v).project({0.5, 0.3, 0.2});
            const double x = at.x + v->x, y = at.y + v->y;
            const int r = inset ? 18 : 10;
            ASSERT_TRUE(!inset || (at.x > r && at.y > r && at.x < v->width - r && at.y < v->height - r)) << "what is around the point is in the inset";
            const Vec2 seen = red_middle(image, int(x) - r, int(y) - r, int(x) + r, int(y) + r);
            EXPECT_NEAR(seen.x, x, 0.5) << orthographic << inset;
            EXPECT_NEAR(seen.y, y, 0.5) << orthographic << inset;
        }
        const Camera whole = camera_of(views[1]), part = camera_of(views[2]);
        EXPECT_NEAR(whole.pixel_size(2) / part.pixel_size(2), 3, 1e-12) << "three times as large";
        const Point a{0.4, 0.2, 0.2};
        EXPECT_LT(length(cross(part.ray(part.project(a).x, part.project(a).y).direction, orthographic ? part.forward : a - part.eye)), 1e-12) << "rays and projections are inverse";
    }
}
TEST(Insets, ARegionFillsItsFrame) {
    const Scene scene = scene_from(R"json({ "isoparm": 1, "objects": [{ "point": [0,0,0] }], "insets": [{ "region": [0.1, 0.2, 0.3, 0.6], "place": [0.5, 0.1], "size": 0.4 }], "image": { "width": 500, "height": 400 } })json");
    const auto views = views_of(scene, 500, 400, {});
    ASSERT_EQ(views.size(), 2u);
    EXPECT_EQ(views[1].x, 250);
    EXPECT_EQ(views[1].y, 40);
    EXPECT_EQ(views[1].width, 200);
    EXPECT_EQ(views[1].height, 320) << "160 of 100 pixels, twice as large";
    const Camera whole = camera_of(views[0]), part = camera_of(views[1]);
    const Vec2 p = whole.project({0, 0, 0}), q = part.project({0, 0, 0});
    EXPECT_NEAR(q.x, 2 * (p.x - 50), 1e-9);
    EXPECT_NEAR(q.y, 2 * (p.y - 80), 1e-9);
}
// Wherever the two lie; one that holds the other has none.
TEST(Insets, ConnectingLinesCrossNoFrame) {
    tests::Random random(5);
    int lines = 0;
    for (int k = 0; k < 300; ++k) {
        std::vector<View> views(2);
        views[0].width = views[0].height = 1000;
        View& v = views[1];
        v.inset = Inset{};
        v.inset->lines = true;
        v.x = int(800 * random.number()), v.y = int(800 * random.number()), v.width = 20 + int(180 * random.number()), v.height = 20 + int(180 * random.number());
        v.zoom = {800 * random.number(), 800 * random.number(), 20 + 180 * random.number(), 1000, 1000};
        const Drawing drawing = frames_of(views, 1);
        const auto corners = [&](const DrawingItem& item) { return std::get<Polyline>(item.shape).points; };
        const auto part = corners(drawing.front()), frame = corners(drawing.back());
        for (std::size_t i = 1; i + 1 < drawing.size(); ++i) {
            const auto line = corners(drawing[i]);
            ++lines;
            for (double t = 0.001; t < 1; t += 0.001) {
                const Vec2 p{line[0].x + t * (line[1].x - line[0].x), line[0].y + t * (line[1].y - line[0].y)};
                for (const auto& box : {part, frame})
                    ASSERT_FALSE(p.x > box[0].x + 1e-9 && p.x < box[2].x - 1e-9 && p.y > box[0].y + 1e-9 && p.y < box[2].y - 1e-9) << k << " at " << t;
            }
        }
    }
    EXPECT_GT(lines, 400);
}
TEST(Insets, LinesOfThePictureEndAtTheirFrames) {
    Scene scene = scene_from(R"json({ "isoparm": 1, "curves": { "c": { "type": "line", "points": [[-1,0,0], [1,0,0]] } }, "objects": [{ "curve": "c", "line": 4, "color": "#f00" }],
        "insets": [{ "camera": { "eye": [0,0,5], "target": [0,9,0], "fov": 5 }, "place": "center", "size": 0.5 }],
        "camera": { "eye": [0,0,5], "target": [0,0,0], "up": [0,1,0], "orthographic": 2 }, "image": { "width": 200, "height": 200, "samples": 1 } })json");
    RenderOptions options;
    options.vectors = true;
    const Picture p = render(scene, options);
    ASSERT_GE(p.drawn.size(), 1u);
    ASSERT_EQ(p.drawn[0].holes.size(), 1u);
    EXPECT_EQ(p.drawn[0].holes[0], (std::array{50, 50, 100, 100}));
    const Image image = render(scene, {}).image;
    EXPECT_LT(image.at(25, 100)[1], 0.01) << "the red line";
    EXPECT_GT(image.at(75, 100)[1], 0.99) << "not in the frame";
}
TEST(Mirrors, KeepParameterLinesInTheRaster) {
    for (const bool metal : {false, true}) {
        Scene scene = scene_from(R"json({ "isoparm": 1, "surfaces": { "S": { "type": "bilinear", "points": [[0,0,0], [1,0,0], [0,1,0], [1,1,0]] } },
            "objects": [{ "surface": "S", "color": "#fff", "isolines": { "u": 3, "v": 3, "width": 4, "opacity": 1 } }, { "point": [0,0,1] }],
            "camera": { "eye": [0.5,0.4,5], "target": [0.5,0.4,0], "up": [0,1,0], "orthographic": 2 }, "image": { "width": 80, "height": 80, "samples": 4 }, "lighting": {} })json");
        if (metal) scene.objects[1].material.kind = Material::Kind::metal;
        RenderOptions options;
        options.vectors = true;
        const Picture p = render(scene, options);
        std::size_t lines = 0;
        for (const DrawnPart& part : p.drawn)
            for (const DrawingItem& item : part.drawing) lines += std::holds_alternative<Polyline>(item.shape);
        EXPECT_EQ(lines > 0, !metal);
        // The line u = 1/2 through the middle of the sheet, on white.
        EXPECT_EQ(p.image.at(40, 28)[0] < 0.1, metal) << p.image.at(40, 28)[0];
    }
}
TEST(Layouts, CameraPrintAndRenderHaveTheSameLettersOnPaper) {
    const Scene scene = scene_from(kPanels);
    RenderOptions options;
    options.width = 400;
    options.printed = true;
    EXPECT_NEAR(layout_of(scene, options).views[0].letter, 6 * options.pixels_per_point, 1e-9) << "at least 6 points";
    options.printed = false;
    EXPECT_LT(layout_of(scene, options).views[0].letter, 6 * options.pixels_per_point);
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
