#include "scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "error.h"
#include "run_program.h"
#include "scene/json.h"
#include "scene/scene_values.h"

namespace isoparm {
namespace {

using test::TemporaryFolder;

Scene load(const std::string& text, const std::map<std::string, double>& overrides = {}) {
    const TemporaryFolder t;
    test::write_all(t / "scene.json", text);
    return load_scene(t / "scene.json", overrides);
}
const Patch& patch(const Scene& scene, const std::string& name) { return scene.find_surface(name)->patches.at(0).patch; }
Scene shipped(const std::string& name) { return load_scene(test::source_folder() + "/scenes/" + name + ".json"); }

void expect_near(const Point& a, const Point& b, double tolerance = 1e-14) {
    EXPECT_LE(distance(a, b), tolerance) << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

// ---- values ---------------------------------------------------------------------------------------------------------

TEST(Scene, EveryCurveTypeIsBuilt) {
    const Scene s = load(R"json({ "isoparm": 1, "curves": {
        "line": { "type": "line", "points": [[0,0,0], [2,0,0]] },
        "bezier": { "type": "bezier", "points": [[1,0,0], [1,1,0], [0,1,0]], "weights": [1, "sqrt(2)/2", 1] },
        "bspline": { "type": "bspline", "degree": 2, "knots": [0,0,0,1,2,2,2], "points": [[0,0,0], [1,0,0], [2,2,0], [3,0,0]] },
        "hermite": { "type": "hermite", "points": [[0,0,0], [1,0,0]], "tangents": [[1,1,0], [1,-1,0]] },
        "natural": { "type": "interpolate", "points": [[0,0,0], [1,1,0], [2,0,0]] },
        "clamped": { "type": "interpolate", "points": [[0,0,0], [1,1,0], [2,0,0]], "ends": "clamped" },
        "catmull_rom": { "type": "interpolate", "points": [[0,0,0], [1,1,0], [2,0,0]], "ends": "catmull_rom" },
        "arc": { "type": "arc", "center": [0,0,0], "start": [1,0,0], "end": [0,1,0] },
        "formula": { "type": "formula", "xyz": ["cos(t)", "sin(t)", "t"], "domain": [0, "2*pi"] },
        "isocurve": { "type": "isocurve", "surface": "S", "v": 0.5 },
        "reverse": { "type": "reverse", "curve": "line" },
        "segment": { "type": "segment", "curve": "line", "interval": [0.25, 0.5] },
        "transform": { "type": "transform", "curve": "line", "rotate": [0,0,1,90], "translate": [0,0,3], "scale": 2 } },
      "surfaces": { "S": { "type": "bilinear", "points": [[0,0,0], [1,0,0], [0,1,0], [1,1,1]] } } })json");
    EXPECT_EQ(s.curves.size(), 13u);
    EXPECT_EQ(s.curves[0].first, "line") << "in the order of the file";
    expect_near((*s.find_curve("bezier"))(0.5), {std::sqrt(0.5), std::sqrt(0.5), 0});
    expect_near((*s.find_curve("arc"))(0.5), {std::sqrt(0.5), std::sqrt(0.5), 0});
    expect_near((*s.find_curve("hermite")).derivative(1), {1, -1, 0});
    expect_near((*s.find_curve("natural"))(1), {1, 1, 0});
    expect_near((*s.find_curve("formula"))(std::numbers::pi), {-1, 0, std::numbers::pi});
    expect_near((*s.find_curve("isocurve"))(0.5), {0.5, 0.5, 0.25});
    expect_near((*s.find_curve("reverse"))(0), {2, 0, 0});
    expect_near((*s.find_curve("segment"))(1), {1, 0, 0});
    expect_near((*s.find_curve("transform"))(1), {0, 4, 3});
}

TEST(Scene, EverySurfaceTypeIsBuilt) {
    const Scene s = load(R"json({ "isoparm": 1, "curves": {
        "c0": { "type": "line", "points": [[0,0,0], [1,0,0]] }, "c1": { "type": "line", "points": [[0,1,0], [1,1,0]] },
        "d0": { "type": "line", "points": [[0,0,0], [0,1,0]] }, "d1": { "type": "line", "points": [[1,0,0], [1,1,0]] },
        "X": { "type": "line", "points": [[1,0,0], [1,0,0]] }, "Y": { "type": "line", "points": [[0,1,0], [0,1,0]] },
        "T1": { "type": "line", "points": [[0,1,0], [0,0,0]] }, "T2": { "type": "line", "points": [[0,0,0], [1,0,0]] }, "T3": { "type": "line", "points": [[1,0,0], [0,1,0]] },
        "D1": { "type": "line", "points": [[1,-0.5,0], [1,-0.5,0]] }, "D2": { "type": "line", "points": [[-0.5,1,0], [-0.5,1,0]] },
        "D3": { "type": "line", "points": [[-0.5,-0.5,0], [-0.5,-0.5,0]] }, "Z": { "type": "line", "points": [[0,0,1], [0,0,3]] } },
      "surfaces": {
        "bezier": { "type": "bezier", "points": [[[0,0,0], [0,1,0]], [[1,0,0], [1,1,0]]], "weights": [[1,2], [3,4]] },
        "bspline": { "type": "bspline", "degree": [1,1], "knots": [[0,0,1,2,2], [0,0,1,1]], "points": [[[0,0,0], [0,1,0]], [[1,0,1], [1,1,1]], [[2,0,0], [2,1,0]]] },
        "bilinear": { "type": "bilinear", "points": [[0,0,0], [1,0,0], [0,1,0], [1,1,1]] },
        "bilinear_grid": { "type": "bilinear", "points": [[[0,0,0], [0,1,0]], [[1,0,0], [1,1,1]]] },
        "coons": { "type": "coons", "c0": "c0", "c1": "c1", "d0": "d0", "d1": { "type": "line", "points": [[1,0,0], [1,1,0]] } },
        "cubic": { "type": "coons", "c0": "c0", "c1": "c1", "d0": "d0", "d1": "d1", "blend": "cubic" },
        "formula": { "type": "coons", "c0": "c0", "c1": "c1", "d0": "d0", "d1": "d1", "blend": "t^2" },
        "P1": { "type": "coons", "c0": "c0", "c1": "c1", "d0": "d0", "d1": "d1", "part": "P1" },
        "coons_hermite": { "type": "coons_hermite", "f": ["d0", "X", "X", "d1"], "g": ["c0", "Y", "Y", "c1"] },
        "network": { "type": "network", "a": ["d0", "d1"], "b": ["c0", "c1"], "cross": "finite_difference", "twist": "gregory" },
        "triangle": { "type": "triangle", "points": [[1,0,0], [0,1,0], [0,0,1]] },
        "bezier_triangle": { "type": "bezier_triangle", "degree": 2, "points": [[2,0,0], [1,1,0], [0,2,0], [1,0,0], [0,1,0], [0,0,2]] },
        "coons_triangle": { "type": "coons_triangle", "method": "side_vertex", "H": "t^2", "form": "seed",
          "edges": [{ "type": "line", "points": [[0,1,0], [0,0,0]] }, { "type": "line", "points": [[0,0,0], [1,0,0]] }, { "type": "line", "points": [[1,0,0], [0,1,0]] }] },
        "three": { "type": "coons_triangle", "method": "three_curves", "edges": ["T1", "T2", "T3"] },
        "bbg": { "type": "coons_triangle", "method": "bbg_boolean", "projectors": ["P3", "P1"], "edges": ["T1", "T2", "T3"] },
        "bbg_part": { "type": "coons_triangle", "method": "bbg_convex", "part": "P3", "edges": ["T1", "T2", "T3"] },
        "bbg_c1": { "type": "coons_triangle", "method": "bbg_c1", "edges": ["T1", "T2", "T3"], "cross": ["D1", "D2", "D3"] },
        "nielson_c1": { "type": "coons_triangle", "method": "nielson_c1", "edges": ["T1", "T2", "T3"], "cross": ["D1", "D2", "D3"], "part": "T2" },
        "nielson_g1": { "type": "coons_triangle", "method": "nielson_g1", "edges": ["T1", "T2", "T3"], "normals": ["Z", "Z", "Z"] },
        "moved": { "type": "transform", "surface": "bilinear", "mirror": { "normal": [0,0,1], "offset": 1 } },
        "all": { "type": "composite", "members": ["coons", "moved", { "type": "triangle", "points": [[5,0,0], [6,0,0], [5,1,0]] }] },
        "twice": { "type": "composite", "members": ["all", { "type": "transform", "surface": "all", "translate": [0,0,9] }] } } })json");
    expect_near(patch(s, "bilinear").point(1, 0), {1, 0, 0});
    expect_near(patch(s, "bilinear").point(0, 1), {0, 1, 0});
    expect_near(patch(s, "bilinear_grid").point(0.25, 0.75), patch(s, "bilinear").point(0.25, 0.75));
    expect_near(patch(s, "coons").point(0.3, 0.6), {0.3, 0.6, 0});
    expect_near(patch(s, "triangle").point(0.2, 0.3), {0.2, 0.3, 0.5});
    expect_near(patch(s, "bezier_triangle").point(1, 0), {2, 0, 0});
    expect_near(patch(s, "bspline").point(1, 0.5), {1, 0.5, 1});
    expect_near(patch(s, "coons_triangle").point(0.2, 0.3), {0.2, 0.3, 0});
    for (const char* name : {"three", "bbg", "bbg_part", "bbg_c1", "nielson_c1", "nielson_g1"}) expect_near(patch(s, name).point(0.2, 0.3), {0.2, 0.3, 0});
    expect_near(patch(s, "moved").point(0, 0), {0, 0, 2});
    const auto& twice = s.find_surface("twice")->patches;
    ASSERT_EQ(twice.size(), 6u);
    EXPECT_EQ(twice[0].name, "all/coons");
    EXPECT_EQ(twice[2].name, "all/#2");
    EXPECT_EQ(twice[4].name, "#1/moved");
    expect_near(twice[4].patch.point(0, 0), {0, 0, 11});
    EXPECT_EQ(s.find_surface("bezier")->detail, "degree 1 x 1, rational");
    EXPECT_EQ(s.find_surface("nothing"), nullptr);
}

