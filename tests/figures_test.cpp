// The figures of the papers, scenes/s00*.json: all of them load and render, and the numbers hold that they promise.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "picture/picture.h"
#include "run_program.h"
#include "scene/registry.h"
#include "scene/scene.h"

namespace isoparm {
namespace {

std::vector<std::string> shipped_scenes() {
    std::vector<std::string> names;
    for (const auto& file : std::filesystem::directory_iterator(test::source_folder() + "/scenes"))
        if (file.path().extension() == ".json" && file.path().stem().extension() != ".schema") names.push_back(file.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}
std::string file_of(const std::string& name) { return test::source_folder() + "/scenes/" + name + ".json"; }
Scene shipped(const std::string& name, const std::map<std::string, double>& set = {}) { return load_scene(file_of(name), set); }
const Patch& patch(const Scene& scene, const std::string& name) { return scene.find_surface(name)->patches.at(0).patch; }
const Curve& curve(const Scene& scene, const std::string& name) { return *scene.find_curve(name); }

void expect_near(const Point& a, const Point& b, double tolerance = 1e-13) {
    EXPECT_LE(distance(a, b), tolerance) << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}
const std::vector<double> kSome = {0, 0.15, 0.5, 0.8, 1};

TEST(Figures, EverySceneHasATitleASourceAndNamesItsSchema) {
    const auto names = shipped_scenes();
    EXPECT_GE(names.size(), 37u);
    for (const std::string& name : names) {
        SCOPED_TRACE(name);
        const Scene s = shipped(name);
        EXPECT_FALSE(s.title.empty());
        EXPECT_FALSE(s.source.empty());
        EXPECT_NE(test::read_all(file_of(name)).find("\"$schema\": \"scene.schema.json\""), std::string::npos);
        EXPECT_NE(test::read_all(test::source_folder() + "/scenes/README.md").find("| `" + name), std::string::npos) << "not in scenes/README.md";
    }
}

TEST(Figures, AllRenderToAContactSheet) {
    const test::TemporaryFolder t;
    const auto result = test::run("figures -o " + t / "out" + " --size 96x72 --samples 1 --tolerance 1e-2rel");
    EXPECT_EQ(result.code, 0) << result.err;
    for (const std::string& name : shipped_scenes()) EXPECT_GT(test::read_all(t / ("out/" + name + ".png")).size(), 200u) << name;
    EXPECT_GT(test::read_all(t / "out/contact_sheet.png").size(), 2000u);
}

TEST(Figures, MaterialsAreAsTheSceneSays) {
    RenderOptions how;
    how.width = 60, how.height = 45, how.samples = 64;
    const Image image = render(shipped("materials"), how).image;
    for (const int x : {0, 59})
        for (int k = 0; k < 3; ++k) EXPECT_EQ(image.at(x, 0)[k], 1.0f);
    how.width = 480, how.height = 360, how.crop = {418, 172, 422, 176};
    const Image shadow = render(shipped("materials"), how).image;
    for (const auto& [k, light] : {std::pair(0, 0.69), {1, 0.82}, {2, 0.92}}) {
        double mean = 0;
        for (int i = 0; i < 16; ++i) mean += double(shadow.at(i % 4, i / 4)[k]) / 16;
        EXPECT_NEAR(mean, light, 0.02) << k;
    }
}

// ---- seed 000 -------------------------------------------------------------------------------------------------------

/// g(t) pulled straight towards the vertex, which is reached where `pull` is 1.
Point ruled(const Curve& g, double a, double pull, const Point& vertex) {
    return (1 - pull) * g(pull < 1 ? a / (1 - pull) : 0) + pull * vertex;
}
TEST(Figures, Seed000RuledSurfacesAndTheirSum) {
    const Scene s2 = shipped("s000_fig2"), s3 = shipped("s000_fig3"), s4 = shipped("s000_fig4"), s5 = shipped("s000_fig5"), s6 = shipped("s000_fig6");
    const Curve &g1 = curve(s6, "g1"), &g2 = curve(s6, "g2"), &g3 = curve(s6, "g3");
    const Point a = g1(1), b = g2(1), c = g3(1);
    for (const double u : kSome)
        for (const double v : kSome) {
            const double w = 1 - u - v;
            if (w < 0) continue;
            const Point s1 = ruled(g1, u, v, b), s_2 = ruled(g2, v, w, c), s_3 = ruled(g3, w, u, a), plane = u * a + v * b + w * c;
            expect_near(patch(s2, "s1").point(u, v), s1);
            expect_near(patch(s3, "s2").point(u, v), s_2);
            expect_near(patch(s4, "s3").point(u, v), s_3);
            expect_near(patch(s5, "s4").point(u, v), plane);
            expect_near(patch(s6, "s").point(u, v), s1 + s_2 + s_3 - 2.0 * plane);
            if (v < 1) expect_near(patch(s2, "cone").point(u / (1 - v), v), s1);  // lemma 2
        }
}
TEST(Figures, Seed000CoonsIsBezier) {
    const Scene s = shipped("s000_fig8");
    for (const double u : kSome)
        for (const double v : kSome)
            if (u + v <= 1) expect_near(patch(s, "coons").point(u, v), patch(s, "bezier").point(u, v));
    expect_near(patch(s, "coons").point(1.0 / 3, 1.0 / 3), Point{0.8, 2.6, 6.3} / 9);
}

// ---- seed 001 -------------------------------------------------------------------------------------------------------

TEST(Figures, Seed001TheMovingCurveSweepsTheSurface) {
    for (const double v : kSome) {
        const Scene s = shipped("s001_fig1", {{"v", v}});
        for (const double u : kSome) expect_near(curve(s, "moving")(u), patch(s, "B").point(u, v));
        expect_near(curve(s, "moving")(0), curve(s, "B0")(v));
        expect_near(curve(s, "moving")(1), curve(s, "B2")(v));
    }
}
TEST(Figures, Seed001QuarterCirclesAndOctant) {
    const Scene circle = shipped("s001_fig2"), poles = shipped("s001_fig3"), sphere = shipped("s001_fig4");
    const Patch& octant = patch(sphere, "octant");
    for (const double t : kSome) {
        EXPECT_NEAR(length(curve(circle, "R")(t)), 1, 1e-15);
        for (const char* name : {"R(u,0)", "R(u,1)", "R(1,v)"}) EXPECT_NEAR(length(curve(poles, name)(t)), 1, 1e-15) << name;
        EXPECT_NEAR(distance(curve(poles, "R1(v)")(t), {0, 0, 1}), 1, 1e-15);
        expect_near(octant.point(t, 0), curve(poles, "R(u,0)")(t));
        expect_near(octant.point(1, t), curve(poles, "R(1,v)")(t));
    }
    EXPECT_EQ(sphere.find_surface("sphere")->patches.size(), 8u);
}

// ---- seed 002 -------------------------------------------------------------------------------------------------------

TEST(Figures, Seed002BlendingFunctions) {
    const Scene value = shipped("s002_fig1"), slope = shipped("s002_fig2");
    const Curve &h0 = curve(value, "H"), &h1 = curve(slope, "H");
    for (const double u : {0.0, 1.0, 2.0}) {
        expect_near(h0(u), {u, u == 1 ? 1.0 : 0.0, 0});
        expect_near(h0.derivative(u), {1, 0, 0});
        expect_near(h1(u), {u, 0, 0});
        expect_near(h1.derivative(u), {1, u == 1 ? 1.0 : 0.0, 0});
    }
    expect_near(h1(2.0 / 3), {2.0 / 3, -4.0 / 27, 0});
    expect_near(h1(4.0 / 3), {4.0 / 3, 4.0 / 27, 0});
    expect_near(h0(-0.3), {-0.3, 0, 0});
    expect_near(h1(2.3), {2.3, 0, 0});
}
TEST(Figures, Seed002TheSurfaceIsOnTheCurves) {
    const Scene network = shipped("s002_fig3"), s = shipped("s002_fig4");
    const Patch& p = patch(s, "network");
    expect_near(p.point(1, 1), {2.1, 1.9, 0.6});
    for (int i = 0; i <= 2; ++i)
        for (const double t : {0.0, 0.4, 1.3, 2.0}) {
            expect_near(p.point(i, t), curve(network, "a" + std::to_string(i))(t));
            expect_near(p.point(t, i), curve(network, "b" + std::to_string(i))(t));
        }
}

// ---- seed 003 -------------------------------------------------------------------------------------------------------

TEST(Figures, Seed003SurfacesGoThroughTheirCurves) {
    const Scene lagrange = shipped("s003_lagrange"), gordon = shipped("s003_gordon"), network = shipped("s003_coons_network");
    for (const double t : kSome) {
        for (int i = 0; i <= 3; ++i) {
            expect_near(patch(lagrange, "S").point(t, i), curve(lagrange, "r" + std::to_string(i))(t));
            expect_near(patch(gordon, "S").point(i, 2 * t), curve(gordon, "f" + std::to_string(i))(2 * t));
        }
        for (int j = 0; j <= 2; ++j) expect_near(patch(gordon, "S").point(3 * t, j), curve(gordon, "g" + std::to_string(j))(3 * t));
        for (int k = 0; k <= 4; ++k) {
            expect_near(patch(network, "S").point(k, 4 * t), curve(network, "a" + std::to_string(k))(4 * t));
            expect_near(patch(network, "S").point(4 * t, k), curve(network, "b" + std::to_string(k))(4 * t));
        }
    }
}
/// One of the arrows goes from a to b.
void expect_arrow(const Scene& s, const Point& a, const Point& b) {
    int found = 0;
    for (const SceneObject& o : s.objects) found += o.kind == SceneObject::Kind::arrow && distance(o.arrow.tail, a) < 1e-12 && distance(o.arrow.tip, b) < 1e-12;
    EXPECT_EQ(found, 1);
}
TEST(Figures, Seed003TensorProductHasTheDerivativesThatAreDrawn) {
    const Scene s = shipped("s003_tensor_product");
    for (int i = 0; i <= 2; ++i)
        for (int j = 0; j <= 2; ++j) {
            const SurfacePoint at = evaluate(patch(s, "S"), i, j);
            expect_arrow(s, at.position, at.position + 0.34 * *at.du);
            expect_arrow(s, at.position, at.position + 0.34 * *at.dv);
        }
}
double area(const Patch& triangle) {
    const Point a = triangle.point(1, 0), b = triangle.point(0, 1), c = triangle.point(0, 0);
    return 0.5 * length(cross(b - a, c - a));
}
TEST(Figures, Seed003BarycentricCoordinates) {
    const Scene s = shipped("s003_barycentric");
    const double whole = area(patch(s, "ABC"));
    EXPECT_NEAR(area(patch(s, "PBC")) / whole, 0.3, 1e-15);
    EXPECT_NEAR(area(patch(s, "APC")) / whole, 0.25, 1e-15);
    EXPECT_NEAR(area(patch(s, "ABP")) / whole, 0.45, 1e-15);
    const Scene plane = shipped("s003_planar_triangle");
    expect_near(patch(plane, "r").point(0.5, 0.3), {0.99, 0.38, 0.68});
    expect_near(0.6 * curve(plane, "a = const")(0) + 0.4 * curve(plane, "a = const")(1), {0.99, 0.38, 0.68});
}
TEST(Figures, Seed003ThreeCurvesTurnIntoThemselves) {
    const Scene s = shipped("s003_three_curves");
    expect_near(patch(s, "S").point(1.0 / 3, 1.0 / 3), {0, 0, 0});
    for (const double t : kSome) expect_near(patch(s, "S").point(0, 1 - t), curve(s, "E1")(t));
}
TEST(Figures, Seed003Example635TheMiddleDoesNotMove) {
    const Point middle = Point{170, 170, 340} / 27;
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const Scene s = shipped("s003_example_635", {{"te", t}, {"tb", t}, {"tj", t}});
        expect_near(patch(s, "joining").point(1.0 / 3, 1.0 / 3), middle);
        for (const double x : kSome) {  // the edges u = 0, v = 0, w = 0, of the joining surface and of one triangle each
            expect_near(patch(s, "joining").point(0, x), patch(s, "green").point(0, x));
            expect_near(patch(s, "joining").point(x, 0), patch(s, "yellow").point(x, 0));
            expect_near(patch(s, "joining").point(x, 1 - x), patch(s, "blue").point(x, 1 - x));
        }
    }
    // The vertices that move: the printed ends, and half way between.
    expect_near(patch(shipped("s003_example_635", {{"te", 0}}), "yellow").point(0, 1), {8, 8, 10});
    expect_near(patch(shipped("s003_example_635", {{"te", 0.5}}), "yellow").point(0, 1), {20, 20, 0});
    expect_near(patch(shipped("s003_example_635", {{"te", 1}}), "yellow").point(0, 1), {8, 8, -10});
    expect_near(patch(shipped("s003_example_635", {{"tb", 1}}), "green").point(1, 0), {8, -6, 16});
    expect_near(patch(shipped("s003_example_635", {{"tj", 1}}), "blue").point(0, 0), {-6, 8, 16});
    expect_near(patch(shipped("s003_example_635", {{"tj", 0.25}}), "blue").point(0, 0), {3, 14, 28});
}

// ---- seed 004 -------------------------------------------------------------------------------------------------------

TEST(Figures, Seed004TwistsOfABicubicSurface) {
    const Scene s = shipped("s004_bicubic_twists");
    for (const double u : {0.0, 1.0})
        for (const double v : {0.0, 1.0}) {
            const SurfacePoint at = evaluate(patch(s, "x"), u, v);
            expect_arrow(s, at.position, at.position + 0.24 * *at.du);
            expect_arrow(s, at.position, at.position + 0.12 * *at.duv);
        }
}
TEST(Figures, Seed004TheMeanOfTwistsInterpolatesNeither) {
    expect_near(*evaluate(patch(shipped("s004_gregory"), "square"), 0, 0.5).du, {2, 0, 4.5});
    expect_near(*evaluate(patch(shipped("s004_incompatible_twists"), "square"), 0, 0.5).du, {2, 0, 2});
}
TEST(Figures, Seed004SumsOfTheirParts) {
    const Scene boolean = shipped("s004_boolean_sum"), gordon = shipped("s004_gordon"), convex = shipped("s004_convex_combination"), net = shipped("s004_control_net");
    const Scene moved = shipped("s004_translational");
    expect_near(patch(moved, "t").point(1, 1), {4, 4, 1.1});
    for (const double u : kSome)
        for (const double v : kSome) {
            const auto at = [&](const Scene& s, const char* name, double scale = 1) { return patch(s, name).point(scale * u, scale * v); };
            expect_near(at(boolean, "P"), at(boolean, "P1") + at(boolean, "P2") - at(boolean, "P1P2"));
            expect_near(at(boolean, "P1"), (1 - v) * curve(boolean, "c0")(u) + v * curve(boolean, "c1")(u));  // the slide's P1
            expect_near(at(boolean, "P2"), (1 - u) * curve(boolean, "d0")(v) + u * curve(boolean, "d1")(v));
            expect_near(at(gordon, "g", 2), at(gordon, "g1", 2) + at(gordon, "g2", 2) - at(gordon, "g12", 2));
            expect_near(at(convex, "x"), at(boolean, "P"));
            const auto t = [&](const char* name, double s, double r) { return patch(convex, name).point(s, r); };
            expect_near(at(convex, "x"), (1 - u) * ((1 - v) * t("t00", u, v) + v * t("t01", u, 1 - v)) +
                                             u * ((1 - v) * t("t10", 1 - u, v) + v * t("t11", 1 - u, 1 - v)));
        }
    const auto coons = [&](double u, double v) {
        const Curve &c0 = curve(net, "c0"), &c1 = curve(net, "c1"), &d0 = curve(net, "d0"), &d1 = curve(net, "d1");
        return (1 - v) * c0(u) + v * c1(u) + (1 - u) * d0(v) + u * d1(v) - (1 - u) * ((1 - v) * c0(0) + v * c1(0)) - u * ((1 - v) * c0(1) + v * c1(1));
    };
    for (const double u : kSome)
        for (const double v : kSome) expect_near(patch(net, "S").point(u, v), coons(u, v));
}
/// Whether p is on the straight line from a to b, as far as the scene's numbers go.
void expect_on(const Curve& line, const Point& p) {
    const Point a = line(0), b = line(1), d = normalized(b - a);
    EXPECT_LE(length((p - a) - dot(p - a, d) * d), 2e-4);
}
TEST(Figures, Seed004LinesOfTheTriangle) {
    const double u = 0.4, v = 0.35, w = 0.25;
    const Scene bbg = shipped("s004_bbg_lines"), side = shipped("s004_side_vertex");
    const Curve &e1 = curve(bbg, "E1"), &e2 = curve(bbg, "E2"), &e3 = curve(bbg, "E3");
    for (const Scene* s : {&bbg, &side})
        for (const SceneObject& o : s->objects)
            if (o.kind == SceneObject::Kind::curve && o.name.size() > 4) expect_on(curve(*s, o.name), patch(*s, "domain").point(u, v));
    expect_near(curve(bbg, "P1")(0), e2(u), 1e-4);
    expect_near(curve(bbg, "P1")(1), e3(1 - u), 1e-4);
    expect_near(curve(bbg, "P2")(0), e3(v), 1e-4);
    expect_near(curve(bbg, "P2")(1), e1(1 - v), 1e-4);
    expect_near(curve(bbg, "P3")(0), e1(w), 1e-4);
    expect_near(curve(bbg, "P3")(1), e2(1 - w), 1e-4);
    expect_near(curve(side, "P1")(1), e1(w / (v + w)), 1e-4);
    expect_near(curve(side, "P2")(1), e2(u / (u + w)), 1e-4);
    expect_near(curve(side, "P3")(1), e3(v / (u + v)), 1e-4);
    const Patch& s = patch(side, "S");
    const auto segment = [&](const char* name, double towards_end) { const Curve& c = curve(side, name); return (1 - towards_end) * c(0) + towards_end * c(1); };
    const Point plane = u * e3(0) + v * e1(0) + w * e2(0);
    expect_near(s.point(u, v), segment("P1", 1 - u) + segment("P2", 1 - v) + segment("P3", 1 - w) - 2.0 * plane, 3e-4);
}

}  // namespace
}  // namespace isoparm
