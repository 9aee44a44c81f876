// What makes pictures fast changes none: pixels that are not traced are empty, and loops for several instruction sets give the same bits.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "drawing/drawn.h"
#include "light/sample_points.h"
#include "light/shade_kernel.h"
#include "light/surfel_kernel.h"
#include "rays/coverage.h"
#include "run_program.h"
#include "samples.h"
#include "scene/scene_file.h"

namespace isoparm {
namespace {

using tests::Random;

Scene shipped(const std::string& name) { return load_scene(test::source_folder() + "/scenes/" + name + ".json"); }

/// Rays through the whole reach of the filter about the pixels of uncovered blocks; the part of the blocks that are covered.
double check_covered(const TracedScene& traced, const Camera& camera, Random& random, const std::string& what) {
    const Coverage coverage(traced, camera);
    int covered = 0, all = 0;
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            ++all;
            if (coverage.may_meet(x, y)) {
                ++covered;
                continue;
            }
            for (int k = 0; k < 6; ++k) {
                const auto aside = [&] { return k < 4 ? PixelFilter::radius * (random.integer(0, 1) == 0 ? -1 : 1) : random.number(-PixelFilter::radius, PixelFilter::radius); };
                const double dx = aside(), dy = aside();
                EXPECT_FALSE(traced.embree->first(camera.ray(x + 0.5 + dx, y + 0.5 + dy)).found()) << what << ", pixel " << x << ", " << y;
            }
        }
    return double(covered) / all;
}

TEST(RenderCoverage, RaysOfUncoveredPixelsMeetNothing) {
    Random random(71);
    double least = 1;
    for (const char* name : {"teapot", "cone", "side_vertex", "s004_control_net"}) {  // with tubes and balls
        Scene scene = shipped(name);
        const TracedScene traced = build_traced_scene(scene, 1e-2 * bounding_box(scene).diagonal(), {});
        const TracedScene quads = build_traced_scene(scene, drawn_objects(scene), 1e-2 * bounding_box(scene).diagonal(), {}, false, 0, 0);
        const Bounds box = bounding_box(scene);
        const Point middle = 0.5 * (box.low + box.high);
        for (int k = 0; k < 8; ++k) {
            CameraSettings settings;
            settings.eye = middle + (k < 2 ? 0.4 : 3.0) * box.diagonal() * normalized(random.vector());  // from near by, too
            settings.target = middle + 0.2 * box.diagonal() * random.vector();
            settings.up = random.vector();
            if (k % 4 == 3) settings.orthographic = 1.2 * box.diagonal();
            Camera camera = make_camera(settings, drawn_points(scene), 61, 47);
            if (k % 4 == 2) camera = zoomed(camera, 10, 7, 30, 61, 47);
            least = std::min(least, check_covered(k % 3 == 1 ? quads : traced, camera, random, name));
        }
    }
    EXPECT_LT(least, 0.5);
}

TEST(RenderCoverage, OutsideThePictureNothingIsKnown) {
    const Scene scene = shipped("side_vertex");
    const TracedScene traced = build_traced_scene(scene, 1e-2 * bounding_box(scene).diagonal(), {});
    const Camera camera = make_camera({}, drawn_points(scene), 64, 64);
    const Coverage coverage(traced, camera);
    EXPECT_FALSE(coverage.may_meet(0, 0));
    EXPECT_TRUE(coverage.may_meet(-1, 0));
    EXPECT_TRUE(coverage.may_meet(0, 64));
}

TEST(RenderKernels, PointsSideBySideAreThoseOneByOne) {
    Random random(72);
    for (int k = 0; k < 200; ++k) {
        const int samples = random.integer(1, 1 << random.integer(1, 16));
        std::vector<PixelSampler> samplers;
        for (int i = 0; i < kSamplePacket; ++i) samplers.emplace_back(random.integer(0, 4000), random.integer(0, 4000), samples);
        SampleOf of[kSamplePacket];
        int dimension[kSamplePacket];
        Vec2 at[kSamplePacket];
        for (int i = 0; i < kSamplePacket; ++i) of[i] = {&samplers[std::size_t(i)], random.integer(0, samples - 1)}, dimension[i] = random.integer(0, 30);
        sample_points(of, dimension, kSamplePacket, at);
        for (int i = 0; i < kSamplePacket; ++i) {
            const Vec2 one = samplers[std::size_t(i)](of[i].number, dimension[i]);
            ASSERT_TRUE(one.x == at[i].x && one.y == at[i].y) << samples << " samples, number " << of[i].number;
        }
    }
}

TEST(RenderKernels, ASquareIsMappedToTheDisc) {
    Random random(73);
    for (int k = 0; k < 10000; ++k) {
        const Vec2 s = k == 0 ? Vec2{0.5, 0.5} : Vec2{random.number(), random.number()}, d = on_disc(s);
        const double a = 2 * s.x - 1, b = 2 * s.y - 1, r = std::max(std::fabs(a), std::fabs(b));
        if (r == 0) {
            EXPECT_TRUE(d.x == 0 && d.y == 0);
            continue;
        }
        const bool wide = std::fabs(a) > std::fabs(b);
        const double phi = wide ? std::numbers::pi / 4 * (b / a) : std::numbers::pi / 2 - std::numbers::pi / 4 * (a / b), radius = wide ? a : b;
        EXPECT_NEAR(d.x, radius * std::cos(phi), 4e-16);
        EXPECT_NEAR(d.y, radius * std::sin(phi), 4e-16);
    }
}

template <std::size_t n> void fill(double (&row)[n], Random& random, double low, double high) {
    for (double& x : row) x = random.number(low, high);
}
template <std::size_t n> void fill_unit(double (&rows)[3][n], Random& random) {
    for (std::size_t i = 0; i < n; ++i) {
        const Point p = normalized(random.vector());
        for (int k = 0; k < 3; ++k) rows[k][i] = p[k];
    }
}

TEST(RenderKernels, FiguresAreLitAlikeByEveryInstructionSet) {
    Random random(74);
    Camera camera;
    camera.right = {1, 0, 0}, camera.up = {0, 1, 0}, camera.forward = {0, 0, -1};
    const Studio studio(camera);
    const LocalFrame key(studio.key);
    for (int k = 0; k < 50; ++k) {
        SurfelPacket p{};
        fill_unit(p.normal, random), fill_unit(p.view, random);
        for (auto* rows : {&p.at_key, &p.at_sky})
            for (auto& row : *rows) fill(row, random, 0, 1);
        for (auto& row : p.color) fill(row, random, 0, 1);
        for (int i = 0; i < p.lanes; ++i) p.key_light[i] = random.integer(0, 1), p.sky_light[i] = random.integer(0, 1);
        if (k == 0) p.at_key[0][0] = p.at_key[1][0] = 0.5;
        SurfelPacket expected = p;
        shade_kernel(Isa::baseline).directions(studio, key, expected), shade_kernel(Isa::baseline).colors(expected);
        for (int i = 0; i < p.lanes; ++i) {
            const Point n{p.normal[0][i], p.normal[1][i], p.normal[2][i]}, d{expected.to_sky[0][i], expected.to_sky[1][i], expected.to_sky[2][i]};
            const Point to_sky = normalized(LocalFrame(n).to_world(on_hemisphere({p.at_sky[0][i], p.at_sky[1][i]})));
            EXPECT_LT(length(d - to_sky), 1e-15);
            const Color sky = studio.sky(d);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(expected.sky[c][i], sky[c], 1e-15);
                EXPECT_TRUE(expected.out[c][i] >= 0 && expected.out[c][i] <= 1) << expected.out[c][i];
            }
        }
        for (const Isa isa : all_isas) {
            if (!runs(isa)) continue;
            SurfelPacket q = p;
            shade_kernel(isa).directions(studio, key, q), shade_kernel(isa).colors(q);
            EXPECT_EQ(std::memcmp(&q, &expected, sizeof(q)), 0) << to_text(isa);
        }
    }
}

