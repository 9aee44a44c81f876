// embree_state.h -- what an EmbreeScene holds, and how a ray or a packet goes into Embree and comes back; internal to embree_scene.cpp and
// embree_geometry.cpp.
#pragma once
#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <stdexcept>
#include <string>
#include <vector>

#include "rays/embree_rays.h"
#include "rays/embree_scene.h"

namespace isoparm {

struct LayerQuery : Query {
    std::vector<Hit>* hits = nullptr;
};

/// Refuses every hit of geometry that lets light through, so that Embree goes on to the next, and remembers it; called for single rays only.
inline void remember_layer(const RTCFilterFunctionNArguments* a) {
    auto& query = static_cast<LayerQuery&>(*reinterpret_cast<Query*>(a->context));
    Hit h;
    h.distance = RTCRayN_tfar(a->ray, a->N, 0);
    h.geometry = RTCHitN_geomID(a->hit, a->N, 0);
    h.primitive = RTCHitN_primID(a->hit, a->N, 0);
    h.u = RTCHitN_u(a->hit, a->N, 0);
    h.v = RTCHitN_v(a->hit, a->N, 0);
    h.normal = {RTCHitN_Ng_x(a->hit, a->N, 0), RTCHitN_Ng_y(a->hit, a->N, 0), RTCHitN_Ng_z(a->hit, a->N, 0)};
    guarded(query, [&] { query.hits->push_back(h); });
    a->valid[0] = 0;
}

struct EmbreeScene::State {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    const ExactKernel& kernel = exact_kernel(chosen_isa());
    Point centre;
    FloatExtent extent;
    bool translucent = false;
    bool patches = false;  // rays meet some patch itself
    bool quads = false;    // some mesh has quads
    mutable std::atomic<std::uint64_t> rays{0}, undecided{0};
    std::deque<Geometry> geometries;        // Embree keeps pointers to them
    std::deque<QuickPatch> quick;
    std::deque<FloatVertices> shared;       // vertices that Embree reads in place
    std::uint32_t meshes = 0;

