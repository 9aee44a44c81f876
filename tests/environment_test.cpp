// environment_test.cpp -- images as skies, and a ground that shows only shadows, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "error.h"
#include "light/bsdf.h"
#include "light/environment.h"
#include "light/lights.h"
#include "picture/picture.h"
#include "run_program.h"
#include "samples.h"

namespace isoparm {
namespace {

using test::TemporaryFolder;
using test::write_all;
using tests::Random;

constexpr double kPi = std::numbers::pi;

/// radiance(longitude, latitude) in degrees at the middles of pixels: longitude from +x toward +y.
template <class F> std::vector<float> image_of(int height, F radiance) {
    std::vector<float> rgb;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x) {
            const float c = static_cast<float>(radiance(180 - (x + 0.5) * 180 / height, 90 - (y + 0.5) * 180 / height));
            rgb.insert(rgb.end(), {c, c, c});
        }
    return rgb;
}
EnvironmentImage environment(int height, std::vector<float> rgb) { return {2 * height, height, std::move(rgb)}; }

void write_environment(const std::string& path, int height, const std::vector<float>& rgb) {
    Image image{2 * height, height, {}};
    for (std::size_t i = 0; i < rgb.size(); i += 3) image.pixels.insert(image.pixels.end(), {rgb[i], rgb[i + 1], rgb[i + 2], 1.0f});
    write_image(path, image, {});
}

Point even(Random& random) {
    const double z = random.number(-1, 1), phi = random.number(0, 2 * kPi), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

TEST(Environment, SamplesHaveTheDensityThatIsTold) {
    Random random(1);
    std::vector<float> rgb = image_of(8, [&](double, double) { return random.number() < 0.3 ? 0.0 : std::pow(10.0, random.number(-3, 3)); });
    const EnvironmentImage e = environment(8, rgb);
    double whole = 0, above_told = 0, above_found = 0, light = 0, light_told = 0;
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
        const Point d = even(random);
        const double told = e.density(d) * 4 * kPi / n;
        whole += told, above_told += d.z > 0.3 ? told : 0;
        light += e.radiance(d).x * 4 * kPi / n;
        const auto s = e.sample({random.number(), random.number()});
        ASSERT_GT(s.density, 0);
        EXPECT_NEAR(e.density(s.direction), s.density, 1e-6 * s.density);
        above_found += s.direction.z > 0.3 ? 1.0 / n : 0;
        light_told += e.radiance(s.direction).x / s.density / n;
    }
    EXPECT_NEAR(whole, 1, 0.02);
    EXPECT_NEAR(above_told, above_found, 0.02);
    EXPECT_NEAR(light, light_told, 0.02 * light);
}
TEST(Environment, ASingleBrightPixelIsFoundAndWhole) {
    std::vector<float> rgb(3 * 2 * 64 * 64, 0.0f);
    const std::size_t at = 3 * (20 * 128 + 127);  // in the last column: the interpolation goes around
    rgb[at] = rgb[at + 1] = rgb[at + 2] = 5e4f;
    const EnvironmentImage e = environment(64, rgb);
    Random random(2);
    double found = 0, exact = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto s = e.sample({random.number(), random.number()});
        found += e.radiance(s.direction).y / s.density / 20000;
    }
    for (int y = 0; y < 512; ++y)  // by rows: eight to a pixel's
        for (int x = 0; x < 1024; ++x) {
            const double theta = kPi * (y + 0.5) / 512, phi = kPi - 2 * kPi * (x + 0.5) / 1024;
            exact += e.radiance({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}).y * std::sin(theta) * (kPi / 512) * (2 * kPi / 1024);
        }
    EXPECT_NEAR(found, exact, 0.02 * exact);
    EXPECT_GT(exact, 1);
}
TEST(Environment, BlackImagesGiveNothing) {
    const EnvironmentImage e = environment(2, std::vector<float>(24, 0.0f));
    EXPECT_EQ(e.sample({0.5, 0.5}).density, 0);
    EXPECT_EQ(e.density({0, 0, 1}), 0);
}

