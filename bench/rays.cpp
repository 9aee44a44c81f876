// rays.cpp -- primary rays of the renderer beside bare Embree on the same mesh, hits turned into points of the exact
// surface, and complete pictures.
#include <algorithm>
#include <bit>
#include <memory>
#include <stdexcept>

#include "bare_embree.h"
#include "cases.h"
#include "drawing/drawn.h"
#include "light/sampler.h"
#include "light/surfel.h"
#include "picture/picture.h"
#include "rays/traced_scene.h"

namespace isoparm::bench {
namespace {

constexpr int kWidth = 160, kHeight = 120, kSamples = EmbreeScene::packet;
constexpr double kRelative = 1e-4;

/// The surfaces of a scene without tubes, balls and lines, so that bare Embree meets the same triangles.
Scene surfaces_only(const std::string& name) {
    Scene scene = load_scene(ISOPARM_SOURCE_DIR "/scenes/" + name + ".json");
    std::erase_if(scene.objects, [](const SceneObject& o) { return o.kind != SceneObject::Kind::surface; });
    for (SceneObject& o : scene.objects) o.boundary = false, o.isolines = {}, o.opacity = 1;
    return scene;
}

/// All that is made before time is taken.
struct View {
    Scene scene;
    TracedScene traced, exact;
    Camera camera;
    std::vector<Ray> rays;  // the samples of one pixel after those of another, as the renderer traces them
    std::vector<RayLanes> lanes;  // the same in packets, as it makes them
    std::unique_ptr<BareEmbree> robust, fast;

    explicit View(const std::string& name)
        : scene(surfaces_only(name)), camera(make_camera(scene.camera, drawn_points(scene), kWidth, kHeight)) {
        const Bounds box = bounding_box(scene);
        traced = build_traced_scene(scene, kRelative * box.diagonal(), {});
        exact = build_traced_scene(scene, kRelative * box.diagonal(), {}, true);
        const PixelFilter filter;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const PixelSampler sampler(x, y, kSamples);
                for (int i = 0; i < kSamples; ++i) {
                    const Vec2 at = filter(sampler(i, 0));
                    rays.push_back(camera.ray(x + 0.5 + at.x, y + 0.5 + at.y));
                }
            }
        lanes.resize(rays.size() / RayLanes::lanes);
        for (std::size_t k = 0; k < rays.size(); ++k) lanes[k / RayLanes::lanes].set(static_cast<int>(k % RayLanes::lanes), rays[k]);
        const Point centre = 0.5 * (box.low + box.high);
        robust = std::make_unique<BareEmbree>(traced.meshes.at(0), centre, rays, true);
        fast = std::make_unique<BareEmbree>(traced.meshes.at(0), centre, rays, false);
        if (traced.meshes.size() != 1) throw std::logic_error("more than one surface is drawn");
    }

