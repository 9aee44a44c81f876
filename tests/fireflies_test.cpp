// fireflies_test.cpp -- single bright pixels are spread over their neighbours: no light is lost, little else changes.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <sstream>

#include "picture/fireflies.h"
#include "picture/picture.h"
#include "run_program.h"
#include "samples.h"

namespace isoparm {
namespace {

using test::TemporaryFolder;
using test::write_all;

void add(Film& film, int x, int y, const Color& c, double alpha = 1) {
    const FilmPixel p = film.pixel(x, y);
    p.sum.color += c, p.sum.alpha += alpha, ++p.sum.used, ++p.sum.seen;
    if (c.x + c.y + c.z > p.brightest->x + p.brightest->y + p.brightest->z) *p.brightest = c;
}
/// Samples between 0 and twice `level`.
Film even_film(const Area& area, int samples, double level, std::uint32_t seed) {
    Film film(area, samples, 0, {false, true});
    tests::Random random(seed);
    for (int y = area.y0; y < area.y1; ++y)
        for (int x = area.x0; x < area.x1; ++x)
            for (int i = 0; i < samples; ++i) add(film, x, y, 2 * level * random.number() * Color{1, 0.8, 0.6});
    return film;
}
Color sum_of(const Film& film) {
    Color sum;
    for (int y = film.area().y0; y < film.area().y1; ++y)
        for (int x = film.area().x0; x < film.area().x1; ++x) sum += film.at(x, y).color / double(std::max(1, film.at(x, y).used));
    return sum;
}
std::string bytes(const Film& film) {
    std::ostringstream out;
    film.write(out);
    return out.str();
}
double mean_red(const Film& film, int x, int y) { return film.at(x, y).color.x / film.at(x, y).used; }

TEST(Fireflies, PicturesWithoutThemStayAsTheyAre) {
    const Film film = even_film({0, 0, 40, 30}, 16, 0.3, 1);
    EXPECT_EQ(bytes(without_fireflies(film)), bytes(film));
}
TEST(Fireflies, NoLightIsLostAndNoneComesToWhatIsNotThere) {
    Film film = even_film({0, 0, 60, 50}, 64, 0.2, 2);
    for (int y = 0; y < 50; ++y)  // a hole, and a dark half
        for (int x = 0; x < 60; ++x) {
            PixelSum& p = film.at(x, y);
            if (x < 8) p.color = {}, p.alpha = 0, *film.pixel(x, y).brightest = {};
            else if (x > 40) p.color = 0.01 * p.color, *film.pixel(x, y).brightest = 0.01 * *film.pixel(x, y).brightest;
        }
    tests::Random random(3);
    for (int i = 0; i < 40; ++i) add(film, 8 + i, (17 * i) % 50, std::pow(10, 1 + 3 * random.number()) * Color{1, random.number(), 0.2});
    add(film, 10, 25, {5000, 5000, 5000});
    add(film, 39, 20, {500, 500, 500});
    const Film spread = without_fireflies(film);
    const Color before = sum_of(film), after = sum_of(spread);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c], before[c], 1e-12 * before[c]);
    double most = 0, most_before = 0;
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 60; ++x) {
            EXPECT_EQ(spread.at(x, y).used, film.at(x, y).used);
            EXPECT_EQ(spread.at(x, y).alpha, film.at(x, y).alpha);
            if (x < 8) { EXPECT_EQ(spread.at(x, y).color.x, 0); }
            most = std::max(most, mean_red(spread, x, y)), most_before = std::max(most_before, mean_red(film, x, y));
        }
    EXPECT_GT(most_before, 70);
    EXPECT_LT(most, 3);
    EXPECT_LT(mean_red(spread, 42, 20), 0.2 * mean_red(spread, 38, 20));  // dark things beside it do not glow
}
TEST(Fireflies, WhatAllSamplesSeeIsNone) {
    Film film = even_film({0, 0, 30, 30}, 32, 0.1, 4);
    for (int i = 0; i < 32; ++i) add(film, 15, 15, {50, 50, 50});  // a small lamp
    for (int x = 0; x < 30; ++x)
        for (int i = 0; i < 16; ++i) add(film, x, 7, {9, 9, 9});  // and a thin line
    EXPECT_EQ(bytes(without_fireflies(film)), bytes(film));
}

