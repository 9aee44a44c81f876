// exact_test.cpp -- rays against the surfaces themselves meet them where geometry says.
#include "rays/exact_patch.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <new>
#include <numbers>
#include <random>

#include "error.h"
#include "expect_program.h"
#include "picture/picture.h"
#include "rays/traced_scene.h"
#include "shapes.h"

namespace isoparm {
namespace {

Scene shipped(const std::string& name) { return load_scene(test::source_folder() + "/scenes/" + name + ".json"); }

Scene written(const std::string& text) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "scene.json";
    test::write_all(path, R"({ "isoparm": 1, )" + text + " }");
    return load_scene(path);
}

/// The octant x, y, z >= 0 of the unit sphere; drawn alone, or with its mirrors.
std::string sphere(const std::string& objects) {
    return R"("parameters": { "s": { "value": "sqrt(2)/2" } }, "surfaces": {
        "octant": { "type": "bezier", "points": [[[0,0,1],[0,0,1],[0,0,1]],[[1,0,1],[1,1,1],[0,1,1]],[[1,0,0],[1,1,0],[0,1,0]]], "weights": [[1,"s",1],["s","s*s","s"],[1,"s",1]] },
        "x-": { "type": "transform", "surface": "octant", "mirror": [1,0,0] }, "y-": { "type": "transform", "surface": "octant", "mirror": [0,1,0] },
        "x-y-": { "type": "transform", "surface": "x-", "mirror": [0,1,0] }, "north": { "type": "composite", "members": ["octant","x-","x-y-","y-"] },
        "south": { "type": "transform", "surface": "north", "mirror": [0,0,1] }, "sphere": { "type": "composite", "members": ["north","south"] } },
        "objects": [ )" + objects + " ]";
}

