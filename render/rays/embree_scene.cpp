#include "rays/embree_scene.h"

#include <bit>

#include "rays/embree_state.h"

namespace isoparm {

double EmbreeScene::radius() const { return state_->extent.radius; }
bool EmbreeScene::translucent() const { return state_->translucent; }
double EmbreeScene::rounding() const { return state_->extent.rounding; }

void EmbreeScene::intersect(const Ray* rays, int n, Hit* hits) const {
    if (n == 0) return;
    const State& s = *state_;
    alignas(64) RTCRayHit16 r;
    alignas(64) int valid[packet];
    double start[packet];
    RayPacket planes;
    s.enter(rays, (2u << (n - 1)) - 1, r.ray, start, planes);
    for (int i = 0; i < packet; ++i) {
        valid[i] = i < n ? -1 : 0;
        r.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        r.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    if (s.patches) std::fill_n(hits, n, Hit{});
    bool open[packet] = {};
    QuickRays quick;
    QuickBest best;
    PatchRays to_patches{&planes, hits, open};
    if (s.patches) s.set_quick(r.ray, planes, quick, to_patches), to_patches.best = &best;
    Query query(true);
    if (s.patches) query.patches = &to_patches;
    {
        const FlushSubnormals flush;
        intersect_16(valid, s.scene, query, &r);
    }
    rethrow(query);
    std::uint32_t patch_first = 0;  // lanes that meet a patch first
    for (unsigned i = 0; i < packet; ++i)
        if (best.some >> i & 1 && s.geometries[r.hit.geomID[i]].patch) patch_first |= 1u << i;
    if (const std::uint32_t again = patch_first ? settle(to_patches, patch_first) : 0) s.trace_again(rays, n, again, query, r, to_patches);
    s.note(open, static_cast<std::uint64_t>(n));
    for (int i = 0; i < n; ++i) {
        const std::uint32_t geometry = r.hit.geomID[i];
        if (geometry == RTC_INVALID_GEOMETRY_ID) {
            if (!s.patches) hits[i] = Hit{};
        } else if (s.patches && s.geometries[geometry].patch) hits[i].distance += start[i];
        else hits[i] = {start[i] + static_cast<double>(r.ray.tfar[i]), geometry, r.hit.primID[i], r.hit.u[i], r.hit.v[i], {r.hit.Ng_x[i], r.hit.Ng_y[i], r.hit.Ng_z[i]}, 0};
    }
    if (!s.quads) return;
    for (int i = 0; i < n; ++i)
        if (hits[i].found()) s.to_half(hits[i]);
}

Hit EmbreeScene::first(const Ray& ray) const {
    if (state_->translucent) {
        std::vector<Hit> hits;
        layers(ray, hits);
        return hits.empty() ? Hit{} : hits.front();
    }
    Hit hit;
    intersect(&ray, 1, &hit);
    return hit;
}

void EmbreeScene::layers(const Ray& ray, std::vector<Hit>& hits) const {
    const State& s = *state_;
    hits.clear();
    LayerQuery query;
    query.hits = &hits;
    RTCRayHit r;
    RayPacket planes;
    const double start = s.enter(ray, r.ray, planes);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    Hit nearest;
    bool open = false;
    PatchRays to_patches;
    if (s.patches) {
        to_patches.rays = &planes, to_patches.nearest = &nearest, to_patches.undecided = &open, to_patches.layers = &hits;
        query.patches = &to_patches;
    }
    {
        const FlushSubnormals flush;
        intersect_1(s.scene, query, &r);
    }
    rethrow(query);
    s.note(&open, 1);
    if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID && s.geometries[r.hit.geomID].patch) {
        std::erase_if(hits, [&](const Hit& h) { return h.distance > nearest.distance; });
        hits.push_back(nearest);
    } else if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
        std::erase_if(hits, [&](const Hit& h) { return h.distance > static_cast<double>(r.ray.tfar); });
        Hit h;
        h.distance = r.ray.tfar;
        h.geometry = r.hit.geomID;
        h.primitive = r.hit.primID;
        h.u = r.hit.u;
        h.v = r.hit.v;
        h.normal = {r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z};
        hits.push_back(h);
    }
    for (Hit& h : hits) s.to_half(h);
    s.tidy(hits);
    s.order_in_planes(hits, ray.direction);
    for (Hit& h : hits) h.distance += start;
}

void EmbreeScene::transmittance(const Ray* rays, int n, std::uint32_t active, double* result, Shadows shadows) const {
    const State& s = *state_;
    std::fill(result, result + n, 1.0);
    if (active == 0) return;
    const FlushSubnormals flush;
    if (s.translucent) {
        std::vector<Hit> hits;
        for (int i = 0; i < n; ++i)
            if (active >> i & 1) result[i] = s.transmittance(rays[i], shadows, hits);
        return;
    }
    alignas(64) RTCRay16 r;
    alignas(64) int valid[packet];
    double start[packet];
    RayPacket planes;
    s.enter(rays, active, r, start, planes);
    for (int i = 0; i < packet; ++i) valid[i] = i < n && (active >> i & 1) ? -1 : 0;
    Query query;
    bool open[packet] = {};
    PatchRays to_patches{&planes, nullptr, open};
    QuickRays quick;
    if (s.patches) s.set_quick(r, planes, quick, to_patches);
    if (s.patches) query.patches = &to_patches;
    occluded_16(valid, s.scene, query, &r);
    rethrow(query);
    s.note(open, static_cast<std::uint64_t>(std::popcount(active)));
    for (int i = 0; i < n; ++i)
        if (valid[i] && r.tfar[i] < 0) result[i] = 0;
}

}  // namespace isoparm
