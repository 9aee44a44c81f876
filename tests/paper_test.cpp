// paper_test.cpp -- figures for print: sizes, anchors, what is drawn over the raster, and that the same figure gives the same bytes.
#include "drawing/paper.h"

#include <json/json.h>

#include <numbers>
#include <regex>

#include "picture/camera.h"
#include "drawing/drawn.h"
#include "expect_program.h"
#include "image/image.h"
#include "drawing/outlines.h"
#include "printed.h"
#include "scene/scene_file.h"
#include "drawing/overlay.h"
#include "drawing/text_cairo.h"

namespace isoparm {
namespace {

using namespace test;

double attribute(const std::string& text, const std::string& pattern) {
    std::smatch m;
    EXPECT_TRUE(std::regex_search(text, m, std::regex(pattern))) << pattern;
    return m.empty() ? NAN : std::stod(m[1]);
}

/// Every element is closed by its own name, attributes are quoted, & and < are escaped.
void expect_well_formed(const std::string& xml) {
    std::vector<std::string> open;
    std::size_t at = xml.find("?>") + 2;
    while ((at = xml.find('<', at)) != std::string::npos) {
        const std::size_t end = xml.find('>', at);
        ASSERT_NE(end, std::string::npos);
        const std::string tag = xml.substr(at + 1, end - at - 1);
        ASSERT_EQ(tag.find('<'), std::string::npos) << tag;
        ASSERT_EQ(std::count(tag.begin(), tag.end(), '"') % 2, 0) << tag;
        const std::string name = tag.substr(tag[0] == '/', tag.find_first_of(" \n/", 1) - (tag[0] == '/'));
        if (tag[0] == '/') {
            ASSERT_FALSE(open.empty());
            ASSERT_EQ(open.back(), name);
            open.pop_back();
        } else if (tag.back() != '/') {
            open.push_back(name);
        }
        at = end;
    }
    EXPECT_TRUE(open.empty());
    for (std::size_t k = xml.find('&'); k != std::string::npos; k = xml.find('&', k + 1)) EXPECT_TRUE(std::regex_search(xml.substr(k, 8), std::regex("^&(amp|lt|gt|quot);")));
}

TEST(Paper, TheWidthInMillimetresAndTheResolutionGiveTheSize) {
    const Printed p;
    const std::string svg = p.file("a.svg", "--width 42mm --dpi 150");
    EXPECT_NEAR(attribute(svg, "width=\"([0-9.]+)mm\""), 42, 1e-2);
    EXPECT_NEAR(attribute(svg, "height=\"([0-9.]+)mm\""), 31.5, 0.1);
    EXPECT_EQ(attribute(svg, "viewBox=\"0 0 ([0-9]+)"), 248);  // 42 / 25.4 * 150
    const double a_point = 150.0 / 72;
    EXPECT_NEAR(attribute(svg, "font-size=\"([0-9.]+)\""), 9 * a_point, 0.03) << "as the scene says, in points";
    EXPECT_NEAR(attribute(svg, "stroke=\"#ff0000\" stroke-width=\"([0-9.]+)\""), a_point, 0.01);
    EXPECT_NEAR(attribute(svg, "stroke=\"#000000\" stroke-width=\"([0-9.]+)\""), 0.5 * a_point, 0.01);
    const std::string pdf = p.file("a.pdf", "--width 42mm --dpi 150");
    EXPECT_NEAR(attribute(pdf, "MediaBox \\[ 0 0 ([0-9.]+)"), 42 / 25.4 * 72, 0.05);
    EXPECT_NEAR(attribute(p.file("b.svg", "--size 300x225"), "width=\"([0-9.]+)mm\""), 25.4, 1e-3) << "300 pixels an inch when nothing is said";
}

TEST(Paper, SvgIsWellFormedWithRealTextAndTheRasterInside) {
    const Printed p;
    const std::string svg = p.file("a.svg");
    expect_well_formed(svg);
    EXPECT_NE(svg.find("<title>A &amp; &lt;B&gt;</title>"), std::string::npos);
    EXPECT_NE(svg.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
    EXPECT_NE(svg.find("font-style=\"italic\">P</tspan>"), std::string::npos);
    EXPECT_NE(svg.find(">00</tspan>"), std::string::npos);
    const std::string outlines = p.file("b.svg", "--text outlines");
    expect_well_formed(outlines);
    EXPECT_EQ(outlines.find("<text"), std::string::npos);
    EXPECT_NE(outlines.find("aria-label=\"P00\""), std::string::npos);
}

TEST(Paper, TheAnchorIsWhereTheRasterHasThePoint) {
    const Printed p;
    const std::string svg = p.file("a.svg");
    std::smatch m;
    ASSERT_TRUE(std::regex_search(svg, m, std::regex("data-anchor=\"([0-9.]+) ([0-9.]+)\"")));
    RenderOptions how;  // the raster that is in the file: without lines and letters
    how.vectors = true;
    const Image image = render(load_scene(p.folder / "scene.json"), how).image;
    double x = 0, y = 0, all = 0;
    for (int j = 0; j < image.height; ++j)
        for (int i = 0; i < image.width; ++i)
            if (const double dark = 0.35 - image.at(i, j)[1]; dark > 0) x += dark * (i + 0.5), y += dark * (j + 0.5), all += dark;
    ASSERT_GT(all, 5);
    EXPECT_NEAR(x / all, std::stod(m[1]), 0.5);
    EXPECT_NEAR(y / all, std::stod(m[2]), 0.5);
}

TEST(Paper, SvgHasNoControlCharacters) {
    const Printed p(R"({ "isoparm": 1, "title": "a\u0001b\u001fc", "objects": [ { "point": [0,0,0] } ], "image": { "width": 32, "height": 24, "samples": 1 } })");
    const std::string svg = p.file("a.svg");
    EXPECT_NE(svg.find("<title>a b c</title>"), std::string::npos);
    EXPECT_TRUE(std::none_of(svg.begin(), svg.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\n'; }));
}
TEST(Paper, PdfEmbedsTheFontsOfItsLetters) {
    const Printed p;
    EXPECT_NE(p.file("a.pdf").find("/FontFile"), std::string::npos);
    const std::string outlines = p.file("b.pdf", "--text outlines");
    EXPECT_EQ(outlines.find("/FontFile"), std::string::npos);
    EXPECT_EQ(outlines.find("CreationDate"), std::string::npos);
}

TEST(Paper, TheSameFigureGivesTheSameBytes) {
    const Printed p;
    for (const char* format : {"pdf", "svg", "tex"}) {
        const std::string name = std::string("a.") + format, other = std::string("b.") + format;
        EXPECT_TRUE(p.file(name) == p.file(name, "--threads 2")) << format;
    }
}

TEST(Paper, WhatCannotBeIsRefused) {
    const Printed p;
    for (const auto& [arguments, code, message] : {std::tuple<std::string, int, std::string>{"-o a.pdf --width 84", 64, "found \"84\", expected a width from 1mm to 2000mm with a unit"},
                                                   {"-o a.pdf --width 84furlong", 64, "with a unit"}, {"-o a.pdf --width 0mm", 64, "from 1mm"}, {"-o a.pdf --width 1e9mm", 64, "2000mm"},
                                                   {"-o a.pdf --width nanmm", 64, "from 1mm"}, {"-o a.pdf --width 2000mm --dpi 1200", 64, "expected 16 to 32768"},
                                                   {"-o a.pdf --width 84mm --size 10x10", 64, "one of them"}, {"-o a.pdf --dpi 1", 64, "10 to 4800"}, {"-o a.pdf --font-size 0pt", 64, "such as 8pt"},
                                                   {"-o a.pdf --aov N", 64, ".exr"}, {"-o a.png --text outlines", 64, ".pdf or .svg"}, {"-o a.tex --text outlines", 64, ".pdf or .svg"},
                                                   {"-o missing/a.pdf", 4, "cannot be written"}, {"-o a.svg --camera scene.json", 65, "isoparm"}}) {
        const Outcome r = p.refused(arguments);
        EXPECT_EQ(r.code, code) << arguments << r.err;
        EXPECT_NE(r.err.find(message), std::string::npos) << arguments << ": " << r.err;
    }
    EXPECT_EQ(p.folder.files(), 1u) << "nothing was written";
}

TEST(Paper, ACameraIsPrintedAndShared) {
    const Printed p(R"({ "isoparm": 1, "surfaces": { "s": { "type": "bilinear", "points": [[[-1,-1,0],[-1,1,0]],[[1,-1,0],[1,1,0]]] } },
        "objects": [ { "surface": "s" }, { "point": [0,0,1], "dot": 3, "label": "A" } ], "image": { "width": 120, "height": 90, "samples": 4 } })");
    const Outcome r = test::run("camera print scene.json", p.folder.path());
    ASSERT_EQ(r.code, 0) << r.err;
    write_all(p.folder / "camera.json", r.out);
    p.file("a.png");
    p.file("b.png", "--camera camera.json");
    const Outcome d = test::run("diff a.png b.png -fail 0.01", p.folder.path());
    EXPECT_EQ(d.code, 0) << d.out << d.err;
}

TEST(Paper, FiguresOfPanelsHaveLettersThatCanBeRead) {
    const TemporaryFolder folder;
    const Outcome r = test::run("figures s004_bbg_lines --format svg --samples 1 --width 84mm --dpi 72 --tolerance 1e-2rel --quiet -o out", folder.path());
    ASSERT_EQ(r.code, 0) << r.err;
    const std::string svg = read_all(folder / "out/s004_bbg_lines.svg");
    expect_well_formed(svg);
    EXPECT_EQ(attribute(svg, "viewBox=\"0 0 ([0-9]+)"), 238);
    const std::regex size("<text[^>]*><tspan[^>]*font-size=\"([0-9.]+)\"");
    int texts = 0;
    for (std::sregex_iterator m(svg.begin(), svg.end(), size), end; m != end; ++m, ++texts) EXPECT_GE(std::stod((*m)[1]), 5.99) << "points: 72 pixels an inch";
    EXPECT_GE(texts, 10);
    EXPECT_EQ(test::run("figures s004_bbg_lines --format doc -o out", folder.path()).code, 64);
}

// ---- outlines and parameter lines --------------------------------------------------------------------------------------------

Camera from_the_side(const Scene& scene) { return make_camera(scene.camera, drawn_points(scene), scene.image.width, scene.image.height); }

TEST(Outlines, OfASphereIsTheCircleThatConesTouch) {
    // From the distance d the contour of the unit sphere is the circle of radius sqrt(1 - 1/d^2) in the plane 1/d before its middle.
    const Scene scene = load_scene(source_folder() + "/scenes/sphere.json");
    const Surface& sphere = *scene.find_surface("sphere");
    CameraSettings settings;
    settings.eye = Point{2, -2.2, 1.5};
    settings.target = Point{0, 0, 0};
    const Camera camera = make_camera(settings, {}, 320, 240);
    const double d = length(*settings.eye);
    double seen = 0;
    const auto lines = outline_of(sphere.patches, camera, 3.5, true);
    for (const auto& line : lines)
        for (std::size_t i = 0; i < line.size(); ++i) {
            EXPECT_NEAR(dot(line[i], *settings.eye) / d, 1 / d, 1e-6);
            if (i > 0) seen += distance(line[i], line[i - 1]);
        }
    EXPECT_NEAR(seen, 2 * std::numbers::pi * std::sqrt(1 - 1 / (d * d)), 0.01);
}

TEST(Outlines, OfACubeHaveTheEdgesBetweenFacesOfEitherSide) {
    const Scene scene = scene_from(R"({ "isoparm": 1, "surfaces": { "cube": { "type": "subdivision", "scheme": "bilinear",
        "vertices": [[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0,0,1],[1,0,1],[1,1,1],[0,1,1]],
        "faces": [[3,2,1,0],[4,5,6,7],[0,1,5,4],[1,2,6,5],[2,3,7,6],[3,0,4,7]] } }, "objects": [ { "surface": "cube" } ],
        "camera": { "eye": [4,5,6], "target": [0.5,0.5,0.5], "orthographic": 3 }, "image": { "width": 200, "height": 200 } })");
    double whole = 0;
    for (const auto& line : outline_of(scene.surfaces[0].patches, from_the_side(scene), 1.7, true))
        for (std::size_t i = 1; i < line.size(); ++i) whole += distance(line[i], line[i - 1]);
    EXPECT_NEAR(whole, 6, 0.1) << "six edges of the hexagon";
}

TEST(Outlines, OfAnOpenSheetAreItsBorders) {
    Scene scene = from_above(4, 100, 100, 1);
    add_sheet(scene, 0, 1);
    double whole = 0;
    for (const auto& line : outline_of(scene.surfaces[0].patches, from_the_side(scene), 2.8, true))
        for (std::size_t i = 1; i < line.size(); ++i) whole += distance(line[i], line[i - 1]);
    EXPECT_NEAR(whole, 8, 1e-9);
    EXPECT_TRUE(outline_of(scene.surfaces[0].patches, from_the_side(scene), 2.8, false).empty());
}

TEST(ParameterLines, EndWhereASurfaceHidesThem) {
    // A sheet over -1 <= x <= 1 hides the middle of a larger one's line y = 0 from above: the cuts are at -1 and 1.
    Scene scene = from_above(4, 400, 400, 1);
    SceneObject& large = add_sheet(scene, 0, 1);
    scene.surfaces[0].patches = {{"large", make_bezier_patch({{{-1.8, -1.8, 0}, {-1.8, 1.8, 0}}, {{1.8, -1.8, 0}, {1.8, 1.8, 0}}})}};
    large.isolines.v = 1;
    add_sheet(scene, 1, 1);
    RenderOptions how;
    how.vectors = true;
    const Picture picture = render(scene, how);
    ASSERT_EQ(picture.drawn.at(0).drawing.size(), 1u);
    const Polyline& line = std::get<Polyline>(picture.drawn[0].drawing[0].shape);
    ASSERT_EQ(line.more.size(), 1u) << "two pieces, drawn as one";
    EXPECT_NEAR(line.points.front().x, 20, 1e-6);
    EXPECT_NEAR(line.points.back().x, 100, 0.1);
    EXPECT_NEAR(line.more[0].front().x, 300, 0.1);
    EXPECT_NEAR(line.more[0].back().x, 380, 1e-6);
    for (const auto& p : line.points) EXPECT_NEAR(p.y, 200, 1e-6);
}

TEST(ParameterLines, EndWhereASurfaceInTheirPlaneLiesOverThem) {
    // As above, but in the same plane: what is listed later covers lines and borders, what is listed before does not.
    for (const bool later : {true, false})
        for (const bool exact : {false, true}) {
            Scene scene = from_above(4, 400, 400, 1);
            add_sheet(scene, 0, 1);
            SceneObject& large = add_sheet(scene, 0, 1);
            scene.surfaces[1].patches = {{"large", make_bezier_patch({{{-1.8, 0.5, 0}, {-1.8, 1.8, 0}}, {{1.8, 0.5, 0}, {1.8, 1.8, 0}}})}};
            large.outline.line.width = 2;
            large.label.text = parse_math_text("L"), large.label.at_uv = Vec2{0.5, 0.1}, large.label.hidden = Hidden::hide;
            if (later) std::swap(scene.objects[0], scene.objects[1]);
            RenderOptions how;
            how.vectors = true, how.exact = exact;
            const Picture picture = render(scene, how);
            const Drawing& drawing = picture.drawn.at(0).drawing;
            const auto& line = std::get<Polyline>(drawing.at(0).shape);
            double length = 0;
            auto all = line.more;
            all.push_back(line.points);
            for (const auto& points : all)
                for (std::size_t i = 1; i < points.size(); ++i) length += std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
            EXPECT_NEAR(length, later ? 980 - 200 : 980, 2.5) << later << exact;
            EXPECT_EQ(drawing.size(), later ? 1u : 2u) << "the label at a place that is covered";
        }
}

/// Lengths of the lines that are drawn, in pixels.
double drawn_length(const std::string& objects, const std::string& more_surfaces = "") {
    const Scene scene = parse_scene(R"({"isoparm": 1, "surfaces": {
        "table": {"type": "bilinear", "points": [[-3,-3,0],[3,-3,0],[-3,3,0],[3,3,0]]}, "decal": {"type": "bilinear", "points": [[2,2,0],[2.5,2,0],[2,2.5,0],[2.5,2.5,0]]},
        "front": {"type": "bilinear", "points": [[-1,-1,0],[1,-1,0],[-1,-1,1],[1,-1,1]]}, "bottom": {"type": "bilinear", "points": [[-1,-1,0],[1,-1,0],[-1,1,0],[1,1,0]]},
        "box": {"type": "composite", "members": ["front", "bottom"]})" + more_surfaces + R"(}, "objects": [)" + objects + R"(],
        "camera": {"eye": [0.5,-9,5], "target": [0,0,0], "up": [0,0,1], "fov": 50}, "image": {"width": 400, "height": 300, "samples": 1}})", "s.json");
    RenderOptions how;
    how.vectors = true;
    double length = 0;
    const Picture picture = render(scene, how);
    for (const DrawingItem& item : picture.drawn.at(0).drawing) {
        const Polyline& line = std::get<Polyline>(item.shape);
        auto all = line.more;
        all.push_back(line.points);
        for (const auto& points : all)
            for (std::size_t i = 1; i < points.size(); ++i) length += std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
    }
    return length;
}
std::string outlined(const char* surface) { return R"({"surface": ")" + std::string(surface) + R"(", "boundary": false, "outline": true})"; }
std::string plain_one(const char* surface) { return R"({"surface": ")" + std::string(surface) + R"(", "boundary": false})"; }