class Rays {
public:
    explicit Rays(unsigned seed) : random_(seed) {}
    double number(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
    Point direction() {
        for (;;) {
            const Point p{number(-1, 1), number(-1, 1), number(-1, 1)};
            if (const double l = length(p); l > 0.1 && l < 1) return p / l;
        }
    }
    /// From a sphere of radius 5 towards a point of a box about the origin.
    Ray towards(const Point& target) {
        const Point from = 5.0 * direction();
        return {from, normalized(target - from)};
    }
    Point in_box(double half) { return {number(-half, half), number(-half, half), number(-half, half)}; }

private:
    std::mt19937_64 random_;
};

// |o + t d| = 1.
TEST(Exact, HitsOfASphereOctantAreThoseOfTheSphere) {
    const Scene scene = written(sphere(R"({ "surface": "octant" })"));
    const TracedScene traced = build_traced_scene(scene, 1e-2, {}, true);
    Rays random(1);
    int hits = 0;
    for (int k = 0; k < 4000; ++k) {
        const Ray ray = random.towards(random.in_box(1.2));
        const double b = dot(ray.origin, ray.direction), c = dot(ray.origin, ray.origin) - 1, root = b * b - c;
        double expected = -1;  // the nearer root in the octant
        bool doubtful = std::fabs(root) < 1e-9;
        for (const double sign : {1.0, -1.0}) {
            const Point p = ray.origin + (-b + sign * std::sqrt(std::max(0.0, root))) * ray.direction;
            const double least = std::min({p.x, p.y, p.z});
            doubtful = doubtful || std::fabs(least) < 1e-8;
            if (root > 0 && least > 0) expected = -b + sign * std::sqrt(root);
        }
        if (doubtful) continue;
        Hit hit;
        traced.embree->intersect(&ray, 1, &hit);
        ASSERT_EQ(hit.found(), expected >= 0) << k;
        if (!hit.found()) continue;
        ++hits;
        const double cosine = std::sqrt(root);
        EXPECT_NEAR(hit.distance, expected, 1e-12 / std::min(1.0, cosine)) << k;
        EXPECT_LE(hit.error, 1e-11);
        EXPECT_NEAR(distance(scene.surfaces[0].patches[0].patch.point(hit.u, hit.v), ray.origin + hit.distance * ray.direction), 0, 1e-12 / cosine);
    }
    EXPECT_GT(hits, 500);
    EXPECT_EQ(traced.embree->count().undecided, 0);
    EXPECT_GE(traced.embree->count().rays, 3900);
}

// The parallelogram (0,0,0), (2,0,1), (0,3,0), and the triangle of its first three vertices.
TEST(Exact, HitsOfPlanesAreThoseOfPlanes) {
    const Scene scene = written(R"("surfaces": { "q": { "type": "bilinear", "points": [[0,0,0],[2,0,1],[0,3,0],[2,3,1]] }, "t": { "type": "triangle", "points": [[0,0,0],[2,0,1],[0,3,0]] } })");
    for (const bool triangle : {false, true}) {
        Scene one = scene;
        one.objects.clear();
        SceneObject& o = one.objects.emplace_back();
        o.kind = SceneObject::Kind::surface;
        o.name = triangle ? "t" : "q";
        const TracedScene traced = build_traced_scene(one, 1e-2, {}, true);
        Rays random(2);
        int hits = 0;
        for (int k = 0; k < 2000; ++k) {
            const Ray ray = random.towards({random.number(-1, 3), random.number(-1, 4), random.number(-1, 2)});
            const double t = (0.5 * ray.origin.x - ray.origin.z) / (ray.direction.z - 0.5 * ray.direction.x);
            const Point p = ray.origin + t * ray.direction;
            const double inside = std::min({p.x, 2 - p.x, p.y, 3 - p.y, triangle ? 1 - p.x / 2 - p.y / 3 : 1.0});
            if (std::fabs(inside) < 1e-8) continue;
            Hit hit;
            traced.embree->intersect(&ray, 1, &hit);
            ASSERT_EQ(hit.found(), inside > 0 && t > 0) << k << (triangle ? " triangle" : " quad");
            hits += hit.found();
            if (!hit.found()) continue;
            EXPECT_NEAR(hit.distance, t, 1e-12 / std::min(1.0, std::fabs(ray.direction.z - 0.5 * ray.direction.x))) << k;
        }
        EXPECT_GT(hits, 250);
    }
}

/// Whether boxes that hold a patch, down to `size`, meet the ray: no means a miss, yes a hit or as near as that.
bool boxes_meet(const Patch& patch, const Box& box, const Ray& ray, double size) {
    const Vec3<Interval> x = patch.enclose_points(box);
    Interval t(0, 100);
    for (int k = 0; k < 3; ++k) {
        const Interval slab = (x[k] - Interval(ray.origin[k])) / Interval(ray.direction[k]);
        t = {std::max(t.lo, slab.lo), std::min(t.hi, slab.hi)};
    }
    if (t.lo > t.hi) return false;
    if (std::max({x.x.hi - x.x.lo, x.y.hi - x.y.lo, x.z.hi - x.z.lo}) < size) return true;
    const double u = mid(box.u), v = mid(box.v);
    for (const Box& part : {Box{{box.u.lo, u}, {box.v.lo, v}}, Box{{u, box.u.hi}, {box.v.lo, v}}, Box{{box.u.lo, u}, {v, box.v.hi}}, Box{{u, box.u.hi}, {v, box.v.hi}}}) {
        if (patch.domain() == Domain::triangle && part.u.lo + part.v.lo > 1) continue;
        if (boxes_meet(patch, part, ray, size)) return true;
    }
    return false;
}

TEST(Exact, HitAndMissAgreeWithDenseSubdivision) {
    for (const char* name : {"coons", "side_vertex", "s003_tensor_product"}) {
        const Scene scene = shipped(name);
        Scene one = scene;
        one.objects.clear();
        SceneObject& o = one.objects.emplace_back();
        o.kind = SceneObject::Kind::surface;
        o.name = scene.surfaces.back().name;
        const Composite& patches = scene.surfaces.back().patches;
        const TracedScene traced = build_traced_scene(one, 1e-2, {}, true);
        const Bounds box = bounding_box(one);
        const double size = box.diagonal();
        Rays random(3);
        int hits = 0, doubtful = 0;
        for (int k = 0; k < 60; ++k) {
            const auto inside = [&](int axis) { return random.number(box.low[axis], box.high[axis]); };
            const Point target{inside(0), inside(1), inside(2)}, from = target + size * random.direction();
            const Ray ray{from, normalized(target - from)};
            Hit hit;
            traced.embree->intersect(&ray, 1, &hit);
            bool met = false;
            for (const Member& m : patches) {
                const Rect r = m.patch.rect();
                met = met || boxes_meet(m.patch, {{r.u0, r.u1}, {r.v0, r.v1}}, ray, 1e-4 * size);
            }
            EXPECT_TRUE(met || !hit.found()) << name << " " << k;
            hits += hit.found(), doubtful += met && !hit.found();
        }
        EXPECT_GT(hits, 8) << name;
        EXPECT_LE(doubtful, 1) << name;
    }
}

TEST(Exact, NothingShinesThroughSharedEdgesAndPoles) {
    for (const double opacity : {1.0, 0.5}) {
        const Scene scene = written(sphere(R"({ "surface": "sphere", "opacity": )" + std::to_string(opacity) + "}"));
        const TracedScene traced = build_traced_scene(scene, 1e-2, {}, true);
        Rays random(4);
        for (int k = 0; k < 2000; ++k) {
            // A point of a great circle that octants share; sometimes a pole.
            const double angle = k % 10 == 0 ? std::numbers::pi / 2 * (k / 10 % 4) : random.number(0, 6.3);
            Point target{std::cos(angle), std::sin(angle), 0};
            for (int turn = k % 3; turn > 0; --turn) target = {target.z, target.x, target.y};
            const Point from = target + random.number(1, 4) * normalized(target + 0.9 * random.direction());
            const Ray ray{from, normalized(target - from)};
            if (dot(ray.direction, target) > -0.05) continue;
            std::vector<Hit> layers;
            traced.embree->layers(ray, layers);
            ASSERT_EQ(layers.size(), opacity < 1 ? 2 : 1) << k;
            EXPECT_NEAR(layers[0].distance, distance(from, target), 1e-8) << k;
            double light = 1;
            traced.embree->transmittance(&ray, 1, 1, &light);
            const double sheet = 1 - std::pow(opacity, 3);  // each of the two layers once, in however many leaves it is found
            EXPECT_NEAR(light, sheet * sheet, 1e-12) << k;
            traced.embree->transmittance(&ray, 1, 1, &light, EmbreeScene::Shadows::physical);
            EXPECT_NEAR(light, (1 - opacity) * (1 - opacity), 1e-12) << k;
        }
    }
}

TEST(Exact, RaysAlongASurfaceEndAndAreCounted) {
    const Scene scene = written(R"("surfaces": { "q": { "type": "bilinear", "points": [[0,0,0],[1,0,0],[0,1,0],[1,1,0]] } }, "objects": [ { "surface": "q" } ])");
    const TracedScene traced = build_traced_scene(scene, 1e-2, {}, true);
    const Ray in_plane{{-1, 0.3, 0}, normalized(Point{1, 0.1, 0})}, above{{-1, 0.3, 1e-6}, normalized(Point{1, 0.1, 0})};
    std::vector<Hit> layers;
    traced.embree->layers(in_plane, layers);
    EXPECT_EQ(traced.embree->count().undecided, 1);
    traced.embree->layers(above, layers);
    EXPECT_TRUE(layers.empty());
    EXPECT_EQ(traced.embree->count().undecided, 1);
    EXPECT_EQ(traced.embree->count().rays, 2);
}

/// A patch that runs out of memory when it is asked for many points, as rays do.
struct OutOfMemory : Patch::Concept {
    Patch inner = tests::octant();
    Domain domain() const override { return inner.domain(); }
    Rect rect() const override { return inner.rect(); }
    std::vector<double> breaks_u() const override { return {}; }
    std::vector<double> breaks_v() const override { return {}; }
    Point point(double u, double v) const override { return inner.point(u, v); }
    PointJet jet(double u, double v) const override { return inner.jet(u, v); }
    PointFrame frame(double u, double v) const override { return inner.frame(u, v); }
    void points(std::size_t n, const double* u, const double* v, Point* out) const override { inner.points(n, u, v, out); }
    void frames(std::size_t n, const double* u, const double* v, PointFrame* out) const override { inner.frames(n, u, v, out); }
    void frame_arrays(Isa, std::span<const double>, std::span<const double>, const FrameArrays&) const override { throw std::bad_alloc(); }
    Enclosure enclose(const Box& box) const override { return inner.enclose(box); }
    Vec3<Interval> enclose_points(const Box& box) const override { return inner.enclose_points(box); }
};

// Embree's own frames lie between: an exception that passed through them would end the program.
TEST(Exact, WhatIsThrownAmidRaysIsThrownByTheirQuery) {
    const Patch patch(std::make_shared<OutOfMemory>());
    const ExactPatch exact(patch, 2);
    for (const double opacity : {1.0, 0.5}) {
        EmbreeScene scene({0, 0, 0});
        scene.add_patch(exact, 0, opacity);
        scene.commit();
        const Point inward = normalized(Point{-1, -1, -1});
        const Ray ray{-3.0 * inward, inward}, past{{5, 5, 5}, normalized(inward + Point{0, 0, 2})};
        std::vector<Hit> layers;
        double light = 1;
        EXPECT_THROW(scene.first(ray), std::bad_alloc);
        EXPECT_THROW(scene.layers(ray, layers), std::bad_alloc);
        EXPECT_THROW(scene.transmittance(&ray, 1, 1, &light), std::bad_alloc);
        EXPECT_NO_THROW(scene.transmittance(&past, 1, 1, &light));
        EXPECT_EQ(light, 1);
    }
}

RenderOptions exact_picture(int width, int height, int samples) {
    RenderOptions how;
    how.width = width, how.height = height, how.samples = samples;
    how.exact = true;
    how.aovs = {Aov::n, Aov::z, Aov::patch, Aov::error};
    return how;
}

/// The two sheets of a fold touch along lines that a picture sees as areas.
TEST(Exact, FoldsEndWithAMessageAndOtherSurfacesDoNot) {
    const auto picture = [](const std::string& points) {
        RenderOptions how = exact_picture(64, 48, 4);
        how.aovs.clear();
        how.most_halved = 1e4;
        return render(written(R"("surfaces": { "q": { "type": "bezier", "points": )" + points + R"( } }, "objects": [ { "surface": "q" } ])"), how);
    };
    EXPECT_GT(picture("[[[0,0,0],[1,0,0],[2,0,0]],[[0,1,0],[1,1,1],[2,1,0]]]").rays.rays, 64u * 48 * 4);
    try {
        picture("[[[0,0,0],[1,0,0],[0,0,0]],[[1,1,0],[0,1,0],[1,1,0]]]");
        ADD_FAILURE();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::budget);
        EXPECT_NE(std::string(e.what()).find("as where they are folded"), std::string::npos) << e.what();
    }
}

