#include <algorithm>
#include <limits>

#include "rays/embree_rays.h"

namespace isoparm {
namespace {

/// A float that is not below x >= 0, and a little more: what is as near as x must not be passed over.
float far_enough(double x) { return static_cast<float>(x) * (1 + 0x1p-21f); }

/// What rays of a callback meet in one leaf of a patch: use(lane of the callback, ray of the query, roots).
template <class Use> void meet_leaf(const int* valid, RTCRayN* rays, unsigned n, const ExactPatch& patch, unsigned leaf, PatchRays& query, Use use) {
    int lane[EmbreeScene::packet], ray[EmbreeScene::packet], place[EmbreeScene::packet], count = 0;  // place: in what patch.meet() gets
    double farthest[EmbreeScene::packet] = {};
    bool in_place = n == EmbreeScene::packet;  // lanes are those of the query
    for (unsigned i = 0; i < n; ++i) {
        if (!valid[i]) continue;
        lane[count] = static_cast<int>(i), ray[count] = static_cast<int>(RTCRayN_id(rays, n, i));
        in_place = in_place && ray[count] == lane[count];
        ++count;
    }
    if (count == 0) return;
    in_place = in_place && count > EmbreeScene::packet / 2;
    RayPacket some;
    std::uint32_t active = 0;
    for (int k = 0; k < count; ++k) {
        place[k] = in_place ? lane[k] : k;
        active |= 1u << place[k];
        farthest[place[k]] = RTCRayN_tfar(rays, n, static_cast<unsigned>(lane[k]));
        if (!in_place) some.put(k, query.rays->at(ray[k]));
    }
    if (!in_place)
        for (int k = count; k % RayPacket::group != 0; ++k) some.put(k, query.rays->at(ray[0]));
    Roots roots[EmbreeScene::packet];
    {
        const KeepSubnormals keep;
        patch.meet(leaf, in_place ? *query.rays : some, farthest, in_place ? EmbreeScene::packet : count, active, roots);
    }
    for (int k = 0; k < count; ++k) {
        const Roots& r = roots[place[k]];
        if (r.undecided) query.undecided[ray[k]] = true;
        if (r.count > 0) use(static_cast<unsigned>(lane[k]), static_cast<unsigned>(ray[k]), r);
    }
}

Hit hit_of(const Root& root, std::uint32_t geometry, std::uint32_t leaf) {
    Hit h;
    h.distance = root.distance, h.u = root.u, h.v = root.v, h.error = root.error;
    h.geometry = geometry, h.primitive = leaf;
    return h;
}

void bounds_of_leaf(const RTCBoundsFunctionArguments* a) {
    const auto& geometry = *static_cast<const Geometry*>(a->geometryUserPtr);
    // Rays are rounded to float32 where they enter the scene, by half a unit in the last place of 1.01 radii and of their direction over 2.02
    // radii; so is the box. Embree's own slab test is conservative (RTC_SCENE_FLAG_ROBUST).
    const double pad = 0x1p-21 * *geometry.radius;
    const Bounds box = geometry.patch->box(a->primID);
    const Point low = box.low - *geometry.centre, high = box.high - *geometry.centre;
    RTCBounds& out = *a->bounds_o;
    out.lower_x = static_cast<float>(low.x - pad), out.lower_y = static_cast<float>(low.y - pad), out.lower_z = static_cast<float>(low.z - pad);
    out.upper_x = static_cast<float>(high.x + pad), out.upper_y = static_cast<float>(high.y + pad), out.upper_z = static_cast<float>(high.z + pad);
    out.align0 = out.align1 = 0;
}

/// Lanes of a whole packet are where they were in the query?
bool in_order(const int* valid, RTCRayN* rays) {
    const unsigned* id = &RTCRayN_id(rays, EmbreeScene::packet, 0);
    unsigned moved = 0;
    for (unsigned i = 0; i < EmbreeScene::packet; ++i) moved |= valid[i] ? id[i] ^ i : 0;
    return moved == 0;
}

/// In float32: met(lane, hits) for each lane that surely meets the leaf, no later than Embree asks for; the lanes that float32 does not decide, as `valid`.
template <class Met> const int* meet_quickly(const int* valid, RTCRayN* rays, unsigned n, const Geometry& geometry, unsigned leaf, const PatchRays& query, int* open, Met met) {
    QuickHits hits;
    if (!query.quick || !geometry.quick || n != EmbreeScene::packet || !in_order(valid, rays)) return valid;
    if (!geometry.quick->meet(leaf, *query.quick, &RTCRayN_tfar(rays, n, 0), valid, hits)) return valid;
    std::uint32_t left = hits.open;
    for (std::uint32_t m = hits.met; m; m &= m - 1)
        if (const int lane = __builtin_ctz(m); !met(lane, hits)) left |= 1u << lane;
    if (!left) return nullptr;
    for (int i = 0; i < EmbreeScene::packet; ++i) open[i] = left >> i & 1 ? -1 : 0;
    return open;
}

void intersect_leaf(const RTCIntersectFunctionNArguments* a) {
    auto& query = *reinterpret_cast<Query*>(a->context);
    const auto& geometry = *static_cast<const Geometry*>(a->geometryUserPtr);
    RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
    RTCHitN* hits = RTCRayHitN_HitN(a->rayhit, a->N);
    const auto use = [&](unsigned lane, unsigned ray, const Roots& roots) {
        for (int r = 0; r < roots.count; ++r) {
            const Hit hit = hit_of(roots.root[r], geometry.id, a->primID);
            if (!geometry.ends_rays() && query.patches->layers) {
                query.patches->layers->push_back(hit);
                continue;
            }
            Hit& nearest = query.patches->nearest[ray];
            float& far = RTCRayN_tfar(rays, a->N, lane);
            if (hit.distance > static_cast<double>(far) || !nearer(hit, nearest)) continue;
            nearest = hit;
            far = std::min(far, far_enough(hit.distance));
            RTCHitN_geomID(hits, a->N, lane) = geometry.id;
            RTCHitN_primID(hits, a->N, lane) = a->primID;
        }
    };
    const auto met = [&](int i, const QuickHits& h) {
        const auto lane = static_cast<unsigned>(i);
        QuickBest& best = *query.patches->best;
        float& far = RTCRayN_tfar(rays, a->N, lane);
        if (!(h.far[i] <= far) && !(best.some >> lane & 1)) return false;  // the ray may end before
        best.put(i, geometry, a->primID, h);
        far = std::min(far, best.far[i]);
        RTCHitN_geomID(hits, a->N, lane) = geometry.id;
        RTCHitN_primID(hits, a->N, lane) = a->primID;
        return true;
    };
    int open[EmbreeScene::packet];
    const int* valid = meet_quickly(a->valid, rays, a->N, geometry, a->primID, *query.patches, open, met);
    if (valid) guarded(query, [&] { meet_leaf(valid, rays, a->N, *geometry.patch, a->primID, *query.patches, use); });
}

void shadow_of_leaf(const RTCOccludedFunctionNArguments* a) {
    auto& query = *reinterpret_cast<Query*>(a->context);
    const auto& geometry = *static_cast<const Geometry*>(a->geometryUserPtr);
    const auto use = [&](unsigned lane, unsigned, const Roots& roots) {
        if (!geometry.ends_rays())  // leaves overlap: which of these are one is told when all are known
            for (int r = 0; r < roots.count; ++r) query.patches->layers->push_back(hit_of(roots.root[r], geometry.id, a->primID));
        else RTCRayN_tfar(a->ray, a->N, lane) = -std::numeric_limits<float>::infinity();
    };
    const auto met = [&](int i, const QuickHits& h) {
        float& far = RTCRayN_tfar(a->ray, a->N, static_cast<unsigned>(i));
        if (!(h.far[i] <= far)) return false;
        far = -std::numeric_limits<float>::infinity();
        return true;
    };
    int open[EmbreeScene::packet];
    const int* valid = meet_quickly(a->valid, a->ray, a->N, geometry, a->primID, *query.patches, open, met);
    if (valid) guarded(query, [&] { meet_leaf(valid, a->ray, a->N, *geometry.patch, a->primID, *query.patches, use); });
}

}  // namespace

void QuickBest::put(int i, const Geometry& from, std::uint32_t of_leaf, const QuickHits& h) {
    if (!(some >> i & 1)) other[i] = std::numeric_limits<float>::infinity();
    else if (h.far[i] < far[i]) other[i] = std::min(other[i], near[i]);
    else return void(other[i] = std::min(other[i], h.near[i]));
    some |= 1u << i;
    geometry[i] = &from, leaf[i] = of_leaf, x[i] = h.x[i], y[i] = h.y[i], near[i] = h.near[i], far[i] = h.far[i];
}

/// Whatever order leaves were visited in: all of them were whose hits begin before the one that ends first does.
std::uint32_t settle(PatchRays& rays, std::uint32_t active) {
    const QuickBest& best = *rays.best;
    std::uint32_t again = 0, prove = 0;
    for (std::uint32_t m = best.some & active; m; m &= m - 1) {
        const int i = __builtin_ctz(m);
        const double begin = std::min(best.near[i], best.other[i]), in_double = rays.nearest[i].distance;
        if (in_double < begin) continue;
        if (best.other[i] <= best.far[i] || in_double <= static_cast<double>(best.far[i])) again |= 1u << i;
        else prove |= 1u << i;
    }
    Root root[EmbreeScene::packet];
    while (prove) {  // lanes of one patch
        const Geometry& geometry = *best.geometry[__builtin_ctz(prove)];
        std::uint32_t some = 0;
        for (std::uint32_t m = prove; m; m &= m - 1)
            if (const int i = __builtin_ctz(m); best.geometry[i] == &geometry) some |= 1u << i;
        prove &= ~some;
        const std::uint32_t proved = geometry.patch->certify(best.leaf, *rays.rays, best.x, best.y, some, root);
        again |= some & ~proved;
        for (std::uint32_t m = proved; m; m &= m - 1) {
            const int i = __builtin_ctz(m);
            rays.nearest[i] = hit_of(root[i], geometry.id, best.leaf[i]);
        }
    }
    return again;
}

void set_patch_callbacks(RTCGeometry g) {
    rtcSetGeometryBoundsFunction(g, bounds_of_leaf, nullptr);
    rtcSetGeometryIntersectFunction(g, intersect_leaf);
    rtcSetGeometryOccludedFunction(g, shadow_of_leaf);
}

}  // namespace isoparm