TEST(ParameterLines, OfABorderAreSeenWhereTheirSurfaceIs) {
    // A box whose bottom lies in a table that is listed later: the front's lower edge stays. So does that of a floor at a wall, and of neighbours in one plane, whatever else lies in their planes.
    const double box = drawn_length(outlined("box"));
    EXPECT_NEAR(drawn_length(plain_one("table") + "," + outlined("box")), box, 1.5);
    const double front = drawn_length(outlined("front"));
    EXPECT_NEAR(drawn_length(outlined("box") + "," + plain_one("table")), front, 1.5) << "the bottom's other edges are covered by the table";
    const std::string more = R"(, "one": {"type": "bezier", "points": [[[-1,-2,0],[-1,0,0],[-1,2,0]],[[0,-2,0],[0.8,0,0],[0,2,0]]]}, "two": {"type": "bezier", "points": [[[0,-2,0],[0.8,0,0],[0,2,0]],[[1.5,-2,0],[1.5,0,0],[1.5,2,0]]]}, "wall": {"type": "bilinear", "points": [[-3,3,0],[3,3,0],[-3,3,1],[3,3,1]]}, "on_wall": {"type": "bilinear", "points": [[1,3,0.2],[2,3,0.2],[1,3,0.7],[2,3,0.7]]},
        "sheet": {"type": "bilinear", "points": [[-1,-1,0.002],[1,-1,0.002],[-1,1,0.002],[1,1,0.002]]})";
    EXPECT_NEAR(drawn_length(outlined("one") + "," + plain_one("two"), more), drawn_length(outlined("one"), more), 1.5);
    EXPECT_NEAR(drawn_length(outlined("table") + "," + plain_one("wall") + "," + plain_one("on_wall"), more), drawn_length(outlined("table"), more), 1.5);
    EXPECT_NEAR(drawn_length(outlined("sheet") + "," + plain_one("table") + "," + plain_one("decal"), more), drawn_length(outlined("sheet"), more), 1.5) << "what lies beneath covers nothing";
}