// A glass ball throws the light of a small lamp onto the floor, where it is found by chance only.
Scene ball_scene(const std::string& how) {
    const TemporaryFolder folder;
    write_all(folder / "s.json", R"({"isoparm": 1, "surfaces": {"floor": {"type": "bilinear", "points": [[-4,-4,-1], [-4,4,-1], [4,-4,-1], [4,4,-1]]}},
        "objects": [{"surface": "floor", "boundary": false, "material": "diffuse"}, {"point": [0,0,0], "radius": 1, "material": "glass"}],
        "lighting": {"bounces": 8, )" + how + R"(, "lights": [{"type": "sphere", "center": [-4,2,5], "radius": 0.25, "radiance": 300}, {"type": "environment", "radiance": 0.15}]},
        "camera": {"eye": [5,-6,4], "target": [0,0,-0.5], "up": [0,0,1], "fov": 36}, "image": {"width": 96, "height": 72, "samples": 64, "background": "transparent"}})");
    return load_scene(folder / "s.json");
}
/// Root mean square, of what is shown: white is 1.
double difference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::pow(std::min(1.0, double(a.pixels[i])) - std::min(1.0, double(b.pixels[i])), 2);
    return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}
double light_of(const Image& image) {
    double sum = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) sum += i % 4 == 3 ? 0 : double(image.pixels[i]);
    return sum;
}

TEST(Fireflies, PicturesKeepTheirLightAndComeNearerToTheTruth) {
    const Scene keep = ball_scene(R"("caustics": true, "fireflies": "keep")"), spread = ball_scene(R"("caustics": true, "fireflies": "spread")");
    const Picture plain = render(keep, {}), better = render(spread, {});
    EXPECT_EQ(render(ball_scene(R"("caustics": true)"), {}).image.pixels, plain.image.pixels);
    EXPECT_NE(better.image.pixels, plain.image.pixels);
    EXPECT_NEAR(light_of(better.image), light_of(plain.image), 1e-5 * light_of(plain.image));
    // The lit floor, far from the bright spot: next to nothing of its light is thrown there by the ball.
    RenderOptions floor;
    floor.width = 480, floor.height = 360, floor.crop = {60, 200, 180, 330};
    const Image even = render(ball_scene(R"("caustics": false)"), floor).image;
    EXPECT_LT(difference(render(spread, floor).image, even), 0.2 * difference(render(keep, floor).image, even));
}
TEST(Fireflies, PixelsDoNotDependOnThreadsCropsAndStops) {
    const Scene scene = ball_scene(R"("caustics": true, "fireflies": "spread")");
    const Picture whole = render(scene, {});
    EXPECT_NE(whole.image.pixels, render(ball_scene(R"("caustics": true)"), {}).image.pixels);
    for (const int threads : {1, 7}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
        EXPECT_EQ(render(scene, {}).image.pixels, whole.image.pixels);
        for (const std::array<int, 4>& crop : {std::array{5, 30, 31, 50}, std::array{60, 20, 96, 72}, std::array{48, 45, 49, 46}}) {
            RenderOptions part;
            part.crop = crop;
            const Picture p = render(scene, part);
            for (int y = 0; y < p.image.height; ++y)
                for (int x = 0; x < p.image.width; ++x) ASSERT_EQ(std::memcmp(p.image.at(x, y), whole.image.at(x + crop[0], y + crop[1]), 4 * sizeof(float)), 0) << x << "," << y;
        }
        const TemporaryFolder folder;
        RenderOptions again;
        again.checkpoint = {folder / "checkpoint", "scene 1\n", 60};
        std::atomic<int> asked{0};
        again.stop = [&] { return ++asked > 40; };
        EXPECT_FALSE(render(scene, again).whole);
        again.stop = {};
        EXPECT_EQ(render(scene, again).image.pixels, whole.image.pixels);
    }
}

}  // namespace
}  // namespace isoparm
