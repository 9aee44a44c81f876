#include "embree_scene.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <stdexcept>
#include <string>
#include <tuple>

#include "embree_rays.h"

namespace isoparm {
namespace {

struct LayerQuery : Query {
    std::vector<Hit>* hits = nullptr;
};

/// Refuses every hit of geometry that lets light through, so that Embree goes on to the next, and remembers it; called for single rays only.
void remember_layer(const RTCFilterFunctionNArguments* a) {
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

}  // namespace

struct EmbreeScene::State {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    const ExactKernel& kernel = exact_kernel(chosen_isa());
    Point centre;
    double radius = 0, rounding = 0;
    bool translucent = false;
    bool patches = false;  // rays meet some patch itself
    mutable std::atomic<std::uint64_t> rays{0}, undecided{0};
    std::deque<Geometry> geometries;        // Embree keeps pointers to them
    std::deque<QuickPatch> quick;
    std::deque<std::vector<float>> shared;  // vertices that Embree reads in place

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
    /// A vertex relative to the centre, in float32.
    void store(const Point& p, double extent, float* out) {
        const Point q = p - centre;
        for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(q[i]);
        rounding = std::max(
            rounding, (1 + 1e-9) * length(q - Point(out[0], out[1], out[2])) + 1e-16 * (length(p) + length(centre)));
        radius = std::max(radius, length(q) + extent);
    }
    std::uint32_t attach(RTCGeometry g, double opacity, bool solid) {
        const auto mesh = static_cast<std::uint32_t>(shared.size());
        Geometry& data = geometries.emplace_back(Geometry{0, mesh, static_cast<float>(opacity), solid});
        rtcSetGeometryUserData(g, &data);
        if (opacity < 1) {
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
        kernel.enter(&ray, 1, RayPacket::group, centre, radius, start, {out[0], out[1], out[2], out[3], out[4], out[5], out[6]}, patches ? &planes : nullptr);
        if (patches) kernel.planes(RayPacket::group, planes);
        r.org_x = out[0][0], r.org_y = out[1][0], r.org_z = out[2][0], r.dir_x = out[3][0], r.dir_y = out[4][0], r.dir_z = out[5][0];
        r.tnear = 0, r.tfar = out[6][0], r.time = 0;
        r.mask = ~0u, r.id = 0, r.flags = 0;
        return start[0];
    }
    /// The same of a packet; lanes that are not active are copies of one that is.
    void enter(const Ray* rays, std::uint32_t active, RTCRay16& r, double* start, RayPacket& planes) const {
        kernel.enter(rays, active, packet, centre, radius, start, {r.org_x, r.org_y, r.org_z, r.dir_x, r.dir_y, r.dir_z, r.tfar}, patches ? &planes : nullptr);
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
    void trace_again(const Ray* rays, int n, std::uint32_t again, Query& query, RTCRayHit16& r, PatchRays& to_patches) const {
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
        if (ga.patch || gb.patch) return ga.patch && gb.patch && ga.mesh == gb.mesh && b.distance - a.distance < 1e-8 * radius;
        return !ga.solid && !gb.solid && ga.mesh == gb.mesh && b.distance - a.distance < 1e-6 * radius &&
               near_edge(a) && near_edge(b);
    }
    /// In order, each once: tubes and balls however often a ray passes their skin, others where leaves or triangles meet.
    void tidy(std::vector<Hit>& hits) const {
        std::sort(hits.begin(), hits.end(), nearer);
        hits.erase(std::unique(hits.begin(), hits.end(), [&](const Hit& a, const Hit& b) { return same_place(a, b); }), hits.end());
        for (std::size_t i = 0; i < hits.size(); ++i)
            if (geometries[hits[i].geometry].solid)
                hits.erase(std::remove_if(hits.begin() + static_cast<std::ptrdiff_t>(i) + 1, hits.end(), [&](const Hit& h) { return h.geometry == hits[i].geometry; }), hits.end());
    }
    double lets_through(const Geometry& geometry, Shadows shadows) const {
        const double o = geometry.opacity;
        return geometry.solid || shadows == Shadows::physical ? 1 - o : 1 - o * o * o;
    }
    double transmittance(const Ray& ray, Shadows shadows, std::vector<Hit>& hits) const {
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
        if (r.tfar < 0) return 0;
        tidy(hits);
        double light = 1;
        for (const Hit& h : hits) light *= lets_through(geometries[h.geometry], shadows);
        return light;
    }
};

EmbreeScene::EmbreeScene(const Point& centre) : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.centre = centre;
    const char* config =
        std::getenv("ISOPARM_EMBREE");  // e.g. "isa=sse4.2", for pictures that are equal on all machines
    s.device = rtcNewDevice(config ? config : "");
    if (!s.device)
        throw std::runtime_error("Embree cannot start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
    s.scene = rtcNewScene(s.device);
    rtcSetSceneFlags(s.scene, RTC_SCENE_FLAG_ROBUST);
    s.check("starting");
}
EmbreeScene::~EmbreeScene() = default;

std::uint32_t EmbreeScene::add_mesh(const Mesh& mesh, double opacity) {
    State& s = *state_;
    std::vector<float>& vertices =
        s.shared.emplace_back(3 * mesh.positions.size() + 4);  // Embree may read 16 bytes at once
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) s.store(mesh.positions[i], 0, &vertices[3 * i]);
    std::uint32_t first = Hit::none;
    for (const MeshPart& part : mesh.parts) {
        RTCGeometry g = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.data(), 0,
                                   3 * sizeof(float), mesh.positions.size());
        auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), part.triangles.size()));
        if (!index && !part.triangles.empty()) s.check("taking over a mesh");
        for (const auto& triangle : part.triangles)
            for (const std::uint32_t corner : triangle) *index++ = part.vertex[corner];
        const std::uint32_t id = s.attach(g, opacity, false);
        if (first == Hit::none) first = id;
    }
    return first;
}

