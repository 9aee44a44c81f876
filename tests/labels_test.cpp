// labels_test.cpp -- texts, where labels stand, and how they are painted.
#include "drawing/labels.h"

#include <map>
#include <numbers>

#include "picture/camera.h"
#include "drawing_tests.h"
#include "drawing/drawn.h"
#include "error.h"
#include "drawing/flat_lines.h"
#include "picture/layout.h"
#include "drawing/overlay.h"
#include "picture/palette.h"
#include "drawing/paint.h"
#include "drawing/text_cairo.h"

namespace isoparm {
namespace {

using namespace test;

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
TEST(MathText, TexGetsFormulasWhole) {
    for (const auto& [text, tex] : {std::pair<std::string, std::string>{"$x-y=-1$, $a \\to b$", "$x-y=-1$, $a\\,\\rightarrow \\,b$"}, {"$\\sum_{i=0}^n B_i(t)$ and prose", "$\\sum _{i=0}^{n}\\,B_{i}(t)$ and prose"},
                                    {"\\sin\\theta", "$\\operatorname{sin}\\theta $"}, {"\\mathrm{d}x", "$\\mathrm{d}x$"}, {"\\hat{\\mathrm{a}}\\mathrm{b}", "$\\hat{\\mathrm{a}}\\mathrm{b}$"}, {"two words", "two words"}})
        EXPECT_EQ(tex_of(parse_math_text(text)), tex) << text;
}
TEST(MathText, FractionsStandInOneLineWithTheBracketsThatTheyNeed) {
    for (const auto& [text, shown] : {std::pair<std::string, std::string>{"\\frac{1}{2}", "1/2"}, {"\\frac12", "1/2"}, {"\\frac{10}{x_{i+1}}", "10/xi+1"}, {"\\frac{u+v}{2\\pi}", "(u+v)/(2π)"}, {"\\frac{ab}{c}", "ab/c"},
                                      {"\\frac{\\partial S}{\\partial u}", "∂\u2009S/∂\u2009u"}, {"\\frac{\\frac{1}{2}}{\\hat{x}}", "(1/2)/x\u0302"}, {"\\frac{\\sqrt{2}}{2}", "√2/2"}})
        EXPECT_EQ(plain(parse_math_text(text)), shown) << text;
}
TEST(MathText, AccentsAlphabetsAndSigns) {
    for (const auto& [text, shown] : {std::pair<std::string, std::string>{"\\hat{n}", "n\u0302"}, {"\\vec n_1", "n\u20d71"}, {"\\overline{AB}", "A\u0305B\u0305"}, {"\\mathbb{R}^3", "ℝ3"}, {"\\mathcal{AB}", "𝒜ℬ"},
                                      {"\\left(x\\right)", "(x)"}, {"\\left.x\\right|", "x|"}, {"\\|x\\|\\,\\{1\\}", "∥x∥\u2009{1}"}, {"\\text{if } u\\leq v", "if \u2009u≤\u2009v"}, {"5 \\$ and $x$", "5 $ and x"}, {"\\operatorname{rot} \\mathit{a}", "rot\u2009a"}})
        EXPECT_EQ(plain(parse_math_text(text)), shown) << text;
    EXPECT_TRUE(parse_math_text("\\boldsymbol{S}").at(0).bold);
    EXPECT_FALSE(parse_math_text("\\mathbb{R}x").at(0).italic);
    EXPECT_TRUE(parse_math_text("\\mathbb{R}x").at(1).italic);
    // An accent takes no room of its own.
    EXPECT_NEAR(text_box(parse_math_text("\\hat{n}"), 100).advance, text_box(parse_math_text("n_{}{}"), 100).advance, 3);
}
TEST(MathText, FaultsSayWhere) {
    for (const auto& [text, offset] : {std::pair<std::string, std::size_t>{"P_{0", 2}, {"\\frac{1}", 7}, {"\\hat", 3}, {"\\text x", 4}, {"a\\", 1}, {"\\frac{1}{\\alhpa}", 9}, {"\\sqrt{x", 5}, {"\\sqrt[3{x}", 5}, {"\\hat{\\sqrt{x}}", 5}, {"P_", 1}, {"a}", 1}, {"x \\alhpa", 2}, {"a $b", 2}}) {
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

TEST(Labels, FarFromWhatTheyNameHaveLeaders) {
    // Obstacles all around the anchor: the label stands beyond them, and a line leads to the ball's rim.
    std::vector<Obstacle> crowd;
    for (int x = -50; x <= 50; x += 4)
        for (int y = -50; y <= 50; y += 4)
            if (std::hypot(x, y) > 6) crowd.push_back({{200.0 + x, 200.0 + y}, 2});
    Label label;
    label.text = parse_math_text("P_{00}");
    const auto placed = [&](const std::vector<Obstacle>& obstacles) {
        Drawing d;
        place_labels({{&label, -1, {{{200, 200}, 1, {}, 5}}, 20, {0, 0, 0}}}, obstacles, 400, 400, d);
        return d;
    };
    EXPECT_EQ(placed({}).size(), 1u) << "beside it";
    const Drawing d = placed(crowd);
    ASSERT_EQ(d.size(), 2u);
    const auto& line = std::get<Polyline>(d[0].shape).points;
    EXPECT_NEAR(std::hypot(line[1].x - 200, line[1].y - 200), 5 + 0.08 * 20, 1e-9);
    EXPECT_GT(std::hypot(line[0].x - 200, line[0].y - 200), 40);
    label.leader = false;
    EXPECT_EQ(placed(crowd).size(), 1u) << "not wanted";
    label.leader = true;
    EXPECT_EQ(placed({}).size(), 2u) << "wanted in any case";
}
// What leaves no room but 1.2 ems away has the label there, 1.8 letter heights: a leader. Nearer ones need none, and a curve that passes nearby is near enough.
TEST(Labels, MoreThanOneAndAHalfLetterHeightsAwayHaveLeadersToo) {
    Label label;
    label.text = parse_math_text("A");
    const double size = 20;
    const auto placed = [&](double crowd, const std::vector<Anchor>& anchors) {
        std::vector<Obstacle> obstacles;  // a disc about the anchor
        for (double x = -crowd; x <= crowd; x += 2)
            for (double y = -crowd; y <= crowd; y += 2)
                if (std::hypot(x, y) <= crowd) obstacles.push_back({{200 + x, 200 + y}, 1});
        Drawing d;
        place_labels({{&label, -1, anchors, size, {0, 0, 0}}}, obstacles, 400, 400, d);
        return d;
    };
    const auto gap_of = [&](const DrawingItem& item) {
        const Text& t = std::get<Text>(item.shape);
        const TextBox box = text_box(t.text, t.size);
        return std::hypot(std::max({t.at.x + box.left - 200, 200 - t.at.x - box.right, 0.0}), std::max({t.at.y + box.top - 200, 200 - t.at.y - box.bottom, 0.0}));
    };
    const Drawing near = placed(0.4 * size, {{{200, 200}, 1, {}, 0}}), away = placed(0.95 * size, {{{200, 200}, 1, {}, 0}});
    ASSERT_EQ(near.size(), 1u);
    EXPECT_LT(gap_of(near[0]), size);
    ASSERT_EQ(away.size(), 2u);
    EXPECT_GT(gap_of(away[1]), size);
    EXPECT_LT(gap_of(away[1]), 1.5 * size) << "no farther than it has to";
    label.leader = false;
    EXPECT_EQ(placed(0.95 * size, {{{200, 200}, 1, {}, 0}}).size(), 1u);
}
// A point, a ball and a line over the numbers of a diagram: they stand beside them.
TEST(Overlay, NumbersOfAxesKeepOffWhatIsDrawn) {
    const auto numbers = [](const std::string& objects, double line = 0) {
        const Scene scene = scene_from(R"({ "isoparm": 1, "curves": { "line": { "type": "line", "points": [[0.3,)" + std::to_string(line) + ",0],[4.4," + std::to_string(line) + R"(,0]] } },
            "objects": [ { "axes": { "x": [0, 4], "y": [0, 3], "ticks": { "x": true, "y": false } }, "line": 1.5 })" + objects + R"(], "camera": { "eye": [2,1.2,9], "target": [2,1.2,0], "up": [0,1,0], "orthographic": 4.4 }, "image": { "width": 600, "height": 450 } })");
        RenderOptions options;
        options.vectors = true, options.samples = 1;
        std::map<std::string, std::array<double, 4>> boxes;
        const Picture picture = render(scene, options);
        for (const DrawingItem& item : picture.drawn.at(0).drawing)
            if (const auto* t = std::get_if<Text>(&item.shape)) {
                const TextBox b = text_box(t->text, t->size);
                boxes[plain(t->text)] = {t->at.x + b.left, t->at.y + b.top, t->at.x + b.right, t->at.y + b.bottom};
            }
        return std::pair(boxes, make_camera(scene.camera, {}, 600, 450));
    };
    const auto [free, camera] = numbers("");
    for (const char* n : {"1", "2", "3", "4"}) ASSERT_TRUE(free.contains(n)) << n;
    const Vec2 two = camera.project({2, 0, 0});
    EXPECT_NEAR(0.5 * (free.at("2")[0] + free.at("2")[2]), two.x, 1) << "below its tick, where nothing is in the way";
    EXPECT_GT(free.at("2")[1], two.y);
    const double radius = 0.22;  // over the number of 2
    const Vec2 middle{0.5 * (free.at("2")[0] + free.at("2")[2]), 0.5 * (free.at("2")[1] + free.at("2")[3])};
    const Point there{2, (two.y - middle.y) * camera.pixel_size(9), 0};
    for (const std::string ball : {R"("radius": 0.22)", R"("dot": 45)"}) {
        const auto [beside, same] = numbers(", { \"point\": [" + std::to_string(there.x) + "," + std::to_string(there.y) + ",0], " + ball + " }");
        const auto& b = beside.at("2");
        const double clear = std::hypot(std::max({b[0] - middle.x, 0.0, middle.x - b[2]}), std::max({b[1] - middle.y, 0.0, middle.y - b[3]}));
        EXPECT_GT(clear, 0.97 * radius / camera.pixel_size(9)) << ball;
        EXPECT_EQ(beside.at("4"), free.at("4")) << "the others stay";
    }
    const auto [off, same] = numbers(R"(, { "curve": "line", "line": 3 })", there.y);
    const double y = middle.y;
    for (const char* n : {"1", "2", "3", "4"}) {
        EXPECT_TRUE(free.at(n)[1] < y && free.at(n)[3] > y) << n << " would be crossed";
        EXPECT_TRUE(off.at(n)[1] > y + 1.5 || off.at(n)[3] < y - 1.5) << n;
    }
}
TEST(Labels, WithLeadersAreNotFaintButTheirLinesDashed) {
    Label label;
    label.text = parse_math_text("A");
    label.leader = true;
    Drawing d;
    place_labels({{&label, -1, {{{200, 200}, 0, {}, 5}}, 20, {0, 0, 0}}}, {}, 400, 400, d);
    ASSERT_EQ(d.size(), 2u);
    EXPECT_EQ(d[1].opacity, 1);
    EXPECT_FALSE(std::get<Polyline>(d[0].shape).dash.empty());
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

// A sheet, 4 wide, behind a board that is 2 wide and hides its middle.
TEST(Labels, OfSurfacesStandWhereTheyAreSeen) {
    const Scene scene = scene_from(R"({ "isoparm": 1, "surfaces": { "sheet": { "type": "bilinear", "points": [[-2,0,-1],[2,0,-1],[-2,0,1],[2,0,1]] },
        "board": { "type": "bilinear", "points": [[-1,-1,-2],[1,-1,-2],[-1,-1,2],[1,-1,2]] } },
        "objects": [ { "surface": "sheet", "label": "S" }, { "surface": "board" } ], "camera": { "eye": [0.5,-9,0.5], "target": [0,0,0], "fov": 40 } })");
    const Camera camera = make_camera(scene.camera, {}, 480, 320);
    const Drawing d = overlay(scene, scene.objects, build_traced_scene(scene, 1e-2, {}), camera, 1, 8);
    ASSERT_EQ(d.size(), 1u);
    EXPECT_EQ(d[0].opacity, 1);
    const auto& text = std::get<Text>(d[0].shape);
    ASSERT_TRUE(text.anchor);
    const auto x_of = [&](double x, double y) { return camera.project({x, y, 0}).x; };
    const bool left = text.anchor->x > x_of(-2, 0) && text.anchor->x < x_of(-1, -1), right = text.anchor->x < x_of(2, 0) && text.anchor->x > x_of(1, -1);
    EXPECT_TRUE(left || right) << text.anchor->x;
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
    paint({{Filled{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}}, {0.5, 0, 0}, 0.25}}, image.width, image.height, 0, 0, image);
    EXPECT_NEAR(image.at(1, 0)[0], 0.25 * 0.5 + 0.75, 1e-6);
    EXPECT_NEAR(image.at(1, 0)[1], 0.75, 1e-6);
    EXPECT_EQ(image.at(1, 0)[3], 1);
    EXPECT_NEAR(image.at(1, 3)[0], 0.125, 1e-6);  // premultiplied
    EXPECT_NEAR(image.at(1, 3)[3], 0.25, 1e-6);
}
TEST(Paint, CoversTheAreaThatGeometryHas) {
    Image image{40, 30, std::vector<float>(4800, 0)};
    paint({{Filled{{{3.25, 4.5}, {33.25, 4.5}, {3.25, 24.5}}}, {1, 1, 1}, 1}}, image.width, image.height, 0, 0, image);
    EXPECT_NEAR(sum(image, 3), 300, 0.02 * 300);  // Cairo counts in 255ths and samples each pixel 15 x 17 times
    Image line{40, 30, std::vector<float>(4800, 0)};
    paint({{Polyline{{{5.3, 15.2}, {35.3, 15.2}}, 2.5, {}, false}, {1, 1, 1}, 1}}, line.width, line.height, 0, 0, line);
    EXPECT_NEAR(sum(line, 3), 75, 0.02 * 75);
}
TEST(Paint, APartHasTheBitsOfTheWhole) {
    Drawing drawing{{Polyline{{{3.3, -8.7}, {71.6, 55.2}, {20.1, 90}}, 3.3, {7, 3}, true}, {0.7, 0.1, 0.1}, 0.8},
                    {Polyline{{{-20.7, 30.3}, {120.2, 12.9}}, 1.7, {}, false}, {0.1, 0.1, 0.1}, 1},
                    {Filled{{{10.3, 10.2}, {60.7, 22.8}, {33.1, 58.4}}}, {0, 0, 0.5}, 0.5},
                    {Text{{8.3, 40.6}, 30, parse_math_text("P_{21}"), 3}, {0, 0, 0}, 1}};
    Image whole{80, 60, std::vector<float>(4 * 80 * 60, 0.25f)};
    paint(drawing, 80, 60, 0, 0, whole);
    for (const auto& [x, y, width, height] : {std::array{13, 7, 40, 30}, std::array{41, 20, 39, 40}, std::array{20, 30, 1, 1}}) {
        Image part{width, height, std::vector<float>(4 * static_cast<std::size_t>(width * height), 0.25f)};
        paint(drawing, 80, 60, x, y, part);
        for (int row = 0; row < height; ++row) EXPECT_TRUE(std::equal(part.at(0, row), part.at(0, row) + 4 * width, whole.at(x, y + row))) << x << " " << y + row;
    }
}
TEST(Text, AccentsStandAboveCapitalsToo) {
    for (const std::string accent : {"hat", "bar", "vec", "tilde", "dot"})
        for (const std::string letter : {"P", "S", "N", "x", "n", "l"}) {
            const TextBox plain = text_box(parse_math_text("$" + letter + "$"), 100), with = text_box(parse_math_text("$\\" + accent + "{" + letter + "}$"), 100);
            EXPECT_LT(with.top, plain.top - 5) << accent << letter;
            EXPECT_GT(with.top, plain.top - 45) << accent << letter;
            EXPECT_EQ(with.bottom, plain.bottom) << accent << letter;
            // What the letter covers is the letter alone.
            const Coverage letters = coverage(Text{{50, 150}, 100, parse_math_text("$" + letter + "$")}, 0, 200, 200), both = coverage(Text{{50, 150}, 100, parse_math_text("$\\" + accent + "{" + letter + "}$")}, 0, 200, 200);
            double below = 0;
            const int top = static_cast<int>(150 + plain.top + 1);
            for (int y = top; y < 150; ++y)
                for (int x = 0; x < 200; ++x) {
                    const auto of = [&](const Coverage& c) { return x >= c.x0 && x < c.x0 + c.width && y >= c.y0 && y < c.y0 + c.height ? c.part[static_cast<std::size_t>((y - c.y0) * c.width + x - c.x0)] / 255.0 : 0; };
                    below += std::fabs(of(both) - of(letters));
                }
            EXPECT_LT(below, 1) << accent << letter;
        }
}
TEST(Overlay, AxesTowardTheEyeEndWhereOthersDo) {
    // Seen from above in perspective: an overhang in pixels, wherever the axis runs.
    Scene scene = from_above(4, 400, 300, 1);
    scene.camera.orthographic = {};
    scene.camera.fov = 60;
    SceneObject& o = add(scene, Kind::axes);
    o.axes.origin = {1.5, -1.5, 0};
    for (auto& axis : o.axes.axis) axis = Axes::Axis{};
    o.axes.axis[0]->low = -1.5, o.axes.axis[0]->high = 2;
    o.axes.axis[1]->low = -1.5, o.axes.axis[1]->high = 2;
    o.axes.axis[2]->low = -2, o.axes.axis[2]->high = 7;
    RenderOptions options;
    options.vectors = true;
    const Picture p = render(scene, options);
    const Camera camera = make_camera(scene.camera, drawn_points(scene), 400, 300);
    std::vector<Vec2> ends;
    for (const Point& end : {Point{2, -1.5, 0}, Point{1.5, 2, 0}, Point{1.5, -1.5, 7}}) ends.push_back(camera.project(end));
    int heads = 0;
    for (const DrawingItem& item : p.drawn.at(0).drawing)
        if (const auto* head = std::get_if<Filled>(&item.shape)) {
            double nearest = 1e9;
            for (const Vec2& e : ends) nearest = std::min(nearest, std::hypot(head->outline[0].x - e.x, head->outline[0].y - e.y));
            EXPECT_NEAR(nearest, 34 / 27.648 * layout_of(scene, options).views.at(0).letter, 0.01);
            ++heads;
        }
    EXPECT_EQ(heads, 3);
}
TEST(Overlay, OnADarkBackgroundInkIsLightAndRimsAreDark) {
    for (const bool dark : {false, true}) {
        Scene scene = from_above(4, 100, 100, 1);
        scene.image.background = dark ? Color{0.02, 0.03, 0.05} : Color{1, 1, 1};
        SceneObject& o = add(scene, Kind::point);
        o.line.width = 4;
        o.label.text = parse_math_text("P");
        SceneObject& own = add(scene, Kind::point);
        own.point = {1, 0, 0}, own.line.width = 4;
        own.label.text = parse_math_text("Q"), own.label.color = Color{0.5, 0, 0};
        RenderOptions options;
        options.vectors = true;
        int texts = 0;
        const Picture p = render(scene, options);
        for (const DrawingItem& item : p.drawn.at(0).drawing)
            if (const auto* text = std::get_if<Text>(&item.shape)) {
                const bool first = plain(text->text) == "P";
                EXPECT_EQ(item.color.x, first ? dark ? 0.9 : ink_color().x : 0.5);
                if (first) { EXPECT_EQ(text->rim.z, scene.image.background->z); }
                ++texts;
            }
        EXPECT_EQ(texts, 2);
    }
}

}  // namespace
}  // namespace isoparm