/// Irradiance of a plane by samples.
Color irradiance(const Lights& lights, const Point& at, const Point& up, int n = 40000) {
    Random random(3);
    Color sum;
    for (int i = 0; i < n; ++i) {
        const auto s = lights.sample(at, random.number(), {random.number(), random.number()});
        sum += std::max(0.0, dot(up, s.direction)) * s.radiance;
    }
    return sum / double(n);
}
Light image_light(double turn, const Point& up = {0, 0, 1}) {
    Light l;
    l.kind = Light::Kind::environment;
    l.image = "x", l.turn = turn, l.direction = up;
    return l;
}
Lights of_image(const EnvironmentImage& e, double turn, const Point& up = {0, 0, 1}) {
    return Lights({image_light(turn, up)}, make_camera({}, {}, 10, 10), {std::make_shared<const EnvironmentImage>(e)});
}

TEST(Environment, KnownImagesGiveTheKnownIrradiance) {
    const auto half = environment(60, image_of(60, [](double longitude, double) { return std::fabs(longitude) < 90 ? 2.0 : 0.0; }));
    const auto cap = environment(60, image_of(60, [](double, double latitude) { return latitude > 30 ? 2.0 : 0.0; }));
    // Bright where x > 0: all that a wall sees that faces it, half of what a floor sees, none of what a wall behind sees.
    EXPECT_NEAR(irradiance(of_image(half, 0), {}, {1, 0, 0}).y, 2 * kPi, 0.03);
    EXPECT_NEAR(irradiance(of_image(half, 0), {}, {0, 0, 1}).y, kPi, 0.03);
    EXPECT_NEAR(irradiance(of_image(half, 0), {}, {-1, 0, 0}).y, 0, 0.03);
    // Turned by 90 degrees: where y > 0. Lying: the image's x is the scene's, its z the scene's y.
    EXPECT_NEAR(irradiance(of_image(half, kPi / 2), {}, {0, 1, 0}).y, 2 * kPi, 0.03);
    EXPECT_NEAR(irradiance(of_image(cap, 0), {}, {0, 0, 1}).y, 2 * kPi * 0.75, 0.05);  // pi L sin^2 60
    EXPECT_NEAR(irradiance(of_image(cap, 0, {0, 1, 0}), {}, {0, 1, 0}).y, 2 * kPi * 0.75, 0.05);
    EXPECT_NEAR(of_image(cap, 0).sky_irradiance({0, 0, 1}).y, irradiance(of_image(cap, 0), {}, {0, 0, 1}).y, 0.02);
}
TEST(Environment, LampsGiveTheIrradianceThatIsTold) {
    Random random(4);
    for (int i = 0; i < 40; ++i) {
        Light l;
        l.kind = i % 3 == 0 ? Light::Kind::directional : i % 3 == 1 ? Light::Kind::sphere : Light::Kind::rectangle;
        l.power = {1, 2, 3};
        l.direction = even(random), l.at = random.number(1.2, 3) * even(random);
        l.radius = i % 3 == 0 ? random.number(0, 1.4) : random.number(0.1, 1.1);
        const Point a = even(random), b = normalized(cross(a, even(random)));
        l.edges = {random.number(0.5, 3) * a, random.number(0.5, 3) * b};
        const Lights lights({l}, make_camera({}, {}, 10, 10), {});
        const Point up = even(random);
        const Color found = irradiance(lights, {}, up), told = lights.irradiance({}, up);
        EXPECT_NEAR(found.y, told.y, 0.02 * told.y + 0.005) << i;
    }
}

// ---- pictures

std::string scene_text(const std::string& objects, const std::string& rest) {
    return R"({"isoparm": 1, "surfaces": {"floor": {"type": "bilinear", "points": [[-9,-9,0], [-9,9,0], [9,-9,0], [9,9,0]]}}, "objects": [)" + objects + "], " + rest + "}";
}
const std::string kAtTheMiddle = R"("camera": {"eye": [0,-6,0.9], "target": [0,0,0], "up": [0,0,1], "fov": 0.02}, )";

