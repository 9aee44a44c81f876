// Flat surfaces in one plane: what a scene lists later lies over what it lists before.
#include <gtest/gtest.h>

#include <random>

#include "error.h"
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
TEST(SharedPlanes, NeighboursInOnePlaneAreOpaque) {
    EXPECT_FALSE(build_traced_scene(parse_scene(squares(drawn("beside") + "," + drawn("large"), 0), "s.json"), 1e-3, {}).embree->translucent());
    EXPECT_TRUE(build_traced_scene(parse_scene(squares(drawn("small") + "," + drawn("large"), 0), "s.json"), 1e-3, {}).embree->translucent());
}

}  // namespace
}  // namespace isoparm