// matrix, mirror, scale, rotate, translate: in this order.
TEST(Scene, MapsAreAppliedInAFixedOrder) {
    const Scene s = load(R"json({ "isoparm": 1, "curves": { "a": { "type": "line", "points": [[1,0,0], [1,2,0]] },
        "b": { "type": "transform", "curve": "a", "translate": [10,0,0], "rotate": { "axis": [0,0,1], "degrees": 90 }, "scale": [2,1,1], "mirror": [1,0,0] } } })json");
    expect_near((*s.find_curve("b"))(0), {10, -2, 0});
    expect_near((*s.find_curve("b"))(1), {8, -2, 0});
}

TEST(Scene, ParametersCanBeSet) {
    const std::string text = R"json({ "isoparm": 1, "parameters": { "h": { "value": 2, "min": 0, "max": 5, "label": "height" }, "k": "h^2" },
        "curves": { "c": { "type": "line", "points": [[0,0,0], [0,"h/2","k"]] } } })json";
    expect_near((*load(text).find_curve("c"))(1), {0, 1, 4});
    expect_near((*load(text, {{"h", 3}}).find_curve("c"))(1), {0, 1.5, 9});
    EXPECT_EQ(load(text, {{"k", 7}}).parameters.at("k"), 7);
    for (const auto& bad : {std::map<std::string, double>{{"h", 6}}, {{"H", 1}}}) {
        try {
            load(text, bad);
            ADD_FAILURE();
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::usage);
        }
    }
}