// |Z - Z'| <= distance / cos of the angle at which the ray meets the surface, along the axis; the sphere bends little within that.
TEST(Exact, DepthsOfMeshesComeCloserAsTheirErrorSays) {
    const Scene scene = written(sphere(R"({ "surface": "sphere" })") + R"(, "camera": { "eye": [4,2.4,2.2], "target": [0,0,0], "fov": 35 })");
    RenderOptions how = exact_picture(96, 72, 1);
    const Picture exact = render(scene, how);
    how.exact = false;
    std::size_t before = 96 * 72;
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        how.tolerance = Tolerance{Tolerance::Unit::absolute, tolerance};
        const Picture mesh = render(scene, how);
        std::size_t different = 0, same = 0;  // hit or miss
        for (std::size_t i = 0; i < 96 * 72; ++i) {
            const float *a = &exact.layers.values[6 * i], *b = &mesh.layers.values[6 * i];
            if ((a[4] < 0) != (b[4] < 0)) { ++different; continue; }
            if (a[4] < 0) continue;
            ++same;
            EXPECT_LE(a[5], 1e-10);
            const Ray ray = make_camera(scene.camera, {}, 96, 72).ray(i % 96 + 0.5, static_cast<double>(i / 96) + 0.5);
            const double cosine = -dot(ray.direction, Point(a[0], a[1], a[2]));
            if (cosine < 0.2) continue;
            EXPECT_LE(std::fabs(double(a[3]) - b[3]), 2 * mesh.certified_error / cosine + 2e-6) << tolerance;
        }
        EXPECT_GT(same, 1000);
        EXPECT_LE(different, before);
        before = different;
    }
    EXPECT_LE(before, 1);  // pixels, of the silhouette
}