std::uint32_t EmbreeScene::add_patch(const ExactPatch& patch, std::uint32_t group, double opacity) {
    State& s = *state_;
    for (std::size_t i = 0; i < patch.leaves(); ++i)
        for (const Point& p : {patch.box(i).low, patch.box(i).high}) s.radius = std::max(s.radius, length(p - s.centre));
    s.patches = true;
    s.translucent = s.translucent || opacity < 1;
    RTCGeometry g = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_USER);
    Geometry& data = s.geometries.emplace_back(Geometry{0, group, static_cast<float>(opacity), false, &patch, &s.quick.emplace_back(patch, s.centre), &s.centre, &s.radius});
    rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(patch.leaves()));
    rtcSetGeometryUserData(g, &data);
    set_patch_callbacks(g);
    rtcCommitGeometry(g);
    data.id = rtcAttachGeometry(s.scene, g);
    rtcReleaseGeometry(g);
    s.check("taking over a patch");
    return data.id;
}

EmbreeScene::Count EmbreeScene::count() const { return {state_->rays, state_->undecided}; }

std::uint32_t EmbreeScene::add_tubes(const std::vector<std::array<Point, 4>>& pieces, double radius, double opacity) {
    State& s = *state_;
    RTCGeometry g = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE);
    auto* vertex = static_cast<float*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 4 * pieces.size()));
    auto* index = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(std::uint32_t), pieces.size()));
    if (!vertex || !index) s.check("taking over a curve");
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        index[i] = static_cast<std::uint32_t>(4 * i);
        for (const Point& p : pieces[i]) {
            s.store(p, radius, vertex);
            vertex[3] = static_cast<float>(radius);
            vertex += 4;
        }
    }
    return s.attach(g, opacity, true);
}

std::uint32_t EmbreeScene::add_balls(const std::vector<Point>& centres, double radius, double opacity) {
    State& s = *state_;
    RTCGeometry g = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* vertex = static_cast<float*>(
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), centres.size()));
    if (!vertex) s.check("taking over points");
    for (const Point& p : centres) {
        s.store(p, radius, vertex);
        vertex[3] = static_cast<float>(radius);
        vertex += 4;
    }
    return s.attach(g, opacity, true);
}

void EmbreeScene::commit() {
    rtcCommitScene(state_->scene);
    state_->check("building its hierarchy");
}

double EmbreeScene::radius() const { return state_->radius; }
bool EmbreeScene::translucent() const { return state_->translucent; }
double EmbreeScene::rounding() const { return state_->rounding; }

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
    s.tidy(hits);
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
