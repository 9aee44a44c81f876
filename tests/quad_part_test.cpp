// Large meshes are kept as quads: rays meet the same triangles at the same parameters as in the mesh itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "drawing/drawn.h"
#include "grid_mesh.h"
#include "picture/aov.h"
#include "picture/camera.h"
#include "rays/traced_scene.h"
#include "run_program.h"
#include "samples.h"
#include "scene/scene_file.h"
#include "tessellate.h"

namespace isoparm {
namespace {

using tests::Random;

Scene shipped(const std::string& name) { return load_scene(test::source_folder() + "/scenes/" + name + ".json"); }
TracedScene traced(const Scene& scene, std::size_t large) { return build_traced_scene(scene, scene.objects, 1e-3 * bounding_box(scene).diagonal(), {}, false, 0, large); }
constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

TEST(QuadPart, HoldsEveryTriangleOnce) {
    for (const char* name : {"teapot", "cone", "side_vertex"}) {
        const Scene scene = shipped(name);
        TessellationOptions options;
        options.tolerance = 1e-3 * bounding_box(scene).diagonal();
        const Mesh mesh = tessellate(scene.surfaces[0].patches, options).mesh;
        const Point centre(0.3, -0.2, 0.1);
        std::size_t pairs = 0;
        for (const MeshPart& part : mesh.parts) {
            MeshPart left = part;
            const QuadPart quads(mesh, left, centre);
            EXPECT_EQ(quads.triangles(), part.triangles.size());
            EXPECT_TRUE(left.triangles.capacity() == 0 && left.vertex.capacity() == 0 && left.uv.capacity() == 0) << "memory";
            pairs += part.triangles.size() - quads.quads().size();
            std::vector<int> seen(part.triangles.size());
            for (std::uint32_t half = 0; half < 2 * quads.quads().size(); ++half) {
                const auto corners = quads.corners(half);
                if (corners[0] == corners[1]) continue;  // of one that is alone
                const std::uint32_t number = quads.triangle(half);
                ++seen.at(number);
                auto turned = corners;
                std::rotate(turned.begin(), std::find(turned.begin(), turned.end(), part.triangles[number][0]), turned.end());
                ASSERT_EQ(turned, part.triangles[number]) << name << ", half " << half;
                for (const auto c : corners) {
                    ASSERT_TRUE(quads.uv(c).x == part.uv[c].x && quads.uv(c).y == part.uv[c].y);
                    ASSERT_LE(distance(quads.vertices()[c], mesh.positions[part.vertex[c]]), quads.vertices().extent().rounding);
                }
            }
            EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(seen.size())) << name;
        }
        EXPECT_GT(double(pairs), 0.35 * double(mesh.triangle_count())) << name << ": most triangles have a partner";
    }
}

/// Where a ray meets a surface.
struct Met {
    std::uint32_t triangle = 0;
    std::array<double, 3> weights{};  // of the mesh's corners in their order
    Vec2 at;
};
Met met(const TracedScene& scene, const Hit& hit) {
    const Thing& thing = scene.things[hit.geometry];
    Met m;
    const double w[] = {1 - hit.u - hit.v, hit.u, hit.v};
    const auto uv = parameters_of(thing, hit.primitive);
    for (int k = 0; k < 3; ++k) m.at = {m.at.x + w[k] * uv[k].x, m.at.y + w[k] * uv[k].y};
    m.triangle = thing.quads ? thing.quads->triangle(hit.primitive) : hit.primitive;
    return m;
}
double least_weight(const Hit& hit) { return std::min({1 - hit.u - hit.v, hit.u, hit.v}); }

void expect_same(const TracedScene& a, const TracedScene& b, const Hit& x, const Hit& y, double size, int& same, int& other) {
    if (x.found() != y.found() || !x.found() || x.geometry != y.geometry) {
        other += x.found() || y.found();
        return;
    }
    ASSERT_NEAR(x.distance, y.distance, 1e-6 * size);
    if (!a.things[x.geometry].part) return;
    const Met p = met(a, x), q = met(b, y);
    if (p.triangle != q.triangle) {  // through an edge
        ++other;
        EXPECT_LT(least_weight(x), 1e-2);
        EXPECT_LT(least_weight(y), 1e-2);
        return;
    }
    ++same;
    EXPECT_GE(least_weight(y), -1e-6);
    // Corners may begin with another one, but each has its weight.
    const auto cx = corners_of(a.things[x.geometry], x.primitive), cy = corners_of(b.things[y.geometry], y.primitive);
    const Point on_x = (1 - x.u - x.v) * cx[0] + x.u * cx[1] + x.v * cx[2], on_y = (1 - y.u - y.v) * cy[0] + y.u * cy[1] + y.v * cy[2];
    EXPECT_LT(distance(on_x, on_y), 1e-5 * size);
    EXPECT_LT(std::hypot(p.at.x - q.at.x, p.at.y - q.at.y), 1e-4);
    EXPECT_GT(dot(normalized(x.normal), normalized(y.normal)), 0.999) << "sides";
}

void compare(const std::string& name, double opacity) {
    Random random(81);
    Scene scene = shipped(name);
    scene.objects = drawn_objects(scene);
    for (SceneObject& o : scene.objects) o.opacity = opacity;
    const TracedScene a = traced(scene, kNever), b = traced(scene, 0);
    ASSERT_TRUE(a.quads.empty() && b.quads.size() == b.meshes.size() && !b.quads.empty());
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.certified_error, b.certified_error);
    EXPECT_EQ(a.embree->rounding(), b.embree->rounding());
    EXPECT_EQ(a.embree->radius(), b.embree->radius());
    const Bounds box = bounding_box(scene);
    const double size = box.diagonal();
    const Point middle = 0.5 * (box.low + box.high);
    int same = 0, other = 0;
    for (int k = 0; k < 400; ++k) {
        constexpr int n = EmbreeScene::packet;
        Ray rays[n];
        for (Ray& ray : rays) {
            ray.origin = middle + 1.2 * size * normalized(random.vector());
            ray.direction = normalized(middle + 0.3 * size * random.vector() - ray.origin);
        }
        if (opacity == 1) {
            Hit x[n], y[n];
            a.embree->intersect(rays, n, x), b.embree->intersect(rays, n, y);
            for (int i = 0; i < n; ++i) expect_same(a, b, x[i], y[i], size, same, other);
        }
        double light_a[n], light_b[n];
        a.embree->transmittance(rays, n, 0xffff, light_a), b.embree->transmittance(rays, n, 0xffff, light_b);
        for (int i = 0; i < n; ++i) {
            other += light_a[i] != light_b[i];
            std::vector<Hit> x, y;
            a.embree->layers(rays[i], x), b.embree->layers(rays[i], y);
            if (x.size() != y.size()) ++other;
            else
                for (std::size_t j = 0; j < x.size(); ++j) expect_same(a, b, x[j], y[j], size, same, other);
        }
    }
    EXPECT_GT(same, 1000) << name;
    EXPECT_LT(other, 2e-3 * same) << name;
}