/// By the program: images are decoded by a fork of a process without threads.
Image rendered(const std::string& scene) {
    const TemporaryFolder folder;
    const test::Outcome o = test::run("render '" + scene + "' --quiet -o " + folder / "p.exr");
    EXPECT_EQ(o.code, 0) << o.err;
    return read_image(folder / "p.exr");
}

TEST(Environment, ConstantImagesAreAsEvenSkies) {
    const TemporaryFolder folder;
    write_environment(folder / "sky.exr", 4, image_of(4, [](double, double) { return 0.5; }));
    const std::string objects = R"({"surface": "floor", "material": "diffuse"}, {"point": [0,0,1], "radius": 1, "material": {"type": "metal", "roughness": 0.8}}, {"point": [2,0,1], "radius": 0.9, "material": "glass"})";
    const std::string view = R"("camera": {"eye": [0,-6,5], "target": [1,0,0.6], "up": [0,0,1], "fov": 30}, "image": {"width": 24, "height": 18, "samples": 256}, "lighting": {"bounces": 5, "lights": [)";
    write_all(folder / "image.json", scene_text(objects, view + R"({"type": "environment", "image": "sky.exr", "radiance": 2}]})"));
    write_all(folder / "even.json", scene_text(objects, view + R"({"type": "environment", "radiance": 1}]})"));
    const Image a = rendered(folder / "image.json"), b = rendered(folder / "even.json");
    double sums[2] = {0, 0}, most = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) sums[0] += double(a.pixels[i]), sums[1] += double(b.pixels[i]), most = std::max(most, std::fabs(double(a.pixels[i]) - double(b.pixels[i])));
    EXPECT_NEAR(sums[0], sums[1], 0.002 * sums[1]);
    EXPECT_LT(most, 0.2);
}
TEST(Environment, CamerasSeeThemWhereTheyShould) {
    const TemporaryFolder folder;
    write_environment(folder / "sky.exr", 16, image_of(16, [](double longitude, double) { return std::fabs(longitude - 90) < 30 ? 0.25 : 0.0; }));  // toward +y
    const std::string rest = R"("camera": {"eye": [0,-6,1], "target": [0,0,1], "up": [0,0,1], "fov": 5}, "image": {"width": 4, "height": 4, "samples": 4}, "lighting": {"lights": [{"type": "environment", "image": "sky.exr", "radiance": 2)";
    const std::string ball = R"({"point": [0,-20,1], "radius": 0.1})";
    write_all(folder / "seen.json", scene_text(ball, rest + R"(, "seen": true}]})"));
    write_all(folder / "other.json", scene_text(ball, rest + R"(, "seen": true, "rotation": 90}]})"));
    write_all(folder / "unseen.json", scene_text(ball, rest + "}]}"));
    EXPECT_NEAR(double(rendered(folder / "seen.json").at(2, 2)[1]), 0.5, 1e-3);
    EXPECT_EQ(rendered(folder / "other.json").at(2, 2)[1], 0.0f);
    EXPECT_EQ(rendered(folder / "unseen.json").at(2, 2)[1], 1.0f);  // the white background
}
TEST(Environment, WrongImagesAreTold) {
    const TemporaryFolder folder;
    const auto code = [&](const std::string& name) {
        write_all(folder / "s.json", scene_text(R"({"point": [0,0,1]})", R"("image": {"width": 4, "height": 4, "samples": 1}, "lighting": {"lights": [{"type": "environment", "image": ")" + name + R"("}]})"));
        return test::run("render s.json -o p.png --quiet", folder.path());
    };
    EXPECT_EQ(code("none.exr").code, 4);
    EXPECT_EQ(code("../x.exr").code, 65);
    EXPECT_EQ(code("/etc/passwd").code, 65);
    EXPECT_EQ(code("s.json").code, 4);
    write_all(folder / "empty.hdr", "");
    EXPECT_EQ(code("empty.hdr").code, 4);
    write_all(folder / "huge.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 900000000 +X 900000000\nxxxx");
    EXPECT_EQ(code("huge.hdr").code, 4);
    Image square{4, 4, std::vector<float>(64, 1.0f)};
    write_image(folder / "square.exr", square, {});
    EXPECT_EQ(code("square.exr").code, 65);
    std::vector<float> bad = image_of(2, [](double, double) { return 1.0; });
    bad[5] = -1;
    write_environment(folder / "bad.exr", 2, bad);
    const test::Outcome negative = code("bad.exr");
    EXPECT_EQ(negative.code, 65);
    EXPECT_NE(negative.err.find("found the value -1"), std::string::npos) << negative.err;
    // A small .hdr file: 2 x 1 pixels of RGBE, 1.0 and 0.5.
    write_all(folder / "good.hdr", std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") + std::string("\x80\x80\x80\x81\x80\x80\x80\x80", 8));
    const test::Outcome good = code("good.hdr");
    EXPECT_EQ(good.code, 0) << good.err;
}

// ---- the ground

const float* middle(const Image& image) { return image.at(image.width / 2, image.height / 2); }

TEST(Ground, ShadowsAreAsDarkAsGeometrySays) {
    // Under a black ball of radius 1 whose middle is 3 above, an even sky lacks the ball's part: (1/3)^2.
    const TemporaryFolder folder;
    const auto alpha = [&](const std::string& object, const std::string& lighting, const std::string& ground = R"({"height": 0})", const char* background = "transparent") {
        write_all(folder / "s.json", scene_text(object, kAtTheMiddle + R"("image": {"width": 3, "height": 3, "samples": 1024, "background": ")" + background + R"("}, "ground": )" + ground + R"(, "lighting": )" + lighting));
        const bool decodes = lighting.find("sky.exr") != std::string::npos;
        const Image image = decodes ? rendered(folder / "s.json") : render(load_scene(folder / "s.json"), {}).image;
        return std::array{double(middle(image)[3]), double(middle(image)[1])};
    };
    const std::string black = R"({"point": [0,0,3], "radius": 1, "color": "black", "material": "diffuse"})", white = R"({"point": [0,0,3], "radius": 1, "color": "white", "material": "diffuse"})";
    const std::string sky = R"({"bounces": 40, "lights": [{"type": "environment", "radiance": 0.7}]})";
    EXPECT_NEAR(alpha(black, sky)[0], 1 / 9.0, 0.002);
    EXPECT_NEAR(alpha(black, sky)[1], 0, 1e-6);
    EXPECT_NEAR(alpha(black, sky, R"({"height": 0, "shadow": 0.5})")[0], 0.5 / 9.0, 0.001);
    EXPECT_NEAR(alpha(black, sky, R"({"height": 0})", "white")[1], 1 - 1 / 9.0, 0.002);
    // A furnace: a white ball in an even sky takes nothing away.
    EXPECT_NEAR(alpha(white, sky)[0], 0, 0.003);
    // A sun straight above is hidden whole; one of 30 degrees behind a ball of half that width: all but sin^2.
    EXPECT_NEAR(alpha(black, R"({"lights": [{"type": "directional", "direction": [0,0,-1], "irradiance": 3}]})")[0], 1, 1e-6);
    const double ball = 1 / 9.0, sun = std::pow(std::sin(30 * kPi / 180), 2);
    EXPECT_NEAR(alpha(black, R"({"lights": [{"type": "directional", "direction": [0,0,-1], "irradiance": 3, "angle": 60}]})")[0], ball / sun, 0.006);
    // A lamp right behind the ball, in its shadow; and an image as the sky.
    EXPECT_NEAR(alpha(black, R"({"lights": [{"type": "sphere", "center": [0,0,9], "radius": 0.5, "radiance": 5}]})")[0], 1, 1e-6);
    write_environment(folder / "sky.exr", 4, image_of(4, [](double, double) { return 0.5; }));
    EXPECT_NEAR(alpha(black, R"({"bounces": 3, "lights": [{"type": "environment", "image": "sky.exr"}]})")[0], 1 / 9.0, 0.006);
}
TEST(Ground, PaperWithoutShadowIsWhiteToTheBit) {
    // Far from the ball nothing is hidden, whatever the lights.
    for (const std::string& lighting : {std::string(), std::string(R"("lighting": "studio", )"),
                                        std::string(R"("lighting": {"lights": [{"type": "sphere", "center": [3,0,4], "radius": 1, "radiance": 5}, {"type": "environment", "radiance": 1}]}, )")}) {
        const TemporaryFolder folder;
        write_all(folder / "s.json", scene_text(R"({"point": [-3000,2000,1], "radius": 1})", lighting + kAtTheMiddle + R"("ground": true, "image": {"width": 3, "height": 3, "samples": 16, "background": "transparent"})"));
        const Image image = render(load_scene(folder / "s.json"), {}).image;
        for (const float c : image.pixels) EXPECT_EQ(c, 0.0f) << lighting;
    }
}
TEST(Ground, DarkensABackgroundAndAddsNoLight) {
    // Light of two colours: shadows are not grey.
    const auto picture = [&](const char* background) {
        const TemporaryFolder folder;
        write_all(folder / "s.json", scene_text(R"({"point": [0,0,1], "radius": 1})", R"("lighting": {"lights": [{"type": "directional", "direction": [1,1,-1], "irradiance": [3,1,0.2]}, {"type": "environment", "radiance": [0.1,0.3,0.9]}]},
            "camera": {"eye": [0,-9,8], "target": [0,0,0], "up": [0,0,1]}, "image": {"width": 24, "height": 18, "samples": 64, "background": ")" + std::string(background) + R"("}, "ground": true)"));
        return render(load_scene(folder / "s.json"), {}).image.pixels;
    };
    const auto black = picture("black"), white = picture("white"), colored = picture("#00ff00");
    int shadows = 0;
    for (std::size_t i = 0; i < white.size(); i += 4) {
        for (int k = 0; k < 3; ++k) EXPECT_GE(black[i + k], -1e-6f);
        if (black[i] + black[i + 1] + black[i + 2] > 1e-6f) continue;  // the ball
        shadows += white[i] < 0.95f;
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(colored[i + k], k == 1 ? white[i + 1] : 0, 1e-5);
    }
    EXPECT_GT(shadows, 5);
}
TEST(Ground, IsHiddenByWhatLiesInIt) {
    // A square that is the lowest thing there is, far from the origin and aslant to its float coordinates: no speck of ground shows through.
    const TemporaryFolder folder;
    write_all(folder / "s.json", R"({"isoparm": 1, "surfaces": {"s": {"type": "bezier", "points": [[[96.7,7.1,4.3],[97.3,9.2,4.3]],[[98.8,6.5,4.3],[99.4,8.6,4.3]]]}},
        "objects": [{"surface": "s", "boundary": false}], "camera": {"eye": [95,2,20], "target": [98.05,7.85,4.3], "fov": 3},
        "image": {"width": 64, "height": 48, "samples": 4, "background": "transparent"}, "ground": true})");
    for (const bool exact : {false, true}) {
        RenderOptions options;
        options.exact = exact;
        const Image image = render(load_scene(folder / "s.json"), options).image;
        for (std::size_t i = 3; i < image.pixels.size(); i += 4) ASSERT_EQ(image.pixels[i], 1.0f) << i << " " << exact;
    }
}
TEST(Ground, LiesUnderTheLowestPoint) {
    const TemporaryFolder folder;
    const auto picture = [&](const std::string& ground) {
        write_all(folder / "s.json", scene_text(R"({"point": [0,0,5], "radius": 1.5}, {"point": [2,0,5], "radius": 1})", R"("camera": {"eye": [0,-9,8], "target": [0,0,4], "up": [0,0,1]}, "image": {"width": 24, "height": 18, "samples": 16, "background": "transparent"}, "ground": )" + ground));
        return render(load_scene(folder / "s.json"), {}).image.pixels;
    };
    const auto found = picture("true");
    EXPECT_EQ(found, picture(R"({"height": 3.5})"));
    EXPECT_NE(found, picture("false"));
    EXPECT_NE(found, picture(R"({"height": 3})"));
    EXPECT_EQ(picture(R"({"up": [0,0,1e200]})"), found);
    for (const float c : found) {
        EXPECT_GE(c, 0.0f);
        EXPECT_LE(c, 1.0f);
    }
}


// ---- through glass

TEST(Page, IsSeenThroughGlassAsBesideIt) {
    // A pane, and two panes that bound a body, before the ground in the shadow of a black ball under an even sky of 0.7; what they mirror is the sky.
    const auto seen = [&](const char* glass, const char* background, const std::string& lights, bool ground, bool exact) {
        const TemporaryFolder folder;
        const std::string material = std::string(R"(, "boundary": false, "material": {"type": "glass", "thin": )") + (std::string(glass) == "pane" ? "true}}" : "false}}");
        write_all(folder / "s.json", R"({"isoparm": 1, "surfaces": {"pane": {"type": "bilinear", "points": [[-1,-3,0.01],[1,-3,0.01],[-1,-3,1],[1,-3,1]]}, "back": {"type": "bilinear", "points": [[1,-2.9,0.01],[-1,-2.9,0.01],[1,-2.9,1],[-1,-2.9,1]]},
            "body": {"type": "composite", "members": ["pane", "back"]}}, "objects": [{"surface": ")" + std::string(glass) + "\"" + material + R"(, {"point": [0,0,3], "radius": 1, "color": "black", "material": "diffuse"}], )" + kAtTheMiddle +
            R"("image": {"width": 3, "height": 3, "samples": 1024, "background": ")" + background + R"("}, "ground": )" + (ground ? R"({"height": 0})" : "false") + R"(, "lighting": {"bounces": 12, "lights": [)" + lights + "]}}");
        RenderOptions options;
        options.exact = exact;
        const Image image = render(load_scene(folder / "s.json"), options).image;
        EXPECT_EQ(middle(image)[3], 1.0f) << "glass hides in alpha, whatever the page is";
        return double(middle(image)[1]);
    };
    const double cosine = 6 / std::hypot(6, 0.9), pane = pane_fresnel(cosine, 1.5), once = fresnel(cosine, 1.5), body = 1 - (1 - once) * (1 - once);
    const std::string sky = R"({"type": "environment", "radiance": 0.7})", lamp = R"({"type": "sphere", "center": [0,2,-0.3], "radius": 0.2, "radiance": 100})", seen_sky = R"({"type": "environment", "radiance": 0.7, "seen": true})";
    for (const bool exact : {false, true})
        for (const auto& [glass, mirrored] : {std::pair("pane", pane), {"body", body}}) {
            for (const auto& [background, page] : {std::pair("white", 1.0), {"transparent", 1.0}, {"black", 0.0}}) {
                EXPECT_NEAR(seen(glass, background, sky, true, exact), mirrored * 0.7 + (1 - mirrored) * page * (1 - 1 / 9.0), 0.004) << glass << background << exact;
                EXPECT_NEAR(seen(glass, background, sky, false, exact), mirrored * 0.7 + (1 - mirrored) * page, 0.002) << glass << background << exact;
            }
            if (mirrored == pane) EXPECT_NEAR(seen(glass, "white", lamp, false, exact), 1 - mirrored, 0.002) << "lamps are not seen but in mirrors, as a body's second side is one; and mirrored is the dark";
            EXPECT_NEAR(seen(glass, "black", seen_sky, false, exact), 0.7, 1e-6) << "environments that are seen are seen";
        }
}

}  // namespace
}  // namespace isoparm
