// Flat surfaces in one plane: what a scene lists later lies over what it lists before.
#include <gtest/gtest.h>

#include <random>

#include "error.h"
#include "picture/picture.h"
#include "rays/traced_scene.h"
#include "scene/scene_file.h"

namespace isoparm {
namespace {

/// A square of side 3 about (1,2,z0), and one of side 1 above its middle, both aslant; `z` is how far the second one is above the first.
std::string squares(const std::string& objects, double z) {
    const Point u{0.8, 0.6, 0.1}, v{-0.6, 0.8, 0.3}, n = normalized(cross(u, v)), middle{1, 2, 0.7};
    const auto square = [&](double half, const Point& at) {
        const auto corner = [&](double s, double t) {
            const Point p = at + (s * half) * u + (t * half) * v;
            return "[" + to_text(p.x) + "," + to_text(p.y) + "," + to_text(p.z) + "]";
        };
        return R"({"type": "bezier", "points": [[)" + corner(-1, -1) + "," + corner(-1, 1) + "],[" + corner(1, -1) + "," + corner(1, 1) + "]]}";
    };
    return R"({"isoparm": 1, "surfaces": {"large": )" + square(1.5, middle) + R"(, "small": )" + square(0.5, middle + z * n) + R"(, "beside": )" + square(0.5, middle + 2.0 * u) + R"(}, "objects": [)" + objects + "]}";
}
std::string drawn(const char* name) { return R"({"surface": ")" + std::string(name) + R"(", "boundary": false})"; }

/// How many of 500 rays through the small square meet the first of the objects first.
int first_of(const TracedScene& traced, double above) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> within(-0.49, 0.49), aside(-3, 3);
    const Point u{0.8, 0.6, 0.1}, v{-0.6, 0.8, 0.3}, n = normalized(cross(u, v)), middle{1, 2, 0.7};
    int first = 0;
    for (int i = 0; i < 500; ++i) {
        const Point to = middle + within(random) * u + within(random) * v, from = to + (above * (1 + 0.2 * aside(random) / 3)) * n + aside(random) * u + aside(random) * v;
        const Hit hit = traced.embree->first({from, normalized(to - from)});
        EXPECT_TRUE(hit.found());
        first += hit.geometry == 0;
    }
    return first;
}

TEST(SharedPlanes, TheLaterObjectLiesOverTheEarlier) {
    for (const bool exact : {false, true})
        for (const double above : {2.0, 0.3, -2.0}) {
            const Scene small_last = parse_scene(squares(drawn("large") + "," + drawn("small"), 0), "s.json"), large_last = parse_scene(squares(drawn("small") + "," + drawn("large"), 0), "s.json");
            EXPECT_EQ(first_of(build_traced_scene(small_last, 1e-3, {}, exact), above), 0) << exact << " " << above;
            EXPECT_EQ(first_of(build_traced_scene(large_last, 1e-3, {}, exact), above), 0) << exact << " " << above;
        }
}
TEST(SharedPlanes, OfSurfacesInTwoPlanesTheNearerIsSeen) {
    const Scene scene = parse_scene(squares(drawn("small") + "," + drawn("large"), 1e-3), "s.json");
    for (const bool exact : {false, true}) {
        const TracedScene traced = build_traced_scene(scene, 1e-5, {}, exact);
        EXPECT_EQ(first_of(traced, 2), 500) << exact;
        EXPECT_EQ(first_of(traced, -2), 0) << exact;
        EXPECT_FALSE(traced.embree->translucent());
    }
}
TEST(SharedPlanes, ASheetLiesOverWhatIsListedBeforeIt) {
    const std::string sheet = R"({"surface": "small", "boundary": false, "opacity": 0.5})";
    const Point middle{1, 2, 0.7}, n = normalized(cross(Point{0.8, 0.6, 0.1}, Point{-0.6, 0.8, 0.3}));
    for (const bool exact : {false, true})
        for (const double above : {2.0, -2.0}) {
            const Ray ray{middle + above * n, normalized(-above * n)};
            const TracedScene over = build_traced_scene(parse_scene(squares(drawn("large") + "," + sheet, 0), "s.json"), 1e-3, {}, exact);
            std::vector<Hit> hits;
            over.embree->layers(ray, hits);
            ASSERT_EQ(hits.size(), 2u);
            EXPECT_EQ(hits[0].geometry, 1u);
            EXPECT_EQ(hits[1].geometry, 0u);
            const TracedScene under = build_traced_scene(parse_scene(squares(sheet + "," + drawn("large"), 0), "s.json"), 1e-3, {}, exact);
            under.embree->layers(ray, hits);
            ASSERT_EQ(hits.size(), 1u);
            EXPECT_EQ(hits[0].geometry, 1u);
        }
}
TEST(SharedPlanes, OneFlatPatchOfASurfaceIsEnough) {
    // The top of a box, and a square on it; and both as squares of bent patches beside them.
    const std::string box = R"({"type": "composite", "members": [{"type": "bilinear", "points": [[0,0,0],[2,0,0],[0,2,0],[2,2,0]]}, {"type": "bilinear", "points": [[0,0,0],[0,0,-1],[2,0,0],[2,0,-1]]}, {"type": "bilinear", "points": [[0,2,0],[2,2,1],[0,3,0],[2,3,0]]}]})",
                      square = R"({"type": "bilinear", "points": [[0.5,0.5,0],[1.2,0.5,0],[0.5,1.2,0],[1.2,1.2,0]]})";
    for (const bool exact : {false, true})
        for (const bool box_last : {false, true}) {
            const Scene scene = parse_scene(R"({"isoparm": 1, "surfaces": {"box": )" + box + R"(, "square": )" + square + R"(}, "objects": [{"surface": ")" + (box_last ? "square" : "box") + R"("}, {"surface": ")" + (box_last ? "box" : "square") + "\"}]}", "s.json");
            const TracedScene traced = build_traced_scene(scene, 1e-3, {}, exact);
            std::size_t shared = 0;
            for (const Thing& t : traced.things) shared += t.patch && t.shares_plane;
            EXPECT_EQ(shared, 2u);
            std::mt19937 random(7);
            std::uniform_real_distribution<double> within(0.51, 1.19);
            for (int i = 0; i < 200; ++i) {
                const Point to{within(random), within(random), 0}, from = to + Point{within(random), -5 * within(random), 3};
                const Hit hit = traced.embree->first({from, normalized(to - from)});
                ASSERT_TRUE(hit.found());
                EXPECT_EQ(hit.geometry >= traced.later.at(0), true) << exact << box_last;
            }
        }
}
TEST(SharedPlanes, RaysAlmostAlongThePlaneFollowTheRule) {
    const Point u{0.8, 0.6, 0.1}, v{-0.6, 0.8, 0.3}, n = normalized(cross(u, v)), middle{1, 2, 0.7};
    for (const bool exact : {false, true}) {
        const TracedScene traced = build_traced_scene(parse_scene(squares(drawn("small") + "," + drawn("large"), 0), "s.json"), 1e-3, {}, exact);
        for (const double angle : {0.1, 0.01, 0.001})
            for (int i = 0; i < 100; ++i) {
                const Point to = middle + (0.004 * i - 0.2) * v, from = to - 2.0 * u + 2 * angle * n;
                const Hit hit = traced.embree->first({from, normalized(to - from)});
                ASSERT_TRUE(hit.found());
                EXPECT_EQ(hit.geometry, 1u) << exact << angle;
            }
    }
}
TEST(SharedPlanes, GlassShowsWhatLiesUnderIt) {
    // A pane, tinted or clear, on a red wall, far above a blue floor: never the floor, and never black.
    const auto seen = [&](const std::string& objects, bool exact) {
        const Scene scene = parse_scene(R"({"isoparm": 1, "surfaces": {"wall": {"type": "bilinear", "points": [[0,0,0],[2,0,0],[0,2,0],[2,2,0]]}, "pane": {"type": "bilinear", "points": [[0.5,0.5,0],[1.5,0.5,0],[0.5,1.5,0],[1.5,1.5,0]]},
            "floor": {"type": "bilinear", "points": [[-5,-5,-1],[5,-5,-1],[-5,5,-1],[5,5,-1]]}}, "objects": [{"surface": "floor", "color": "blue", "material": "diffuse"},)" + objects + R"(],
            "camera": {"eye": [1,1,3], "target": [1,1,0], "up": [0,1,0], "fov": 5}, "image": {"width": 8, "height": 8, "samples": 256}, "lighting": {"bounces": 4, "lights": [{"type": "environment", "radiance": 1}]}})", "s.json");
        RenderOptions how;
        how.exact = exact;
        const Picture p = render(scene, how);
        Color mean;
        for (int i = 0; i < 64; ++i) mean += Color{p.image.at(i % 8, i / 8)[0], p.image.at(i % 8, i / 8)[1], p.image.at(i % 8, i / 8)[2]} / 64;
        return mean;
    };
    const std::string wall = R"({"surface": "wall", "color": "red", "material": "diffuse"})", sheet = R"({"surface": "wall", "color": "red", "material": "diffuse", "opacity": 0.5})";
    const auto pane = [](const std::string& more) { return R"({"surface": "pane", "material": {"type": "glass")" + more; };
    for (const bool exact : {false, true}) {
        const Color bare = seen(wall, exact), clear = seen(wall + "," + pane(R"(, "thin": true}})"), exact), tinted = seen(wall + "," + pane(R"(, "thin": true}, "color": [0.5,0.5,0.5]})"), exact),
                    solid = seen(wall + "," + pane("}}"), exact), under = seen(pane("}},") + wall, exact);
        const double f = 2 * 0.04 / 1.04;  // a pane's two sides, to and fro
        EXPECT_NEAR(bare.x, 1, 0.01);
        EXPECT_NEAR(clear.x, 1, 0.01) << "what it mirrors is as bright";
        EXPECT_NEAR(clear.z, f, 0.01) << exact;
        EXPECT_NEAR(tinted.x, f + (1 - f) * std::pow((0.5 + 0.055) / 1.055, 2.4), 0.01) << exact;
        EXPECT_NEAR(solid.z, 0.04, 0.01) << exact;
        EXPECT_EQ(under, bare) << exact;
        const Color half = seen(sheet + "," + pane(R"(, "thin": true}})"), exact), alone = seen(sheet, exact);
        EXPECT_NEAR(half.x, f + (1 - f) * alone.x, 0.02) << exact;
        EXPECT_NEAR(half.z, f + (1 - f) * alone.z, 0.02) << exact;
    }
}
TEST(SharedPlanes, NeighboursInOnePlaneAreOpaque) {
    EXPECT_FALSE(build_traced_scene(parse_scene(squares(drawn("beside") + "," + drawn("large"), 0), "s.json"), 1e-3, {}).embree->translucent());
    EXPECT_TRUE(build_traced_scene(parse_scene(squares(drawn("small") + "," + drawn("large"), 0), "s.json"), 1e-3, {}).embree->translucent());
}

}  // namespace
}  // namespace isoparm