TEST(ParameterLines, AsVectorsLookLikeTheTracersOwn) {
    // The mean of a band across a line: what the tracer paints and what is drawn over the raster darken it alike.
    Scene scene = from_above(3, 300, 300, 16);
    SceneObject& sheet = add_sheet(scene, 0, 1);
    sheet.isolines = {3, 3, 4, {0, 0, 0}, 0.5};
    Scene plain = scene;
    plain.objects[0].isolines = {};
    const double bare = sum(render(plain, {}).image, 1), traced = bare - sum(render(scene, {}).image, 1);
    RenderOptions how;
    how.vectors = true;
    Picture picture = render(scene, how);
    double length_of_lines = 0;
    for (const DrawingItem& item : picture.drawn.at(0).drawing) {
        const Polyline& line = std::get<Polyline>(item.shape);
        auto all = line.more;
        all.push_back(line.points);
        for (const auto& points : all)
            for (std::size_t i = 1; i < points.size(); ++i) length_of_lines += std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
        EXPECT_EQ(item.opacity, 0.5);
    }
    EXPECT_NEAR(length_of_lines, 6 * 200, 1);
    EXPECT_GT(traced, 0);
    // Inside the sheet the tracer paints two whole lines and four halves: the sheet ends there.
    const double bright = bare / (200 * 200);
    EXPECT_NEAR(traced, 0.5 * bright * 4 * (2 * 200 + 4 * 200 / 2.0), 0.1 * traced);
}