// Rays of a packet, some of them grazing, are computed side by side and halve leaves together.
TEST(Exact, ARayIsTheSameAloneAndInAnyPacket) {
    const Scene scene = shipped("teapot");
    const TracedScene traced = build_traced_scene(scene, 1e-1, {}, true);
    Rays random(7);
    std::vector<Ray> rays;
    for (int k = 0; k < 40 * EmbreeScene::packet; ++k) rays.push_back(random.towards(random.in_box(1.5) + Point(0, 0, 1.5)));
    int hits = 0;
    for (std::size_t first = 0; first < rays.size(); first += EmbreeScene::packet) {
        Hit together[EmbreeScene::packet];
        traced.embree->intersect(&rays[first], EmbreeScene::packet, together);
        for (int n : {1, 5, 9})
            for (int from = 0; from + n <= EmbreeScene::packet; from += n) {
                Hit some[EmbreeScene::packet];
                traced.embree->intersect(&rays[first + from], n, some);
                for (int i = 0; i < n; ++i) {
                    const Hit &a = together[from + i], &b = some[i];
                    ASSERT_TRUE(a.distance == b.distance && a.geometry == b.geometry && a.primitive == b.primitive && a.u == b.u && a.v == b.v && a.error == b.error)
                        << "ray " << first + from + i << " in a packet of " << n;
                    hits += a.found();
                }
            }
    }
    EXPECT_GT(hits, 600);
    traced.embree->intersect(rays.data(), 0, nullptr);  // nothing to do
}