TEST(QuadPart, RaysMeetTheSameTriangles) {
    for (const char* name : {"teapot", "cone", "side_vertex"}) compare(name, 1);
}
TEST(QuadPart, LayersAreTheSame) {
    for (const char* name : {"teapot", "side_vertex"}) compare(name, 0.5);
}

TEST(QuadPart, ChannelsAreTheSame) {
    Scene scene = shipped("teapot");
    scene.objects = drawn_objects(scene);
    const TracedScene a = traced(scene, kNever), b = traced(scene, 0);
    const Camera camera = make_camera({}, drawn_points(scene), 61, 47);
    const std::vector<Aov> aovs{Aov::triangle, Aov::patch, Aov::uv, Aov::p, Aov::n, Aov::ng};
    const AovReader read_a(scene, a, camera, aovs), read_b(scene, b, camera, aovs);
    int other = 0, on_surface = 0;
    for (int y = 0; y < 47; ++y)
        for (int x = 0; x < 61; ++x) {
            std::vector<float> p(channels_of(aovs).size()), q(p.size());
            read_a.read(x, y, {}, p.data()), read_b.read(x, y, {}, q.data());
            on_surface += p[0] >= 0;
            if (p[0] != q[0] || p[1] != q[1]) ++other;
            else
                for (std::size_t k = 2; k < p.size(); ++k) EXPECT_NEAR(p[k], q[k], 1e-3) << channels_of(aovs)[k] << " at " << x << ", " << y;
        }
    EXPECT_GT(on_surface, 500);
    EXPECT_LT(other, 5);
}

TEST(QuadPart, OneSurfaceTwiceAndGrids) {
    Scene scene = shipped("side_vertex");
    scene.objects = drawn_objects(scene);
    scene.objects.push_back(scene.objects.front());
    const TracedScene twice = traced(scene, 0);
    EXPECT_EQ(twice.quads.size(), 1u);
    int with_quads = 0;
    for (const Thing& thing : twice.things) with_quads += thing.quads != nullptr;
    EXPECT_EQ(with_quads, 2);
    const TracedScene grid = build_traced_scene(scene, scene.objects, 1e-3, {}, false, 8, 0);
    EXPECT_EQ(grid.quads.size(), 1u);
    EXPECT_EQ(grid.quads[0][0].triangles(), grid.triangles);
}

}  // namespace
}  // namespace isoparm