    ~State() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
    void check(const char* doing) const {
        if (const RTCError e = rtcGetDeviceError(device); e != RTC_ERROR_NONE)
            throw std::runtime_error(
                std::string("Embree failed while ") + doing +
                (e == RTC_ERROR_OUT_OF_MEMORY ? ": out of memory" : ": error " + std::to_string(e)));
    }
    std::uint32_t attach(RTCGeometry g, const Sheet& sheet, bool solid, bool of_quads = false, const Plane& plane = {}) {
        Geometry& data = geometries.emplace_back(Geometry{0, meshes, sheet, plane, solid, of_quads});
        rtcSetGeometryUserData(g, &data);
        if (!data.ends_rays()) {
            translucent = true;
            rtcSetGeometryIntersectFilterFunction(g, remember_layer);
            rtcSetGeometryOccludedFilterFunction(g, remember_layer);
        }
        rtcCommitGeometry(g);
        data.id = rtcAttachGeometry(scene, g);
        rtcReleaseGeometry(g);
        check("taking over geometry");
        return data.id;
    }
    /// A ray from where it enters the scene, which is returned; with its planes for patches.
    double enter(const Ray& ray, RTCRay& r, RayPacket& planes) const {
        float out[7][RayPacket::group];
        double start[RayPacket::group];
        kernel.enter(&ray, 1, RayPacket::group, centre, extent.radius, start, {out[0], out[1], out[2], out[3], out[4], out[5], out[6]}, patches ? &planes : nullptr);
        if (patches) kernel.planes(RayPacket::group, planes);
        r.org_x = out[0][0], r.org_y = out[1][0], r.org_z = out[2][0], r.dir_x = out[3][0], r.dir_y = out[4][0], r.dir_z = out[5][0];
        r.tnear = 0, r.tfar = out[6][0], r.time = 0;
        r.mask = ~0u, r.id = 0, r.flags = 0;
        return start[0];
    }
    /// The same of a packet; lanes that are not active are copies of one that is.
    void enter(const Ray* rays, std::uint32_t active, RTCRay16& r, double* start, RayPacket& planes) const {
        kernel.enter(rays, active, packet, centre, extent.radius, start, {r.org_x, r.org_y, r.org_z, r.dir_x, r.dir_y, r.dir_z, r.tfar}, patches ? &planes : nullptr);
        settle_packet(r, planes);
    }
    void enter(const RayLanes& rays, std::uint32_t, RTCRay16& r, double* start, RayPacket& planes) const {
        kernel.enter_lanes(rays, centre, extent.radius, start, {r.org_x, r.org_y, r.org_z, r.dir_x, r.dir_y, r.dir_z, r.tfar}, patches ? &planes : nullptr);
        settle_packet(r, planes);
    }
    void settle_packet(RTCRay16& r, RayPacket& planes) const {
        if (patches) kernel.planes(packet, planes);
        for (unsigned i = 0; i < packet; ++i) r.tnear[i] = 0, r.time[i] = 0, r.mask[i] = ~0u, r.id[i] = i, r.flags[i] = 0;
    }
    void set_quick(const RTCRay16& r, const RayPacket& planes, QuickRays& quick, PatchRays& to_patches) const {
        quick.origin[0] = r.org_x, quick.origin[1] = r.org_y, quick.origin[2] = r.org_z;
        quick.direction[0] = r.dir_x, quick.direction[1] = r.dir_y, quick.direction[2] = r.dir_z;
        quick.set_planes(planes);
        to_patches.quick = &quick;
    }
    /// Lanes `again` of a packet, in double.
    template <class Rays> void trace_again(const Rays& rays, int n, std::uint32_t again, Query& query, RTCRayHit16& r, PatchRays& to_patches) const {
        alignas(64) int valid[packet];
        alignas(64) RTCRayHit16 fresh;
        double start[packet];
        RayPacket planes;
        enter(rays, (2u << (n - 1)) - 1, fresh.ray, start, planes);
        for (int i = 0; i < packet; ++i) {
            valid[i] = again >> i & 1 ? -1 : 0;
            fresh.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
            fresh.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
            if (valid[i]) to_patches.nearest[i] = Hit{};
        }
        to_patches.quick = nullptr;
        {
            const FlushSubnormals flush;
            intersect_16(valid, scene, query, &fresh);
        }
        rethrow(query);
        for (int i = 0; i < packet; ++i)
            if (valid[i]) {
                r.ray.tfar[i] = fresh.ray.tfar[i], r.hit.geomID[i] = fresh.hit.geomID[i], r.hit.primID[i] = fresh.hit.primID[i];
                r.hit.u[i] = fresh.hit.u[i], r.hit.v[i] = fresh.hit.v[i];
                r.hit.Ng_x[i] = fresh.hit.Ng_x[i], r.hit.Ng_y[i] = fresh.hit.Ng_y[i], r.hit.Ng_z[i] = fresh.hit.Ng_z[i];
            }
    }
    /// Of geometry made of quads, as Embree has met it.
    void to_half(Hit& hit) const {
        if (!geometries[hit.geometry].quads) return;
        hit.primitive = QuadPart::half_at(hit.primitive, hit.u, hit.v);
        if (hit.primitive % 2) hit.u = 1 - hit.u, hit.v = 1 - hit.v;
    }
    /// Adds to count().
    void note(const bool* open, std::uint64_t n) const {
        if (!patches) return;
        rays.fetch_add(n, std::memory_order_relaxed);
        if (const auto some = std::count(open, open + n, true)) undecided.fetch_add(static_cast<std::uint64_t>(some), std::memory_order_relaxed);
    }
    /// A ray through an edge may meet the triangles on both sides of it: one hit.
    bool same_place(const Hit& a, const Hit& b) const {
        const auto near_edge = [](const Hit& h) { return std::min({h.u, h.v, 1 - h.u - h.v}) < 1e-5; };
        const Geometry &ga = geometries[a.geometry], &gb = geometries[b.geometry];
        // Leaves of a patch, and neighbouring patches, overlap a little.
        if (ga.patch || gb.patch) return ga.patch && gb.patch && ga.mesh == gb.mesh && b.distance - a.distance < 1e-8 * extent.radius;
        return !ga.solid && !gb.solid && ga.mesh == gb.mesh && b.distance - a.distance < 1e-6 * extent.radius &&
               near_edge(a) && near_edge(b);
    }
    /// At one place, but for rounding, seen along the plane of a, both in planes that are shared? That these are one plane is not asked for: where two of them cross, it makes no difference.
    bool in_one_plane(const Hit& a, const Hit& b, const Point& along) const {
        const Plane &p = geometries[a.geometry].plane, &q = geometries[b.geometry].plane;
        return p.shared() && q.shared() && std::fabs((a.distance - b.distance) * dot(p.normal, along)) <= p.within;
    }
    /// What was added last lies over what shares its plane; hides what is behind, if it is opaque.
    void order_in_planes(std::vector<Hit>& hits, const Point& along) const {
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (!geometries[hits[i].geometry].plane.shared()) continue;
            std::size_t over = i;
            for (std::size_t k = i + 1; k < hits.size(); ++k)
                if (in_one_plane(hits[i], hits[k], along) && hits[k].geometry > hits[over].geometry) over = k;
            std::rotate(hits.begin() + static_cast<std::ptrdiff_t>(i), hits.begin() + static_cast<std::ptrdiff_t>(over), hits.begin() + static_cast<std::ptrdiff_t>(over) + 1);
            if (geometries[hits[i].geometry].opaque()) hits.resize(i + 1);
        }
    }
    /// Leaves of what lies in the plane of that geometry only what lies under it.
    void look_under(std::uint32_t geometry, std::vector<Hit>& hits, const Point& along) const {
        const auto at = std::find_if(hits.begin(), hits.end(), [&](const Hit& h) { return h.geometry == geometry; });
        if (at == hits.end()) return;
        const Hit top = *at;
        std::erase_if(hits, [&](const Hit& h) { return h.geometry >= geometry && in_one_plane(top, h, along); });
    }
    /// In order, each once: tubes and balls however often a ray passes their skin, others where leaves or triangles meet. `under`: as of layers().
    void tidy(std::vector<Hit>& hits, const Point& along, std::uint32_t under = Hit::none) const {
        std::sort(hits.begin(), hits.end(), nearer);
        if (under != Hit::none) look_under(under, hits, along);
        order_in_planes(hits, along);
        hits.erase(std::unique(hits.begin(), hits.end(), [&](const Hit& a, const Hit& b) { return same_place(a, b); }), hits.end());
        for (std::size_t i = 0; i < hits.size(); ++i)
            if (geometries[hits[i].geometry].solid)
                hits.erase(std::remove_if(hits.begin() + static_cast<std::ptrdiff_t>(i) + 1, hits.end(), [&](const Hit& h) { return h.geometry == hits[i].geometry; }), hits.end());
    }
    double lets_through(const Geometry& geometry, Shadows shadows) const {
        const double o = geometry.sheet.opacity;
        return geometry.solid || shadows == Shadows::physical ? 1 - o : 1 - o * o * o;
    }
    bool crossed(const Ray& ray, std::vector<Hit>& hits) const {
        hits.clear();
        LayerQuery query;
        query.hits = &hits;
        RTCRay r;
        RayPacket planes;
        enter(ray, r, planes);
        bool open = false;
        PatchRays to_patches;
        if (patches) {
            to_patches.rays = &planes, to_patches.undecided = &open, to_patches.layers = &hits;
            query.patches = &to_patches;
        }
        occluded_1(scene, query, &r);
        rethrow(query);
        note(&open, 1);
        if (r.tfar < 0) return false;
        for (Hit& h : hits) to_half(h);
        tidy(hits, ray.direction);
        return hits.empty() || !geometries[hits.back().geometry].opaque();
    }
    double transmittance(const Ray& ray, Shadows shadows, std::vector<Hit>& hits) const {
        if (!crossed(ray, hits)) return 0;
        double light = 1;
        for (const Hit& h : hits) light *= lets_through(geometries[h.geometry], shadows);
        return light;
    }
};

}  // namespace isoparm