TEST(Scene, ObjectsCameraImageAndToleranceAreRead) {
    const Scene s = load(R"json(/* comments */ { "isoparm": 1, "title": "T", "source": "S", "curves": { "c": { "type": "bezier", "points": [[0,0,0], [1,1,0], [2,0,0]] } },
      "surfaces": { "S": { "type": "bezier", "points": [[[0,0,0], [0,1,0]], [[1,0,0], [1,1,0]]] } },
      "objects": [ { "surface": "S", "color": "#ff0000", "opacity": 0.5, "isolines": { "u": 3, "v": 4, "width": 2 }, "boundary": true, "radius": 0.1 },
                   { "curve": "c", "color": [0.5, 0.5, 0.5] }, { "net": "S" }, { "net": "c", "radius": 0.2 }, { "point": [1,2,3], "label": "P" } ],
      "camera": { "eye": [3,2,1], "up": [0,1,0], "orthographic": 2 }, // done
      "image": { "width": 10, "height": 20, "samples": 3, "background": "transparent" }, "tessellation": { "tolerance": { "pixels": 0.25 } } })json");
    ASSERT_EQ(s.objects.size(), 5u);
    EXPECT_EQ(s.objects[0].color->x, 1);
    EXPECT_NEAR(s.objects[1].color->x, 0.214041140482, 1e-9) << "linear of sRGB 0.5";
    EXPECT_TRUE(s.objects[0].boundary);
    EXPECT_EQ(s.objects[0].isolines.v, 4);
    EXPECT_EQ(s.objects[2].net.points.size(), 4u);
    EXPECT_EQ(s.objects[2].net.rods.size(), 4u);
    EXPECT_EQ(s.objects[3].net.rods.size(), 2u);
    EXPECT_EQ(s.objects[4].label.text.at(0).text, "P");
    EXPECT_EQ(*s.camera.orthographic, 2);
    EXPECT_FALSE(s.image.background.has_value());
    EXPECT_EQ(s.tolerance.unit, Tolerance::Unit::pixels);
    const Bounds box = bounding_box(s);
    EXPECT_GE(box.high.z, 3);
}