TEST(Exact, EveryInstructionSetGivesTheSameBits) {
    const Scene scene = shipped("teapot");
    const TracedScene traced = build_traced_scene(scene, 1e-1, {}, true);
    Rays random(8);
    for (int k = 0; k < 200; ++k) {
        Ray rays[RayPacket::lanes];
        for (Ray& r : rays) r = random.towards(random.in_box(1.5) + Point(0, 0, 1.5));
        const double size = bounding_box(scene).diagonal();
        LeafMap leaf;
        leaf.box = {{0, 1}, {0, 1}}, leaf.u = leaf.v = leaf.hu = leaf.hv = 0.5;
        leaf.s = random.in_box(1), leaf.a = random.in_box(1), leaf.b = random.in_box(1);
        leaf.bend = leaf.turn_u = leaf.turn_v = random.number(0, 0.3), leaf.slanted = k % 2 == 1;
        leaf.size_s = length(leaf.s), leaf.size_a = length(leaf.a), leaf.size_b = length(leaf.b);
        std::vector<double> expected;
        for (const Isa isa : all_isas) {
            if (!runs(isa)) continue;
            const ExactKernel& kernel = exact_kernel(isa);
            RayPacket packet;
            double start[RayPacket::lanes], farthest[RayPacket::lanes];
            float single[7][RayPacket::lanes];
            kernel.enter(rays, 0xfffb, RayPacket::lanes, {0, 0, 1.5}, size, start, {single[0], single[1], single[2], single[3], single[4], single[5], single[6]}, &packet);
            kernel.planes(RayPacket::lanes, packet);
            std::fill(std::begin(farthest), std::end(farthest), 100.0);
            AimPacket aim{};
            kernel.aim(leaf, packet, 1e-9, farthest, RayPacket::lanes, aim);
            NewtonPacket newton{};
            kernel.begin(leaf, packet, aim, RayPacket::lanes, newton);
            for (int axis = 0; axis < 3; ++axis)
                for (int i = 0; i < RayPacket::lanes; ++i)
                    newton.frame[axis][i] = leaf.s[axis] + newton.cx[i] * leaf.a[axis] + newton.cy[i] * leaf.b[axis], newton.frame[3 + axis][i] = 2 * leaf.a[axis],
                    newton.frame[6 + axis][i] = 2 * leaf.b[axis];
            kernel.step(leaf, packet, aim, true, 1e-3, RayPacket::lanes, newton);
            std::vector<double> all(std::begin(start), std::end(start));
            for (const auto& row : single) all.insert(all.end(), std::begin(row), std::end(row));
            for (int i = 0; i < RayPacket::lanes; ++i) {
                all.insert(all.end(), {double(aim.verdict[i]), double(newton.state[i])});
                if (aim.verdict[i] != AimPacket::miss) all.insert(all.end(), {aim.x[i], aim.y[i], aim.growth[i], aim.noise[i]});
                if (aim.verdict[i] == AimPacket::one) all.insert(all.end(), {newton.x[i], newton.y[i], newton.u[i], newton.v[i], newton.distance[i]});
            }
            if (expected.empty()) expected = all;
            ASSERT_EQ(all.size(), expected.size());
            EXPECT_EQ(std::memcmp(all.data(), expected.data(), all.size() * sizeof(double)), 0) << to_text(isa) << ", packet " << k;
        }
    }
}

