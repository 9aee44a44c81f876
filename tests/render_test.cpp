// Pictures whose pixels geometry foretells.
#include "picture/picture.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "curves/bezier.h"
#include "error.h"
#include "patches/side_vertex.h"
#include "patches/tensor_bezier.h"
#include "patches/transformed.h"
#include "picture/progress.h"

namespace isoparm {
namespace {

/// The unit sphere as eight rational biquadratic octants, each with a pole (Piegl and Tiller 1997, 8.5).
Composite sphere() {
    const double s = std::sqrt(0.5);
    const Patch octant = make_bezier_patch(
        {{{1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{1, 1, 0}, {1, 1, 1}, {0, 0, 1}}, {{0, 1, 0}, {0, 1, 1}, {0, 0, 1}}},
        {{1, s, 1}, {s, 0.5, s}, {1, s, 1}});
    Composite all;
    for (int k = 0; k < 8; ++k)
        all.push_back(
            {"octant" + std::to_string(k),
             transformed(octant, Transform::scale({k & 1 ? -1.0 : 1.0, k & 2 ? -1.0 : 1.0, k & 4 ? -1.0 : 1.0}))});
    return all;
}

/// The square [-1,1] x [-1,1] at height z.
Composite sheet(double z) {
    return {{"sheet", make_bezier_patch({{{-1, -1, z}, {-1, 1, z}}, {{1, -1, z}, {1, 1, z}}})}};
}

SceneObject& draw(Scene& scene, const std::string& name, const Composite& patches) {
    Surface& s = scene.surfaces.emplace_back();
    s.name = name;
    s.patches = patches;
    SceneObject& o = scene.objects.emplace_back();
    o.kind = SceneObject::Kind::surface;
    o.name = name;
    return o;
}

/// Seen from above, y up in the picture, `height` scene units high, transparent.
Scene from_above(double height, int pixels, int samples) {
    Scene scene;
    scene.camera.eye = Point{0, 0, 10};
    scene.camera.target = Point{0, 0, 0};
    scene.camera.up = Point{0, 1, 0};
    scene.camera.orthographic = height;
    scene.image.width = scene.image.height = pixels;
    scene.image.samples = samples;
    scene.tolerance = {Tolerance::Unit::relative, 1e-3};
    return scene;
}

double mean(const Image& image, int channel) {
    double sum = 0;
    for (std::size_t i = channel; i < image.pixels.size(); i += 4) sum += image.pixels[i];
    return sum / (image.width * image.height);
}
const float* middle(const Image& image) { return image.at(image.width / 2, image.height / 2); }

TEST(Render, ASphereCoversItsDisc) {
    Scene scene = from_above(3, 96, 16);
    draw(scene, "sphere", sphere());
    const Picture p = render(scene, {});
    EXPECT_NEAR(mean(p.image, 3), std::numbers::pi / 9, 0.01 * std::numbers::pi / 9);
    EXPECT_EQ(middle(p.image)[3], 1.0f);
    EXPECT_LE(p.certified_error, p.tolerance);
    EXPECT_GT(p.certified_error, 0);
    EXPECT_NEAR(p.tolerance, 1e-3 * 2 * std::sqrt(3), 0.1e-3);
}

TEST(Render, ABallCoversItsDisc) {
    Scene scene = from_above(3, 96, 16);
    SceneObject& o = scene.objects.emplace_back();
    o.kind = SceneObject::Kind::point;
    o.radius = 1.25;
    const Picture p = render(scene, {});
    const double disc = std::numbers::pi * 1.25 * 1.25 / 9;
    EXPECT_NEAR(mean(p.image, 3), disc, 0.01 * disc);
}

TEST(Render, ATubeCoversItsWidth) {
    // A straight tube of radius 0.1 and length 2 with round ends: 2 * 0.2 + pi 0.01.
    Scene scene = from_above(3, 96, 16);
    scene.curves.push_back({"c", make_bezier({{-1, 0, 0}, {1, 0, 0}})});
    SceneObject& o = scene.objects.emplace_back();
    o.kind = SceneObject::Kind::curve;
    o.name = "c";
    o.radius = 0.1;
    const double area = (0.4 + 0.01 * std::numbers::pi) / 9;
    EXPECT_NEAR(mean(render(scene, {}).image, 3), area, 0.01 * area);
}

TEST(Render, ACurvedTubeFollowsItsCurve) {
    // A quarter circle of radius 1, rational, with radius 0.05: area of the band pi/2 * 0.1 plus the round ends.
    Scene scene = from_above(3, 128, 16);
    scene.curves.push_back({"c", make_bezier({{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {1, std::sqrt(0.5), 1})});
    SceneObject& o = scene.objects.emplace_back();
    o.kind = SceneObject::Kind::curve;
    o.name = "c";
    o.radius = 0.05;
    const double area = (std::numbers::pi / 2 * 0.1 + 0.0025 * std::numbers::pi) / 9;
    EXPECT_NEAR(mean(render(scene, {}).image, 3), area, 0.01 * area);
}

TEST(Render, StackedSheetsLetThePowerOfTheirTransparencyThrough) {
    for (const int count : {1, 2, 5, 24}) {
        Scene scene = from_above(1, 8, 16);
        for (int k = 0; k < count; ++k) draw(scene, "sheet" + std::to_string(k), sheet(0.05 * k)).opacity = 0.3;
        const Image image = render(scene, {}).image;
        for (std::size_t i = 3; i < image.pixels.size(); i += 4)
            ASSERT_NEAR(image.pixels[i], 1 - std::pow(0.7, count), 1e-6) << count;
    }
}

TEST(Render, TheNearerOfTwoSheetsIsSeenFirst) {
    for (const bool red_above : {true, false}) {
        Scene scene = from_above(1, 8, 16);
        SceneObject& red = draw(scene, "red", sheet(red_above ? 0.5 : -0.5));
        red.opacity = 0.75;
        red.color = Color{0.6, 0, 0};
        SceneObject& blue = draw(scene, "blue", sheet(0));
        blue.opacity = 0.75;
        blue.color = Color{0, 0, 0.6};
        const Image image = render(scene, {}).image;
        EXPECT_EQ(middle(image)[0] > middle(image)[2], red_above);
    }
}

TEST(Render, EachSideHasItsColour) {
    for (const bool above : {true, false}) {
        Scene scene = from_above(1, 8, 16);
        if (!above) scene.camera.eye = Point{0, 0, -10};
        SceneObject& o = draw(scene, "sheet", sheet(0));
        o.color = Color{0.6, 0, 0};
        o.back = Color{0, 0, 0.6};
        const Image image = render(scene, {}).image;
        EXPECT_EQ(middle(image)[0] > middle(image)[2], above);
    }
}

TEST(Render, ShadowsThroughTranslucentSheetsAreLighter) {
    std::vector<double> light;
    for (const double opacity : {1.0, 0.75, 0.0}) {
        Scene scene = from_above(2, 16, 64);
        draw(scene, "ground", {{"ground", make_bezier_patch({{{-9, -9, -1}, {-9, 9, -1}}, {{9, -9, -1}, {9, 9, -1}}})}})
            .color = Color{0.5, 0.5, 0.5};
        // Out of the picture, between the ground and the light, which comes from the upper left and the viewer.
        SceneObject& roof = draw(
            scene, "roof", {{"roof", make_bezier_patch({{{-7, 1.25, 0}, {-7, 7, 0}}, {{7, 1.25, 0}, {7, 7, 0}}})}});
        roof.opacity = opacity;
        light.push_back(mean(render(scene, {}).image, 1));
    }
    EXPECT_LT(light[0] + 0.02, light[1]);
    EXPECT_LT(light[1] + 0.02, light[2]);
}

TEST(Render, NothingIsBrighterThanWhite) {
    Scene scene = from_above(2.4, 64, 16);
    draw(scene, "sphere", sphere()).color = Color{1, 1, 1};
    const Image image = render(scene, {}).image;
    for (const float c : image.pixels) {
        ASSERT_LE(c, 1.0f);
        ASSERT_GE(c, 0.0f);
    }
    EXPECT_GT(mean(image, 1), 0.3);
}

TEST(Render, ACoarseMeshIsShadedLikeAFineOne) {
    // Normals are the surface's, and no facet shadows its neighbour: away from the silhouette the pictures agree.
    Image images[2];
    for (const int k : {0, 1}) {
        Scene scene = from_above(1.7, 64, 64);
        draw(scene, "sphere", sphere());
        scene.tolerance.value = k == 0 ? 3e-3 : 3e-4;
        images[k] = render(scene, {}).image;
    }
    int dark = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            if (std::hypot(x - 31.5, y - 31.5) * 1.7 / 64 > 0.82) continue;
            dark += std::fabs(images[0].at(x, y)[1] - images[1].at(x, y)[1]) > 0.03f;
        }
    EXPECT_EQ(dark, 0);
}

/// The part of the picture that lines cover: it follows their colour, the rest does not.
double covered_by_lines(Scene scene, int lines, double width) {
    double red[2];
    for (const int ink : {0, 1}) {
        scene.objects[0].isolines = {lines, 0, width, Color{double(ink), 0, 0}, 1};
        red[ink] = mean(render(scene, {}).image, 0);
    }
    return red[1] - red[0];
}

TEST(Render, IsolinesAreAsWideAsAskedFromEverySide) {
    // 100 pixels a unit; three lines u = const over the square, of which the outer two lie half on it: 2 full widths of
    // 3 pixels, as long as the square is seen high.
    for (const double tilt : {0.0, 60.0}) {
        Scene scene = from_above(4, 400, 16);
        draw(scene, "sheet", {{"sheet", transformed(sheet(0)[0].patch, Transform::rotate({0, 1, 0}, tilt))}});
        EXPECT_NEAR(covered_by_lines(scene, 3, 3.0) * 400 * 400, 2 * 3.0 * 200, 0.02 * 1200) << tilt;
    }
}

TEST(Render, IsolinesFadeWhereTheyWouldFillTheSurface) {
    Scene scene = from_above(4, 64, 16);  // 32 pixels across the sheet, 100 lines of 2 pixels
    draw(scene, "sheet", sheet(0));
    EXPECT_EQ(covered_by_lines(scene, 100, 2.0), 0);
}

TEST(Render, TrianglesHaveAThirdFamilyOfLines) {
    const Point a{-1, -1, 0}, b{1, -1, 0}, c{0, 1, 0};
    const auto line = [](const Point& p, const Point& q) { return make_bezier({p, q}); };
    Scene scene = from_above(4, 200, 16);
    draw(scene, "triangle",
         {{"triangle", make_side_vertex({line(b, c), line(c, a), line(a, b)}, Function::polynomial({0, 0, 1}))}});
    scene.objects[0].isolines = {3, 3, 3, Color{1, 0, 0}, 1};
    const Image image = render(scene, {}).image;
    // w = 1/2 is the line y = 0 from (-1/2,0) to (1/2,0); u = 1/2 and v = 1/2 meet it at its ends only.
    EXPECT_GT(image.at(100, 99)[0] + image.at(100, 100)[0], 2 * 0.9f);
}

TEST(Render, CollapsedCurvesAreBallsOrNothing) {
    Scene scene = from_above(3, 32, 16);
    scene.curves.push_back({"dot", make_bezier({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}})});
    SceneObject& o = scene.objects.emplace_back();
    o.kind = SceneObject::Kind::curve;
    o.name = "dot";
    o.radius = 0.5;
    EXPECT_NEAR(mean(render(scene, {}).image, 3), std::numbers::pi * 0.25 / 9, 0.002);
    Scene octants = from_above(3, 32, 16);
    draw(octants, "sphere", sphere()).boundary = true;  // each octant has an edge at the pole
    EXPECT_EQ(middle(render(octants, {}).image)[3], 1.0f);
}

TEST(Render, ControlNetsAreRodsAndBalls) {
    Scene scene = from_above(3, 32, 16);
    SceneObject& o = scene.objects.emplace_back();
    o.kind = SceneObject::Kind::net;
    o.net.points = {{-1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}};
    o.net.rods = {{0, 1}, {1, 2}, {2, 3}};
    o.radius = 0.1;
    const Image image = render(scene, {}).image;
    EXPECT_EQ(middle(image)[3], 1.0f);
    EXPECT_GT(image.at(10, 16)[3], 0.4f);
    EXPECT_EQ(image.at(16, 4)[3], 0.0f);
}

Scene everything() {
    Scene scene = from_above(3, 72, 16);
    scene.camera = {};
    SceneObject& o = draw(scene, "sphere", sphere());
    o.isolines = {5, 5, 1.5, Color{0, 0, 0}, 0.6};
    o.boundary = true;
    draw(scene, "sheet", sheet(-1)).opacity = 0.5;
    scene.image.background = Color{0.9, 0.8, 0.7};
    scene.image.height = 50;
    return scene;
}

TEST(RenderThreads, ThePixelsAreTheSameForEveryNumber) {
    std::vector<Image> images;
    for (const bool translucent : {true, false})
        for (const int threads : {1, 2, 3}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            Scene scene = everything();
            if (!translucent) scene.objects.pop_back();
            images.push_back(render(scene, {}).image);
        }
    for (const int k : {1, 2}) {
        EXPECT_EQ(images[k].pixels, images[0].pixels);
        EXPECT_EQ(images[3 + k].pixels, images[3].pixels);
    }
}

TEST(Render, ACropIsAPartOfTheWhole) {
    RenderOptions options;
    const Image whole = render(everything(), options).image;
    options.crop = {21, 7, 58, 43};
    const Image part = render(everything(), options).image;
    ASSERT_EQ(part.width, 37);
    ASSERT_EQ(part.height, 36);
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x)
            for (int k = 0; k < 4; ++k) ASSERT_EQ(part.at(x, y)[k], whole.at(x + 21, y + 7)[k]) << x << ' ' << y;
    options.crop = {60, 0, 73, 50};
    EXPECT_THROW(render(everything(), options), Error);
}

// Their pixels share packets of rays, whichever of them are asked for.
TEST(RenderThreads, FewSamplesAreTheSameInCropsTilesAndOnEveryThread) {
    Scene scene = everything();
    scene.objects.pop_back();  // what is translucent is traced ray by ray
    for (const int samples : {1, 2, 3, 5, 8}) {
        RenderOptions options;
        options.samples = samples;
        const Image whole = render(scene, options).image;
        options.tile = 3;
        {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 2);
            EXPECT_EQ(render(scene, options).image.pixels, whole.pixels) << samples;
        }
        options.crop = {21, 7, 58, 43};
        const Image part = render(scene, options).image;
        for (int y = 0; y < part.height; ++y)
            for (int x = 0; x < part.width; ++x)
                for (int k = 0; k < 4; ++k) ASSERT_EQ(part.at(x, y)[k], whole.at(x + 21, y + 7)[k]) << samples << ": " << x << ' ' << y;
    }
}

TEST(Render, BackgroundsAreTheirColourOrNothing) {
    Scene scene = everything();
    const Image coloured = render(scene, {}).image;
    EXPECT_EQ(coloured.at(0, 0)[0], 0.9f);
    EXPECT_EQ(coloured.at(0, 0)[2], 0.7f);
    EXPECT_EQ(coloured.at(0, 0)[3], 1.0f);
    scene.image.background.reset();
    const Image clear = render(scene, {}).image;
    for (int k = 0; k < 4; ++k) EXPECT_EQ(clear.at(0, 0)[k], 0.0f);
    for (std::size_t i = 0; i < clear.pixels.size(); i += 4)  // over the colour, the one is the other
        for (int k = 0; k < 3; ++k)
            ASSERT_NEAR(clear.pixels[i + k] + (1 - clear.pixels[i + 3]) * (k == 0   ? 0.9
                                                                           : k == 1 ? 0.8
                                                                                    : 0.7),
                        coloured.pixels[i + k], 1e-6);
}

TEST(Render, FarFromTheOriginTheErrorIsStillProved) {
    Scene scene = from_above(3, 48, 16);
    Composite far;
    for (const Member& m : sphere()) far.push_back({m.name, transformed(m.patch, Transform::translate({4e6, 0, 0}))});
    draw(scene, "sphere", far);
    scene.camera = {};
    const Picture p = render(scene, {});
    EXPECT_LE(p.certified_error, p.tolerance);  // recentred: float32 costs nothing that shows
    EXPECT_EQ(middle(p.image)[3], 1.0f);
}

TEST(Render, TolerancesInPixelsAreThoseOfThePicture) {
    Scene scene = from_above(4, 40, 1);
    draw(scene, "sphere", sphere());
    scene.tolerance = {Tolerance::Unit::pixels, 0.25};
    EXPECT_NEAR(render(scene, {}).tolerance, 0.25 * 4 / 40, 1e-12);
    RenderOptions options;
    options.tolerance = Tolerance{Tolerance::Unit::absolute, 0.01};
    options.width = 20;
    options.height = 10;
    const Picture p = render(scene, options);
    EXPECT_EQ(p.tolerance, 0.01);
    EXPECT_EQ(p.image.width, 20);
    EXPECT_EQ(p.image.height, 10);
    options.tolerance->value = 0;
    EXPECT_THROW(render(scene, options), Error);
}

TEST(Render, ReportsItsProgressFromZeroToOne) {
    double last = 0;
    bool grows = true;
    RenderOptions options;
    options.progress = [&](double fraction) {
        grows = grows && fraction >= last - 1e-12 && fraction <= 1;
        last = fraction;
    };
    render(everything(), options);
    EXPECT_TRUE(grows);
    EXPECT_GT(last, 0.5);
}

TEST(Progress, TellsPercentAndTimeLeft) {
    EXPECT_EQ(progress_line("rendering", 0.25, 10, 80), "rendering   25% [=======                       ]  30 s left");
    EXPECT_EQ(progress_line("rendering", 0, 1, 80), "rendering    0% [                              ]");
    EXPECT_NE(progress_line("rendering", 0.5, 100, 80).find("1 min 40 s left"), std::string::npos);
    for (const int columns : {1, 10, 30, 80})
        EXPECT_LT(progress_line("rendering", 0.5, 100, columns).size(), std::size_t(std::max(columns, 1)));
}

}  // namespace
}  // namespace isoparm