TEST(RenderKernels, SurfelsAreAlikeByEveryInstructionSet) {
    Random random(75);
    for (int k = 0; k < 50; ++k) {
        SurfelLanes p{};
        fill_unit(p.view, random);
        fill(p.clear, random, 0, 1e-3), fill(p.u, random, 0, 0.5), fill(p.v, random, 0, 0.5);
        for (auto& corner : p.corner)
            for (auto& row : corner) fill(row, random, -1, 1);
        for (auto& row : p.frame) fill(row, random, -1, 1);
        for (int c = 0; c < 3; ++c) p.frame[3 + c][0] = 0, p.frame[6 + c][1] = 2 * p.frame[3 + c][1];  // no normals
        p.frame[0][2] = NAN, p.frame[4][3] = HUGE_VAL;
        SurfelLanes expected = p;
        surfel_kernel(Isa::baseline).normals(p.lanes, expected), surfel_kernel(Isa::baseline).places(p.lanes, expected);
        const auto at = [](const double (*d)[SurfelLanes::lanes], int i) { return Point{d[0][i], d[1][i], d[2][i]}; };
        for (int i = 0; i < p.lanes; ++i) {
            EXPECT_EQ(expected.regular[i] != 0, i > 3) << i;
            if (i <= 3) continue;
            const Point n = at(expected.facing, i), s = at(p.frame, i), on = at(expected.on_mesh, i), view = at(p.view, i);
            EXPECT_GE(dot(n, view), 0);
            EXPECT_GE(dot(at(expected.geometric, i), at(expected.shading, i)), 0);
            for (const Point& from : {s, on}) {
                EXPECT_GE(dot(at(expected.origin, i) - from, n), p.clear[i] - 1e-15);
                EXPECT_LE(dot(at(expected.beneath, i) - from, n), -p.clear[i] + 1e-15);
            }
        }
        for (const Isa isa : all_isas) {
            if (!runs(isa)) continue;
            SurfelLanes q = p;
            surfel_kernel(isa).normals(p.lanes, q), surfel_kernel(isa).places(p.lanes, q);
            for (int i = 0; i < p.lanes; ++i) {
                EXPECT_EQ(q.regular[i], expected.regular[i]);
                if (!expected.regular[i]) continue;
                for (const auto member : {&SurfelLanes::geometric, &SurfelLanes::facing, &SurfelLanes::shading, &SurfelLanes::origin, &SurfelLanes::beneath})
                    for (int c = 0; c < 3; ++c) EXPECT_EQ((q.*member)[c][i], (expected.*member)[c][i]) << to_text(isa);
            }
        }
    }
}

}  // namespace
}  // namespace isoparm