TEST(ExactThreads, PicturesAreTheSameForEveryNumberAndInCrops) {
    Scene scene = shipped("coons");
    scene.objects.front().opacity = 0.6;
    const RenderOptions how = exact_picture(40, 30, 4);
    std::vector<float> first;
    for (const int threads : {1, 2, 7}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const Picture p = render(scene, how);
        if (first.empty()) first = p.image.pixels;
        EXPECT_EQ(p.image.pixels, first) << threads;
    }
    RenderOptions cropped = how;
    cropped.crop = {11, 5, 30, 22};
    const Picture part = render(scene, cropped);
    for (int y = 5; y < 22; ++y)
        for (int i = 0; i < 4 * 19; ++i) ASSERT_EQ(part.image.pixels[(y - 5) * 4 * 19 + i], first[(y * 40 + 11) * 4 + i]);
}

TEST(Exact, LooksLikeTheMesh) {
    Scene scene = shipped("teapot");
    RenderOptions how = exact_picture(80, 60, 16);
    const Picture exact = render(scene, how);
    how.exact = false;
    how.tolerance = Tolerance{Tolerance::Unit::relative, 1e-4};
    const Picture mesh = render(scene, how);
    double sum = 0;
    for (std::size_t i = 0; i < exact.image.pixels.size(); ++i) sum += std::fabs(exact.image.pixels[i] - mesh.image.pixels[i]);
    EXPECT_LT(sum / static_cast<double>(exact.image.pixels.size()), 2e-3);
    EXPECT_EQ(exact.triangles, 0);
    EXPECT_GT(exact.leaves, 32);
    EXPECT_LT(exact.rays.undecided, exact.rays.rays / 10'000);
}

TEST(Exact, TheFileAndTheProgramSayHowRaysEnded) {
    const test::TemporaryFolder folder;
    const test::Outcome o = test::run("render " + test::scene("coons") + " --exact --size 32x24 --samples 2 -o '" + folder / "x.exr" + "'");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.err.find("ended undecided"), std::string::npos) << o.err;
    EXPECT_NE(test::read_all(folder / "x.exr").find("isoparm:undecided_rays"), std::string::npos);
}

}  // namespace
}  // namespace isoparm
