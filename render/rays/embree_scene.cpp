#include "rays/embree_scene.h"

#include <algorithm>
#include <bit>
#include <iterator>

#include "rays/embree_state.h"

namespace isoparm {

double EmbreeScene::radius() const { return state_->extent.radius; }
bool EmbreeScene::translucent() const { return state_->translucent; }
double EmbreeScene::rounding() const { return state_->extent.rounding; }

Hit HitLanes::operator[](int i) const {
    if (!(found >> i & 1)) return {};
    if (exact >> i & 1) return of_patch[i];
    return {start[i] + static_cast<double>(distance[i]), geometry[i], primitive[i], u[i], v[i], {normal[0][i], normal[1][i], normal[2][i]}, 0};
}

template <class Rays> void EmbreeScene::trace(const Rays& rays, int n, HitLanes& hits) const {
    const State& s = *state_;
    alignas(64) RTCRayHit16 r;
    alignas(64) int valid[packet];
    RayPacket planes;
    s.enter(rays, (2u << (n - 1)) - 1, r.ray, hits.start, planes);
    for (int i = 0; i < packet; ++i) {
        valid[i] = i < n ? -1 : 0;
        r.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        r.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    if (s.patches) std::fill_n(hits.of_patch, n, Hit{});
    bool open[packet] = {};
    QuickRays quick;
    QuickBest best;
    PatchRays to_patches{&planes, hits.of_patch, open};
    if (s.patches) s.set_quick(r.ray, planes, quick, to_patches), to_patches.best = &best;
    Query query(true);
    if (s.patches) query.patches = &to_patches;
    {
        const FlushSubnormals flush;
        intersect_16(valid, s.scene, query, &r);
    }
    rethrow(query);
    std::uint32_t patch_first = 0;  // lanes that meet a patch first
    for (std::uint32_t m = best.some; m; m &= m - 1)
        if (const int i = std::countr_zero(m); s.geometries[r.hit.geomID[i]].patch) patch_first |= 1u << i;
    if (const std::uint32_t again = patch_first ? settle(to_patches, patch_first) : 0) s.trace_again(rays, n, again, query, r, to_patches);
    s.note(open, static_cast<std::uint64_t>(n));
    hits.found = hits.exact = 0;
    for (unsigned i = 0; i < packet; ++i) hits.found |= std::uint32_t(r.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) << i;
    if (hits.found == 0) return;
    const auto keep = [](const auto& from, auto& to) { std::copy(std::begin(from), std::end(from), to); };
    keep(r.ray.tfar, hits.distance), keep(r.hit.u, hits.u), keep(r.hit.v, hits.v), keep(r.hit.geomID, hits.geometry), keep(r.hit.primID, hits.primitive);
    keep(r.hit.Ng_x, hits.normal[0]), keep(r.hit.Ng_y, hits.normal[1]), keep(r.hit.Ng_z, hits.normal[2]);
    for (std::uint32_t m = s.patches ? hits.found : 0; m; m &= m - 1)
        if (const int i = std::countr_zero(m); s.geometries[hits.geometry[i]].patch) hits.exact |= 1u << i, hits.of_patch[i].distance += hits.start[i];
    for (std::uint32_t m = s.quads ? hits.found & ~hits.exact : 0; m; m &= m - 1) {
        const int i = std::countr_zero(m);
        Hit hit = hits[i];
        s.to_half(hit);
        hits.primitive[i] = hit.primitive, hits.u[i] = static_cast<float>(hit.u), hits.v[i] = static_cast<float>(hit.v);
    }
}

void EmbreeScene::intersect(const RayLanes& rays, int n, HitLanes& hits) const { trace(rays, n, hits); }

void EmbreeScene::intersect(const Ray* rays, int n, Hit* hits) const {
    if (n == 0) return;
    HitLanes met;
    trace(rays, n, met);
    for (int i = 0; i < n; ++i) hits[i] = met[i];
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

void EmbreeScene::layers(const Ray& ray, std::vector<Hit>& hits, std::uint32_t under) const {
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
    s.tidy(hits, ray.direction, under);
    for (Hit& h : hits) h.distance += start;
}

bool EmbreeScene::crossed(const Ray& ray, std::vector<Hit>& hits) const { return state_->crossed(ray, hits); }

template <class Rays> void EmbreeScene::shadows(const Rays& rays, int n, std::uint32_t active, double* result, Shadows shadows) const {
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

void EmbreeScene::transmittance(const Ray* rays, int n, std::uint32_t active, double* result, Shadows shadows) const { this->shadows(rays, n, active, result, shadows); }
void EmbreeScene::transmittance(const RayLanes& rays, int n, std::uint32_t active, double* result, Shadows shadows) const { this->shadows(rays, n, active, result, shadows); }

}  // namespace isoparm
