// light_test.cpp -- traced light against what is known: furnaces, irradiance of lights in closed form, shadows, sheets, mirrors.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "light/bsdf.h"
#include "light/local_frame.h"
#include "picture/picture.h"
#include "run_program.h"
#include "samples.h"

namespace isoparm {
namespace {

using tests::Random;

constexpr double kPi = std::numbers::pi;

// ---- scattering

std::vector<Material> materials() {
    std::vector<Material> all;
    for (const double roughness : {0.0, 0.1, 0.3, 0.6, 1.0})
        for (const auto kind : {Material::Kind::diffuse, Material::Kind::plastic, Material::Kind::metal}) all.push_back({kind, roughness, 1.5, false});
    all.push_back({Material::Kind::glass, 0, 1.5, false});
    all.push_back({Material::Kind::glass, 0, 1.5, true});
    return all;
}
Point at_angle(double degrees) { return {std::sin(degrees * kPi / 180), 0, std::cos(degrees * kPi / 180)}; }

/// What comes back of even light, by samples.
Color reflected(const Bsdf& bsdf, const Point& out, int samples = 4096) {
    const PixelSampler sampler(3, 5, samples);
    Color sum;
    for (int i = 0; i < samples; ++i) sum += bsdf.sample(out, sampler(i, 0).x, sampler(i, 1)).weight;
    return sum / double(samples);
}

TEST(Light, MeanFresnelIsTheIntegral) {
    for (const double ior : {1.1, 1.5, 2.4}) {
        double sum = 0;
        const int n = 100000;
        for (int i = 0; i < n; ++i) sum += fresnel(std::sqrt((i + 0.5) / n), ior) / n;  // cosine-weighted: even in the square of the cosine
        EXPECT_NEAR(mean_fresnel(ior), sum, 1e-6) << ior;
    }
}
TEST(Light, MaterialsGiveBackNoMoreThanTheyGet) {
    for (const Material& m : materials())
        for (const double degrees : {0.0, 30.0, 60.0, 80.0, 88.0}) {
            const Color white = reflected(Bsdf(m, {1, 1, 1}, false), at_angle(degrees));
            EXPECT_LE(white.x, m.kind == Material::Kind::metal ? 1.01 : 1.004) << int(m.kind) << " " << m.roughness << " " << degrees;
            EXPECT_GE(white.x, m.roughness <= 0.1 ? 0.9 : m.kind == Material::Kind::metal ? 0.99 : 0.25) << int(m.kind) << " " << m.roughness << " " << degrees;
        }
    EXPECT_NEAR(reflected(Bsdf({Material::Kind::diffuse, 0, 1.5, false}, {0.2, 0.5, 0.9}, false), at_angle(40)).y, 0.5, 1e-12);
    EXPECT_NEAR(reflected(Bsdf({Material::Kind::plastic, 0, 1.5, false}, {1, 1, 1}, false), at_angle(40)).x, 1, 0.005);
}
TEST(Light, PlasticHasItsColour) {
    // A smooth coat reflects f(out) of even light; of what enters, as much comes out again as the colour says.
    for (const double ior : {1.3, 1.5, 2.0})
        for (const double degrees : {0.0, 40.0, 75.0}) {
            const Color seen = reflected(Bsdf({Material::Kind::plastic, 0, ior, false}, {0.8, 0.3, 0.1}, false), at_angle(degrees));
            const double f = fresnel(std::cos(degrees * kPi / 180), ior);
            EXPECT_NEAR(seen.x, f + (1 - f) * 0.8, 0.005) << ior << " " << degrees;
            EXPECT_NEAR(seen.y, f + (1 - f) * 0.3, 0.005) << ior << " " << degrees;
            EXPECT_NEAR(seen.z, f + (1 - f) * 0.1, 0.005) << ior << " " << degrees;
        }
}
TEST(Light, RoughMetalsDarkenAsTheirFacetsDo) {
    // Light that meets several facets is coloured several times: rough metals are more saturated, and a white one loses nothing.
    const Color smooth = reflected(Bsdf({Material::Kind::metal, 0, 1.5, false}, {1, 0.5, 0.25}, false), at_angle(20)), rough = reflected(Bsdf({Material::Kind::metal, 1, 1.5, false}, {1, 0.5, 0.25}, false), at_angle(20));
    EXPECT_NEAR(smooth.y, 0.5, 0.01);
    EXPECT_NEAR(rough.x, 1, 0.01);
    EXPECT_LT(rough.y / rough.x, smooth.y / smooth.x - 0.03);
    EXPECT_LT(rough.z / rough.y, smooth.z / smooth.y - 0.03);
}
TEST(Light, MaterialsAreReciprocal) {
    Random random(7);
    for (const Material& m : materials())
        for (int i = 0; i < 50; ++i) {
            const Bsdf bsdf(m, {0.9, 0.5, 0.1}, false);
            const Point a = on_hemisphere({random.number(), random.number()}), b = on_hemisphere({random.number(), random.number()});
            const Color there = bsdf.value(a, b) / b.z, back = bsdf.value(b, a) / a.z;
            EXPECT_NEAR(there.y, back.y, 1e-9 * (1 + there.y));
        }
}
TEST(Light, SamplesHaveTheDensityThatIsTold) {
    Random random(8);
    const int n = 40000;
    for (const Material& m : materials()) {
        if (m.kind == Material::Kind::glass || m.roughness == 0 || m.roughness == 0.1) continue;  // one direction, or nearly
        const Bsdf bsdf(m, {0.7, 0.7, 0.7}, false);
        const Point out = at_angle(50);
        double told = 0, found = 0;  // that a direction has y > 0.2
        for (int i = 0; i < n; ++i) {
            const Point even = on_hemisphere({random.number(), random.number()});
            if (even.y > 0.2) told += bsdf.density(out, even) * kPi / even.z / n;
            const Bsdf::Sample s = bsdf.sample(out, random.number(), {random.number(), random.number()});
            if (s.density > 0 && s.direction.y > 0.2) found += 1.0 / n;
        }
        EXPECT_NEAR(told, found, 0.012) << int(m.kind) << " " << m.roughness;
    }
}

// ---- pictures: the middle of the floor z = 0, seen at 45 degrees from -y

constexpr const char* kFloor = R"("surfaces": {"floor": {"type": "bilinear", "points": [[-9,-9,0], [-9,9,0], [9,-9,0], [9,9,0]]}%s},
    "camera": {"eye": [0,-0.5,0.5], "target": [0,0,0], "up": [0,0,1], "fov": 0.05}, "image": {"width": 1, "height": 1, "samples": %d, "background": "black"},)";

Image picture(const std::string& surfaces, const std::string& objects, const std::string& lighting, int samples) {
    const test::TemporaryFolder folder;
    char head[2000];
    std::snprintf(head, sizeof head, kFloor, surfaces.c_str(), samples);
    test::write_all(folder / "s.json", "{\"isoparm\": 1, " + std::string(head) + "\"objects\": [" + objects + "], \"lighting\": " + lighting + "}");
    return render(load_scene(folder / "s.json"), {}).image;
}
double seen(const std::string& objects, const std::string& lights, int samples = 1024, const std::string& surfaces = "") {
    return double(picture(surfaces, objects, "{\"bounces\": 3, \"lights\": [" + lights + "]}", samples).at(0, 0)[1]);
}
/// Reflectance 0.5 linear.
const std::string kGrey = R"({"surface": "floor", "color": [0.7353569830524495, 0.7353569830524495, 0.7353569830524495], "back": [0.7353569830524495, 0.7353569830524495, 0.7353569830524495], "material": "diffuse"})";

TEST(Light, FloorsUnderKnownLightsHaveTheKnownRadiance) {
    // One direction at 60 degrees: 0.5 E cos(60) / pi.
    EXPECT_NEAR(seen(kGrey, R"({"type": "directional", "direction": [0.8660254037844386, 0, -0.5], "irradiance": 4})", 16), 0.5 * 4 * 0.5 / kPi, 1e-6);
    // The same through a disc of 20 degrees: E times the cosine of its middle, exactly.
    EXPECT_NEAR(seen(kGrey, R"({"type": "directional", "direction": [0.8660254037844386, 0, -0.5], "irradiance": 4, "angle": 20})"), 0.5 * 4 * 0.5 / kPi, 5e-4);
    // An even sky of radiance L: 0.5 L.
    EXPECT_NEAR(seen(kGrey, R"({"type": "environment", "radiance": 0.8})"), 0.5 * 0.8, 1e-6);
    // A sphere above the horizon, at distance 5 in a direction 0.6 off the normal's: E = pi L (r/d)^2 cos.
    EXPECT_NEAR(seen(kGrey, R"({"type": "sphere", "center": [4, 0, 3], "radius": 1.5, "radiance": 6})"), 0.5 * 6 * 0.09 * 0.6, 5e-4);
    // A square of half side a at height h, parallel, its middle above: E = L 4 a / sqrt(a^2 + h^2) atan(a / sqrt(a^2 + h^2)).
    const double a = 1, h = 2, r = std::sqrt(a * a + h * h);
    EXPECT_NEAR(seen(kGrey, R"({"type": "rectangle", "corner": [-1, -1, 2], "edges": [[0, 2, 0], [2, 0, 0]], "radiance": 3})"), 0.5 / kPi * 3 * 4 * a / r * std::atan(a / r), 1e-3);
    // Its other side is dark.
    EXPECT_EQ(seen(kGrey, R"({"type": "rectangle", "corner": [-1, -1, 2], "edges": [[2, 0, 0], [0, 2, 0]], "radiance": 3})"), 0);
}
TEST(Light, HalfAHiddenLightIsHalfTheLight) {
    // A half-plane x < 0 between the floor and the light: by symmetry the point under its edge gets half of the square's light.
    const std::string light = R"({"type": "rectangle", "corner": [-1, -1, 2], "edges": [[0, 2, 0], [2, 0, 0]], "radiance": 3})";
    const std::string screen = R"(, "screen": {"type": "bilinear", "points": [[-9,-0.5,1], [-9,9,1], [0,-0.5,1], [0,9,1]]})";
    const std::string objects = kGrey + R"(, {"surface": "screen", "color": "black", "back": "black", "material": "diffuse"})";
    EXPECT_NEAR(seen(objects, light, 4096, screen), 0.5 * seen(kGrey, light, 4096), 3e-3);
    // All of it is hidden from a point under the screen: not to see a shadow would be 0.2.
    const std::string more = R"(, "screen": {"type": "bilinear", "points": [[-9,-9,1], [-9,9,1], [9,-9,1], [9,9,1]]})";
    EXPECT_LT(seen(objects, light, 256, more), 1e-3);
}
/// A pane of index 1.5 that large at that height.
std::string pane_at(double z) { return ", \"pane\": {\"type\": \"bilinear\", \"points\": [[-9,-9," + std::to_string(z) + "], [-9,9," + std::to_string(z) + "], [9,-9," + std::to_string(z) + "], [9,9," + std::to_string(z) + "]]}"; }
std::string pane(const std::string& more = "") { return R"(, {"surface": "pane", "material": {"type": "glass", "thin": true})" + more + "}"; }

TEST(Light, PanesLetTheSunThrough) {
    // Direct light alone: panes throw back what the floor sends up.
    const auto lit = [](const std::string& objects, const std::string& lamp, const std::string& surfaces) { return double(picture(surfaces, objects, R"({"bounces": 0, "lights": [)" + lamp + "]}", 16).at(0, 0)[1]); };
    const std::string down = R"({"type": "directional", "direction": [0, 0, -1], "irradiance": 4})", aslant = R"({"type": "directional", "direction": [0.8660254037844386, 0, -0.5], "irradiance": 4})";
    const double f0 = 2 * 0.04 / 1.04, f60 = pane_fresnel(0.5, 1.5);
    EXPECT_NEAR(f60, 2 * fresnel(0.5, 1.5) / (1 + fresnel(0.5, 1.5)), 1e-15);
    EXPECT_NEAR(lit(kGrey + pane(), down, pane_at(1)), (1 - f0) * lit(kGrey, down, ""), 1e-6);
    EXPECT_NEAR(lit(kGrey + pane(), aslant, pane_at(1)), (1 - f60) * lit(kGrey, aslant, ""), 1e-6);
    // Tinted (0.5 linear), and two over each other; half as opaque.
    const std::string tint = R"(, "color": [0.7353569830524495, 0.7353569830524495, 0.7353569830524495])", two = pane_at(1) + R"(, "second": {"type": "bilinear", "points": [[-9,-9,1.5], [-9,9,1.5], [9,-9,1.5], [9,9,1.5]]})";
    EXPECT_NEAR(lit(kGrey + pane(tint), down, pane_at(1)), 0.5 * (1 - f0) * lit(kGrey, down, ""), 1e-6);
    EXPECT_NEAR(lit(kGrey + pane(tint) + R"(, {"surface": "second", "material": {"type": "glass", "thin": true}})", down, two), 0.5 * (1 - f0) * (1 - f0) * lit(kGrey, down, ""), 1e-6);
    EXPECT_NEAR(lit(kGrey + pane(tint + ", \"opacity\": 0.5"), down, pane_at(1)), (0.5 * 0.5 * (1 - f0) + 0.5) * lit(kGrey, down, ""), 1e-6);
    // What is opaque behind it hides the light still.
    EXPECT_EQ(lit(kGrey + pane() + R"(, {"surface": "second", "color": "black", "back": "black", "material": "diffuse"})", down, two), 0);
}
TEST(Light, PanesLetLampsAndSkiesThrough) {
    // A square of half side 1 at height 2, by quadrature over it: L cos^2 / d^2 times what the pane between lets through. Found from both ends: at its size, and smaller, where directions seldom find it.
    for (const double a : {1.0, 0.2}) {
        const int n = 200;
        double irradiance = 0;
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n; ++k) {
                const double x = a * (2 * (i + 0.5) / n - 1), y = a * (2 * (k + 0.5) / n - 1), d2 = x * x + y * y + 4, cosine = 2 / std::sqrt(d2);
                irradiance += 3 * cosine * cosine / d2 * (1 - pane_fresnel(cosine, 1.5)) * (4 * a * a / n / n);
            }
        const std::string side = std::to_string(a), lamp = "{\"type\": \"rectangle\", \"corner\": [-" + side + ",-" + side + ",2], \"edges\": [[0," + std::to_string(2 * a) + ",0], [" + std::to_string(2 * a) + ",0,0]], \"radiance\": 3}";
        EXPECT_NEAR(seen(kGrey + pane(), lamp, 4096, pane_at(1)), 0.5 / kPi * irradiance, 0.004 * irradiance) << a;
        EXPECT_NEAR(seen(kGrey + pane(), lamp, 4096, pane_at(2.5)), seen(kGrey, lamp, 4096), 0.02 * irradiance) << "a lamp before the pane is not tinted by it";
    }
    // An even sky above a wide pane: of it T comes through, and of what the floor sends up R comes back: l = 0.5 (T + R l).
    double r = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i) r += pane_fresnel(std::sqrt((i + 0.5) / n), 1.5) / n;
    const double l = 0.5 * (1 - r) / (1 - 0.5 * r);
    const auto lit = [&](const std::string& objects, const std::string& more) { return double(picture(pane_at(0.6), objects, R"({"bounces": 16, "lights": [{"type": "environment", "radiance": 1}])" + more + "}", 4096).at(0, 0)[1]); };
    EXPECT_NEAR(lit(kGrey + pane(), ""), l, 0.006);
    EXPECT_NEAR(lit(kGrey + pane(), R"(, "caustics": true)"), l, 0.006);
}
TEST(Light, GlassHasOneColourFromBothSides) {
    // A clear body of glass, and white sheets seen from behind, in an even sky: nothing is gained, and nothing lost but what the last bounce leaves.
    const auto lit = [](const std::string& object) {
        return double(picture(R"(, "body": {"type": "subdivision", "vertices": [[-1,-1,-1],[1,-1,-1],[1,1,-1],[-1,1,-1],[-1,-1,1],[1,-1,1],[1,1,1],[-1,1,1]], "faces": [[0,3,2,1],[4,5,6,7],[0,1,5,4],[1,2,6,5],[2,3,7,6],[3,0,4,7]]}, "down": {"type": "bilinear", "points": [[-9,-9,0],[9,-9,0],[-9,9,0],[9,9,0]]})",
                              object, R"({"bounces": 64, "lights": [{"type": "environment", "radiance": 1, "seen": true}]})", 1024).at(0, 0)[1]);
    };
    EXPECT_NEAR(lit(R"({"surface": "body", "material": "glass"})"), 1, 0.002);
    EXPECT_NEAR(lit(R"({"surface": "floor", "color": "white", "material": "diffuse"})"), 1, 0.002);
    EXPECT_NEAR(lit(R"({"surface": "down", "color": "white", "material": "diffuse"})"), 1, 0.002);
}
TEST(Light, SheetsLetTheirPartThrough) {
    const std::string sheets = R"(, "a": {"type": "bilinear", "points": [[-9,-9,1], [-9,9,1], [9,-9,1], [9,9,1]]}, "b": {"type": "bilinear", "points": [[-9,-9,1.5], [-9,9,1.5], [9,-9,1.5], [9,9,1.5]]})";
    const std::string objects = kGrey + R"(, {"surface": "a", "color": "black", "opacity": 0.3, "material": "diffuse"}, {"surface": "b", "color": "black", "opacity": 0.6, "material": "diffuse"})";
    const std::string sun = R"({"type": "directional", "direction": [0, 0, -1], "irradiance": 4})", sky = R"({"type": "environment", "radiance": 1})";
    EXPECT_NEAR(seen(objects, sun, 64, sheets), 0.7 * 0.4 * seen(kGrey, sun, 64), 1e-6);
    // By chance, sheet by sheet; some per cent of the sky are seen below the sheets' rims.
    EXPECT_NEAR(seen(objects, sky, 4096, sheets), 0.7 * 0.4 * 0.5 + 0.5 * (1 / 82.0) * 0.7, 0.01);
    EXPECT_NEAR(seen(kGrey + R"(, {"surface": "a", "color": "black", "opacity": 0, "material": "diffuse"})", sky, 64, sheets), 0.5, 1e-6);
}
TEST(Light, MirrorsShowLightsAsBrightAsTheyAre) {
    const std::string mirror = R"({"surface": "floor", "color": "white", "back": "white", "material": {"type": "metal", "roughness": 0}})";
    // Where the camera's ray goes on, at 45 degrees toward +y.
    EXPECT_NEAR(seen(mirror, R"({"type": "sphere", "center": [0, 5, 5], "radius": 1, "radiance": 6})", 256), 6, 0.02);
    EXPECT_NEAR(seen(mirror, R"({"type": "sphere", "center": [0, 5, 9], "radius": 1, "radiance": 6})", 256), 0, 0.02);
}
TEST(Light, BothWaysToFindALightAddUp) {
    // Shiny plastic under a near, wide light: directions from the light and from the coat share the work. By quadrature over the light:
    const Bsdf bsdf({Material::Kind::plastic, 0.5, 1.5, false}, {0.5, 0.5, 0.5}, false);
    const Point out = normalized(Point{0, -1, 1});
    double sum = 0;
    const int n = 400;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const Point to{-1 + (i + 0.5) * 2 / n, 1 + (k + 0.5) * 2 / n, 2}, in = normalized(to);
            sum += bsdf.value(out, in).y * in.z / dot(to, to) * (2.0 / n) * (2.0 / n);  // the light's cosine is in.z
        }
    std::string plastic = kGrey;
    plastic.replace(plastic.find("\"diffuse\""), 9, R"({"type": "plastic", "roughness": 0.5})");
    EXPECT_NEAR(seen(plastic, R"({"type": "rectangle", "corner": [-1, 1, 2], "edges": [[0, 2, 0], [2, 0, 0]], "radiance": 3})", 4096), 3 * sum, 0.005 * 3 * sum);
}
TEST(Light, FurnacesAreEven) {
    // A white ball on a white floor under a white sky: everything is as bright as the sky.
    const test::TemporaryFolder folder;
    test::write_all(folder / "s.json", R"({"isoparm": 1, "surfaces": {"floor": {"type": "bilinear", "points": [[-9,-9,0], [-9,9,0], [9,-9,0], [9,9,0]]}},
        "objects": [{"surface": "floor", "color": "white", "back": "white", "material": "diffuse"}, {"point": [0,0,1], "radius": 1, "color": "white", "material": {"type": "plastic", "roughness": 0}}],
        "camera": {"eye": [0,-6,5], "target": [0,0,0.6], "up": [0,0,1], "fov": 20}, "image": {"width": 24, "height": 18, "samples": 64},
        "lighting": {"bounces": 64, "lights": [{"type": "environment", "radiance": 1}]}})");
    const Scene scene = load_scene(folder / "s.json");
    const Image whole = render(scene, {}).image;
    double sum = 0;
    for (int y = 0; y < whole.height; ++y)
        for (int x = 0; x < whole.width; ++x) {
            EXPECT_NEAR(whole.at(x, y)[1], 1, 0.16) << x << "," << y;
            sum += whole.at(x, y)[1];
        }
    EXPECT_NEAR(sum / (24 * 18), 1, 0.004);
    // A crop has the whole picture's pixels.
    RenderOptions crop;
    crop.crop = {7, 3, 20, 12};
    const Image part = render(scene, crop).image;
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x) EXPECT_EQ(part.at(x, y)[1], whole.at(x + 7, y + 3)[1]);
}
TEST(Light, DarkLightsChangeNothing) {
    // A floor that is lit by way of a shiny wall only, without caustics: what both ways to find a light share must not depend on how many there are.
    const std::string wall = R"(, "wall": {"type": "bilinear", "points": [[-9,1,0], [-9,1,9], [9,1,0], [9,1,9]]})";
    const std::string objects = kGrey + R"(, {"surface": "wall", "color": [0.3,0.3,0.3], "back": [0.3,0.3,0.3], "material": {"type": "plastic", "roughness": 0.7, "ior": 2.5}})";
    const std::string light = R"({"type": "rectangle", "corner": [-2, 0.5, 0.02], "edges": [[0, 0, 4], [4, 0, 0]], "radiance": 6})";
    std::string dark;
    for (int k = 0; k < 9; ++k) dark += R"(, {"type": "sphere", "center": [0, 0, -50], "radius": 1, "radiance": 0})";
    const double alone = seen(objects, light, 16384, wall), among = seen(objects, light + dark, 16384, wall);
    EXPECT_GT(alone, 0.005);
    EXPECT_NEAR(among, alone, 0.03 * alone);
}
TEST(Light, CausticsAreFollowedWhereTheyAreWanted) {
    // A white floor, and a mirror upright beside it that throws the light of a small sphere onto it.
    const std::string wall = R"(, "wall": {"type": "bilinear", "points": [[-9,1,0], [-9,1,9], [9,1,0], [9,1,9]]})";
    const std::string objects = kGrey + R"(, {"surface": "wall", "color": "white", "back": "white", "material": {"type": "metal", "roughness": 0}})";
    const std::string light = R"("lights": [{"type": "sphere", "center": [0, -3, 3], "radius": 1, "radiance": 6}]})";
    const auto green = [&](const std::string& caustics) { return double(picture(wall, objects, "{\"bounces\": 2, \"caustics\": " + caustics + ", " + light, 16384).at(0, 0)[1]); };
    const double direct = 0.5 * 6 / 18 * std::sqrt(0.5);                         // pi L (r/d)^2 cos, over pi
    const double mirrored = 0.5 * 6 / 34 * 3 / std::sqrt(34.0);                  // of the sphere's image at (0, 5, 3)
    EXPECT_NEAR(green("false"), direct, 2e-3);
    EXPECT_NEAR(green("true"), direct + mirrored, 4e-3);
}

}  // namespace
}  // namespace isoparm