    /// use(rays, hits, n) for the n rays of each packet that hit; their number.
    template <class Use> std::size_t intersect(Use use) const { return intersect(traced, use); }
    template <class Use> std::size_t intersect(const TracedScene& what, Use use) const {
        HitLanes met;
        Hit hits[EmbreeScene::packet];
        Ray hitting[EmbreeScene::packet];
        std::size_t found = 0;
        for (const RayLanes& packet : lanes) {
            const RayLanes made = packet;
            what.embree->intersect(made, EmbreeScene::packet, met);
            int n = 0;
            for (std::uint32_t m = met.found; m; m &= m - 1, ++n) hitting[n] = made[std::countr_zero(m)], hits[n] = met[std::countr_zero(m)];
            use(hitting, hits, n);
            found += static_cast<std::size_t>(n);
        }
        return found;
    }
    /// As bare Embree's hits, these are counted and left as they are.
    std::size_t count(const TracedScene& what) const {
        HitLanes met;
        std::size_t found = 0;
        for (const RayLanes& packet : lanes) {
            const RayLanes rays = packet;  // a copy, as bare Embree's
            what.embree->intersect(rays, EmbreeScene::packet, met);
            found += static_cast<std::size_t>(std::popcount(met.found));
        }
        return found;
    }
    /// Bare Embree starts its rays at the eye, the renderer where they enter the scene: silhouettes may round either
    /// way.
    void compare() const {
        const double ours = double(intersect([](const Ray*, const Hit*, int) {})), theirs = double(robust->intersect_16());
        if (std::fabs(ours - theirs) > 1e-4 * theirs) throw std::logic_error("the two do not hit the same mesh");
        const double proved = double(intersect(exact, [](const Ray*, const Hit*, int) {}));
        if (std::fabs(ours - proved) > 1e-2 * proved) throw std::logic_error("the mesh and the surface are not hit alike");
    }
};

void add(std::vector<Case>& cases, const std::string& scene, const std::string& title) {
    const auto view = std::make_shared<std::unique_ptr<View>>();
    const auto prepare = [view, scene] {
        if (*view) return;
        *view = std::make_unique<View>(scene);
        (*view)->compare();
    };
    const auto rays = [&](const std::string& name, auto trace, bool reference = false) {
        Case c{"primary rays: " + title + " at 1e-4", name, "rays", [view, trace] {
                   const View& v = **view;
                   const double rays = double(v.rays.size()), hits = double(trace(v));
                   return Work{rays, {{"triangles", double(v.traced.triangles)}, {"hits/ray", hits / rays}}};
               }};
        c.reference = reference;
        c.prepare = prepare;
        cases.push_back(std::move(c));
    };
    rays(
        "rtcIntersect16, robust", [](const View& v) { return v.robust->intersect_16(); }, true);
    rays("rtcIntersect16, not robust", [](const View& v) { return v.fast->intersect_16(); });
    rays("rtcIntersect1, robust", [](const View& v) { return v.robust->intersect_1(); });
    rays("EmbreeScene::intersect", [](const View& v) { return v.count(v.traced); });
    rays("EmbreeScene::intersect, exact", [](const View& v) { return v.count(v.exact); });
    rays("... and surfels_at its hits", [](const View& v) {
        double sum = 0;
        const std::size_t found = v.intersect([&](const Ray* rays, const Hit* hits, int n) {
            Surfel surfels[EmbreeScene::packet];
            surfels_at(v.traced, v.camera, rays, hits, n, surfels);
            for (int i = 0; i < n; ++i) sum += surfels[i].normal.x;
        });
        if (!std::isfinite(sum)) throw std::logic_error("a normal is not finite");
        return found;
    });

    // From the scene to its pixels: mesh, Embree's hierarchy, tracing, shading.
    const auto picture = [&](const std::string& name, Clock clock) {
        Case c{"pictures: " + title + " at 1e-3", name, "samples", [view] {
                   RenderOptions options;
                   options.width = 2 * kWidth;
                   options.height = 2 * kHeight;
                   options.samples = kSamples;
                   options.tolerance = Tolerance{Tolerance::Unit::relative, 1e-3};
                   const Picture p = render((*view)->scene, options);
                   const double samples = 4.0 * kWidth * kHeight * kSamples;
                   return Work{samples,
                               {{"triangles", double(p.triangles)},
                                {"part of the mesh", p.seconds_mesh / (p.seconds_mesh + p.seconds_trace)}}};
               }};
        c.reference = clock == Clock::core_seconds;
        c.clock = clock;
        c.prepare = prepare;
        cases.push_back(std::move(c));
    };
    picture("render(), per core", Clock::core_seconds);
    picture("render(), all cores", Clock::wall);
}

}  // namespace

std::vector<Case> ray_cases() {
    std::vector<Case> cases;
    add(cases, "teapot", "teapot");
    add(cases, "coons", "bicubic Coons patch");
    add(cases, "sphere", "eight rational octants");
    add(cases, "side_vertex", "side-vertex triangle");
    return cases;
}

}  // namespace isoparm::bench
