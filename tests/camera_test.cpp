// Cameras: where points land, what fits, what is refused.
#include "picture/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "error.h"

namespace isoparm {
namespace {

CameraSettings looking(const Point& eye, const Point& target) {
    CameraSettings s;
    s.eye = eye;
    s.target = target;
    return s;
}

const std::vector<Point> kCube = [] {
    std::vector<Point> p;
    for (int i = 0; i < 8; ++i) p.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
    return p;
}();

struct Frame {
    double left = 1e300, right = -1e300, top = 1e300, bottom = -1e300;
};
Frame frame_of(const Camera& c, const std::vector<Point>& points) {
    Frame f;
    for (const Point& p : points) {
        const Vec2 q = c.project(p);
        f.left = std::min(f.left, q.x), f.right = std::max(f.right, q.x);
        f.top = std::min(f.top, q.y), f.bottom = std::max(f.bottom, q.y);
    }
    return f;
}

TEST(Camera, PerspectiveProjectsByTheIntercepts) {
    // From (0,-5,0) along +y, 90 degrees: at depth 5 the half height is 5, so 100 pixels are 5 units: z = 1 is 10 up.
    CameraSettings s = looking({0, -5, 0}, {0, 0, 0});
    s.fov = 90;
    const Camera c = make_camera(s, {}, 200, 100);
    EXPECT_NEAR(c.project({0, 0, 0}).x, 100, 1e-12);
    EXPECT_NEAR(c.project({0, 0, 0}).y, 50, 1e-12);
    EXPECT_NEAR(c.project({1, 0, 1}).x, 110, 1e-12);
    EXPECT_NEAR(c.project({1, 0, 1}).y, 40, 1e-12);
    EXPECT_NEAR(c.project({1, 5, 1}).x, 105, 1e-12);  // twice as far, half as big
}

TEST(Camera, OrthographicKeepsSizes) {
    CameraSettings s = looking({0, 0, 10}, {0, 0, 0});
    s.up = Point{0, 1, 0};
    s.orthographic = 4;
    const Camera c = make_camera(s, {}, 400, 200);  // 50 pixels a unit
    for (const double z : {-3.0, 0.0, 3.0}) {
        EXPECT_NEAR(c.project({1, 1, z}).x, 250, 1e-9);
        EXPECT_NEAR(c.project({1, 1, z}).y, 50, 1e-9);
    }
}

TEST(Camera, RaysRunThroughTheirPixels) {
    for (const bool orthographic : {false, true}) {
        CameraSettings s = looking({3, -4, 2}, {0.1, 0.2, 0.3});
        if (orthographic) s.orthographic = 5;
        const Camera c = make_camera(s, kCube, 320, 240);
        for (const Vec2 at : {Vec2{0, 0}, {17.25, 200.5}, {319, 1}}) {
            const Ray r = c.ray(at.x, at.y);
            EXPECT_NEAR(length(r.direction), 1, 1e-14);
            const Vec2 back = c.project(r.origin + 7.0 * r.direction);
            EXPECT_NEAR(back.x, at.x, 1e-9);
            EXPECT_NEAR(back.y, at.y, 1e-9);
        }
    }
}

TEST(Camera, FitsEverythingWithAMarginOfSixPercent) {
    for (const bool orthographic : {false, true})
        for (const int width : {100, 400}) {
            CameraSettings s;
            if (orthographic) s.orthographic = 0;
            const Camera c = make_camera(s, kCube, width, 200);
            const Frame f = frame_of(c, kCube);
            const double mx = 0.06 * width, my = 0.06 * 200;
            EXPECT_GE(f.left, mx - 1e-9);
            EXPECT_LE(f.right, width - mx + 1e-9);
            EXPECT_GE(f.top, my - 1e-9);
            EXPECT_LE(f.bottom, 200 - my + 1e-9);
            const double tightest = std::min({f.left - mx, width - mx - f.right, f.top - my, 200 - my - f.bottom});
            EXPECT_NEAR(tightest, 0, 1e-6);
        }
}

TEST(Camera, FitKeepsTheDirectionAndCentresWhatIsDrawn) {
    CameraSettings s = looking({30, 0, 0}, {0, 0.5, 0});
    s.fit = true;
    const Camera c = make_camera(s, kCube, 300, 300);
    EXPECT_NEAR(distance(c.forward, normalized(*s.target - *s.eye)), 0, 1e-12);
    const Frame f = frame_of(c, kCube);
    EXPECT_NEAR(f.top + f.bottom, 300, 1e-6);
    EXPECT_NEAR(f.bottom - f.top, 0.88 * 300, 1e-6);
    EXPECT_LT(c.eye.x, 29);  // it moved closer
}

TEST(Camera, AnEyeWithoutFitStays) {
    const Camera c = make_camera(looking({30, 0, 0}, {0, 0.5, 0}), kCube, 300, 300);
    EXPECT_EQ(c.eye, (Point{30, 0, 0}));
}

TEST(Camera, ByDefaultIsThreeQuarterWithZUp) {
    const Camera c = make_camera({}, kCube, 300, 300);
    EXPECT_LT(c.forward.z, -0.2);
    EXPECT_GT(c.forward.y, 0.2);
    EXPECT_LT(c.forward.x, -0.2);
    EXPECT_GT(c.up.z, 0.8);
    EXPECT_NEAR(c.right.z, 0, 1e-12);
}

TEST(Camera, SurvivesScenesWithoutSize) {
    for (const auto& drawn : {std::vector<Point>{}, {{1, 2, 3}}, {{1, 2, 3}, {1, 2, 3}}})
        for (const bool orthographic : {false, true}) {
            CameraSettings s;
            if (orthographic) s.orthographic = 0;
            const Camera c = make_camera(s, drawn, 64, 64);
            EXPECT_TRUE(finite(c.eye) && finite(c.right) && finite(c.up));
            EXPECT_GT(c.half_height, 0);
        }
}

TEST(Camera, LooksStraightDown) {
    const Camera c = make_camera(looking({0, 0, 5}, {0, 0, 0}), kCube, 64, 64);  // up is along the view
    EXPECT_NEAR(dot(c.up, c.forward), 0, 1e-12);
    EXPECT_NEAR(length(c.right), 1, 1e-12);
}

TEST(Camera, RefusesWhatIsNoView) {
    EXPECT_THROW(make_camera(looking({1, 1, 1}, {1, 1, 1}), kCube, 64, 64), Error);
    CameraSettings s = looking({5, 0, 0}, {0, 0, 0});
    s.fov = 180;
    EXPECT_THROW(make_camera(s, kCube, 64, 64), Error);
    s.fov = 35;
    s.orthographic = -1;
    EXPECT_THROW(make_camera(s, kCube, 64, 64), Error);
}

TEST(Camera, WhatMovesByTheFinestPixelMovesByAPixelInThePictureAtMost) {
    CameraSettings s = looking({0, -3, 0}, {0, 0, 0});
    s.fov = 90;
    const Camera c = make_camera(s, {}, 200, 100);
    const Bounds box{{-4, -1, -2}, {4, 1, 2}};
    const double step = 1e-3 * finest_pixel(c, box);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    double most = 0;
    for (int i = 0; i < 100000; ++i) {
        const Point p{4 * number(random), number(random), 2 * number(random)};
        const Vec2 at = c.project(p);
        if (at.x < 0 || at.x > 200 || at.y < 0 || at.y > 100) continue;
        const Vec2 moved = c.project(p + step * normalized(Point{number(random), number(random), number(random)}));
        most = std::max(most, std::hypot(moved.x - at.x, moved.y - at.y) / 1e-3);
    }
    EXPECT_LE(most, 1.01);
    EXPECT_GT(most, 0.7);
}

TEST(Camera, FinestPixelIsThatOfTheNearestCorner) {
    CameraSettings s = looking({0, -5, 0}, {0, 0, 0});
    s.fov = 90;
    const Camera c = make_camera(s, {}, 100, 100);
    // The nearest depth is 4; the corners of the picture see at an angle whose secant is sqrt(3).
    EXPECT_NEAR(finest_pixel(c, {{-1, -1, -1}, {1, 1, 1}}), 2 * 4 / 100.0 / std::sqrt(3.0), 1e-12);
    s.orthographic = 3;
    EXPECT_NEAR(finest_pixel(make_camera(s, {}, 100, 100), {{-1, -1, -1}, {1, 1, 1}}), 0.03, 1e-12);
}

}  // namespace
}  // namespace isoparm