// CSS Color Module Level 4, section 6.1: the basic names.
TEST(Scene, ColoursHaveTheNamesOfCss) {
    const auto color = [](const std::string& name) { return *load("{ \"isoparm\": 1, \"objects\": [ { \"point\": [0,0,0], \"color\": \"" + name + "\" } ] }").objects.at(0).color; };
    for (const auto& [name, hex] : {std::pair("aqua", "#00ffff"), {"black", "#000000"}, {"blue", "#0000ff"}, {"fuchsia", "#ff00ff"}, {"gray", "#808080"}, {"grey", "#808080"}, {"Green", "#008000"}, {"lime", "#00ff00"}, {"maroon", "#800000"}, {"navy", "#000080"},
                                    {"olive", "#808000"}, {"orange", "#ffa500"}, {"purple", "#800080"}, {"RED", "#F00"}, {"silver", "#c0c0c0"}, {"teal", "#008080"}, {"white", "#fff"}, {"yellow", "#ff0"}})
        EXPECT_EQ(color(name), color(hex)) << name;
    try {
        color("navi");
        ADD_FAILURE() << "read";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("did you mean \"navy\"?"), std::string::npos) << e.what();
    }
}
TEST(Scene, WithoutObjectsWhatNothingElseIsMadeOfIsDrawn) {
    const Scene s = load(R"json({ "isoparm": 1, "surfaces": { "a": { "type": "triangle", "points": [[0,0,0], [1,0,0], [0,1,0]] },
        "b": { "type": "transform", "surface": "a", "mirror": [0,1,0] }, "ab": { "type": "composite", "members": ["a", "b"] } } })json");
    ASSERT_EQ(s.objects.size(), 1u);
    EXPECT_EQ(s.objects[0].name, "ab");
}

// ---- what is cut off or changed never crashes -----------------------------------------------------------------------