TEST(Paper, TubesAreAsWideInPointsAsTheySay) {
    // A rod along x and a ball, seen by a camera that is no nearer to them than it likes: width is that on paper.
    const TemporaryFolder t;
    const auto covered = [&](const std::string& radius, const std::string& size, const std::string& camera) {
        write_all(t / "s.json", R"({"isoparm": 1, "curves": {"c": {"type": "line", "points": [[-1,0,0], [1,0,0]]}}, "objects": [{"curve": "c", "radius": )" + radius + R"(, "color": "black"}],
            "camera": )" + camera + R"(, "image": {"width": 300, "height": 200, "samples": 16, "background": "white"}})");
        const Outcome o = run("render s.json -o p.png " + size, t.path());
        EXPECT_EQ(o.code, 0) << o.err;
        const Image image = read_image(t / "p.png");
        double dark = 0;  // of the middle column
        for (int y = 0; y < image.height; ++y) dark += 1 - image.pixels[4 * (static_cast<std::size_t>(y) * image.width + image.width / 2)];
        return dark;
    };
    const double pixels = 2 * 3 * 144 / 72.0;  // a radius of 3 points at 144 pixels an inch
    for (const std::string camera : {R"({"eye": [0,-5,0], "target": [0,0,0]})", R"({"eye": [0,-20,0], "target": [0,0,0], "fov": 10})", R"({"eye": [0,-5,0], "target": [0,0,0], "orthographic": 2})"}) {
        const double dark = covered("\"3pt\"", "--width 4in --dpi 144", camera);
        EXPECT_NEAR(dark, pixels, 0.1 * pixels) << camera;  // its highlights are not black
        EXPECT_NEAR(covered("\"3pt\"", "--width 4in --dpi 72", camera), dark / 2, 0.05 * dark) << camera;
    }
    for (const std::string wrong : {"\"0pt\"", "\"-1pt\"", "0"}) {
        write_all(t / "s.json", R"({"isoparm": 1, "objects": [{"point": [0,0,0], "radius": )" + wrong + "}]}");
        const Outcome o = run("render s.json -o p.png", t.path());
        EXPECT_EQ(o.code, 65) << o.err;
        EXPECT_NE(o.err.find("expected a positive radius in scene units, or in points"), std::string::npos) << o.err;
    }
}

}  // namespace
}  // namespace isoparm