void must_load_or_throw(const std::string& text) {
    try {
        load(text);
    } catch (const Error& e) {
        EXPECT_TRUE(e.kind() == ErrorKind::input) << e.what();
        EXPECT_NE(std::string(e.what()).find("scene.json:"), std::string::npos) << e.what();
    }
}
TEST(Scene, EveryPrefixIsRefusedWithItsPlace) {
    const std::string text = test::read_all(test::source_folder() + "/scenes/s004_gregory.json");
    const std::size_t step = 7;
    for (std::size_t n = 0; n + 3 < text.size(); n += step) must_load_or_throw(text.substr(0, n));
}
TEST(Scene, ChangedBytesAreReadOrRefused) {
    const std::string text = test::read_all(test::source_folder() + "/scenes/side_vertex.json");
    unsigned seed = 12345;
    for (int k = 0; k < 400; ++k) {
        std::string changed = text;
        for (int i = 0; i < 3; ++i) {
            seed = seed * 1664525u + 1013904223u;
            changed[(seed >> 8) % changed.size()] = "{}[],:\"0-9.eEt\\\n\0/"[(seed >> 3) % 19];
        }
        must_load_or_throw(changed);
    }
}

TEST(Scene, PointsOfABezierTriangleComeInRowsOrInOneList) {
    const std::string points[] = {"[0,0,0], [1,0,1], [2,0,0]", "[0,1,1], [1,1,2]", "[0,2,0]"};
    const auto at = [&](const std::string& list, const std::string& weights) {
        const test::TemporaryFolder t;
        test::write_all(t / "s.json", "{ \"isoparm\": 1, \"surfaces\": { \"S\": { \"type\": \"bezier_triangle\", \"degree\": 2, \"points\": " + list +
                                          ", \"weights\": " + weights + " } } }");
        return patch(load_scene(t / "s.json"), "S").point(0.2, 0.3);
    };
    const Point flat = at("[" + points[0] + ", " + points[1] + ", " + points[2] + "]", "[1,2,3,4,5,6]");
    EXPECT_EQ(flat, at("[[" + points[0] + "], [" + points[1] + "], [" + points[2] + "]]", "[[1,2,3],[4,5],[6]]"));
}

// ---- the scenes that are shipped: the numbers their comments promise ------------------------------------------------

TEST(ShippedScenes, Coons) { expect_near(patch(shipped("coons"), "S").point(0.5, 0.5), {1.5, 1.59375, 1.03125}); }
TEST(ShippedScenes, Sphere) {
    const Scene s = shipped("sphere");
    const auto& patches = s.find_surface("sphere")->patches;
    ASSERT_EQ(patches.size(), 8u);
    for (const Member& m : patches)
        for (const double u : {0.0, 0.3, 1.0})
            for (const double v : {0.0, 0.6, 1.0}) {
                const SurfacePoint p = evaluate(m.patch, u, v);
                EXPECT_NEAR(length(p.position), 1, 1e-15);
                ASSERT_TRUE(p.normal.has_value());
                EXPECT_NEAR(std::fabs(dot(*p.normal, p.position)), 1, 1e-14);
                if (u > 0) {
                    EXPECT_NEAR(*p.gaussian, 1, 1e-12);
                }
            }
    EXPECT_NEAR(*evaluate(patch(s, "octant"), 0.5, 0.5).mean, -1, 1e-14);
}
TEST(ShippedScenes, Teapot) {
    const Scene s = shipped("teapot");
    ASSERT_EQ(s.find_surface("teapot")->patches.size(), 32u);
    expect_near(patch(s, "teapot").point(0, 0), {1.4, 0, 2.4}, 0);
}
TEST(ShippedScenes, SideVertex) {
    const Scene s = shipped("side_vertex");
    const Patch& p = patch(s, "shell");
    expect_near(p.point(1.0 / 3, 1.0 / 3), {0, 0, 1.5});
    expect_near(p.point(0, 0.5), (*s.find_curve("E1"))(0.5));
}
TEST(ShippedScenes, Gregory) {
    const Patch p = patch(shipped("s004_gregory"), "square");
    expect_near(p.point(0.5, 0.5), {1, 1, 1});
    expect_near(*evaluate(p, 0, 0.5).du, {2, 0, 4.5});
    expect_near(*evaluate(p, 0.5, 0).dv, {0, 2, -0.5});
    EXPECT_FALSE(evaluate(p, 0, 0).duv.has_value());
}

}  // namespace
}  // namespace isoparm
