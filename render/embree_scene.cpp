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

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace isoparm {
namespace {

/// Subnormal numbers slow traversal down; they are flushed while this lives, on this thread only.
class FlushSubnormals {
#if defined(__SSE__)
public:
    FlushSubnormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040); }  // FTZ | DAZ
    ~FlushSubnormals() { _mm_setcsr(before_); }

private:
    unsigned before_;
#else
public:
    FlushSubnormals() {}
#endif
};

struct Geometry {
    std::uint32_t id = 0;
    std::uint32_t mesh = 0;  // number of the mesh it is a part of; meaningless for others
    float opacity = 1;
    bool solid = false;  // a tube or ball: counts once however often a ray passes through its skin
    const ExactPatch* patch = nullptr;  // rays meet it itself; mesh is then its group
    const Point* centre = nullptr;
    const double* radius = nullptr;  // of the scene, once it is complete
};

/// What queries tell the callbacks of patches, which compute in double.
/// There is one of each for every ray of the query.
struct PatchRays {
    const RayPacket* rays = nullptr;
    Hit* nearest = nullptr;               // of patches
    bool* undecided = nullptr;
    std::vector<Hit>* layers = nullptr;   // where hits of what lets light through go; otherwise they count as any other
    double* transmittance = nullptr;      // of a single shadow ray
};

// ---- Embree 3 and 4 ask the same questions with different words ---------------------------------------------------
#if RTC_VERSION_MAJOR >= 4
using Context = RTCRayQueryContext;
struct Query {
    Context context;  // first: filters find the query by its address
    PatchRays* patches = nullptr;
    RTCIntersectArguments nearest;
    RTCOccludedArguments any;
    explicit Query(bool coherent = false) {
        rtcInitRayQueryContext(&context);
        rtcInitIntersectArguments(&nearest);
        rtcInitOccludedArguments(&any);
        nearest.context = any.context = &context;
        if (coherent) nearest.flags = any.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    }
};
void intersect_1(RTCScene s, Query& q, RTCRayHit* r) { rtcIntersect1(s, r, &q.nearest); }
void intersect_16(const int* valid, RTCScene s, Query& q, RTCRayHit16* r) { rtcIntersect16(valid, s, r, &q.nearest); }
void occluded_1(RTCScene s, Query& q, RTCRay* r) { rtcOccluded1(s, r, &q.any); }
void occluded_16(const int* valid, RTCScene s, Query& q, RTCRay16* r) { rtcOccluded16(valid, s, r, &q.any); }
#else
using Context = RTCIntersectContext;
struct Query {
    Context context;
    PatchRays* patches = nullptr;
    explicit Query(bool coherent = false) {
        rtcInitIntersectContext(&context);
        if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    }
};
void intersect_1(RTCScene s, Query& q, RTCRayHit* r) { rtcIntersect1(s, &q.context, r); }
void intersect_16(const int* valid, RTCScene s, Query& q, RTCRayHit16* r) { rtcIntersect16(valid, s, &q.context, r); }
void occluded_1(RTCScene s, Query& q, RTCRay* r) { rtcOccluded1(s, &q.context, r); }
void occluded_16(const int* valid, RTCScene s, Query& q, RTCRay16* r) { rtcOccluded16(valid, s, &q.context, r); }
#endif

struct LayerQuery : Query {
    std::vector<Hit>* hits = nullptr;
};
struct ShadowQuery : Query {
    EmbreeScene::Shadows shadows = EmbreeScene::Shadows::light;
    double transmittance = 1;
    std::vector<std::uint32_t> solids;
};

double sheet_lets_through(const Geometry& geometry, EmbreeScene::Shadows shadows) {
    const double o = geometry.opacity;
    return shadows == EmbreeScene::Shadows::physical ? 1 - o : 1 - o * o * o;
}

// The two filters refuse every hit of geometry that lets light through, so that Embree goes on to the next; they are
// called for single rays only.
void remember_layer(const RTCFilterFunctionNArguments* a) {
    auto& query = static_cast<LayerQuery&>(*reinterpret_cast<Query*>(a->context));
    Hit h;
    h.distance = RTCRayN_tfar(a->ray, a->N, 0);
    h.geometry = RTCHitN_geomID(a->hit, a->N, 0);
    h.primitive = RTCHitN_primID(a->hit, a->N, 0);
    h.u = RTCHitN_u(a->hit, a->N, 0);
    h.v = RTCHitN_v(a->hit, a->N, 0);
    h.normal = {RTCHitN_Ng_x(a->hit, a->N, 0), RTCHitN_Ng_y(a->hit, a->N, 0), RTCHitN_Ng_z(a->hit, a->N, 0)};
    query.hits->push_back(h);
    a->valid[0] = 0;
}

void dim_light(const RTCFilterFunctionNArguments* a) {
    auto& query = static_cast<ShadowQuery&>(*reinterpret_cast<Query*>(a->context));
    const auto& geometry = *static_cast<const Geometry*>(a->geometryUserPtr);
    a->valid[0] = 0;
    if (geometry.solid) {
        if (std::find(query.solids.begin(), query.solids.end(), geometry.id) != query.solids.end()) return;
        query.solids.push_back(geometry.id);
        query.transmittance *= 1 - static_cast<double>(geometry.opacity);
        return;
    }
    query.transmittance *= sheet_lets_through(geometry, query.shadows);
}

/// Normal numbers again, for proofs.
class KeepSubnormals {
#if defined(__SSE__)
public:
    KeepSubnormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ & ~0x8040u); }
    ~KeepSubnormals() { _mm_setcsr(before_); }

private:
    unsigned before_;
#else
public:
    KeepSubnormals() {}
#endif
};

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
bool nearer(const Hit& a, const Hit& b) { return std::tie(a.distance, a.geometry, a.primitive) < std::tie(b.distance, b.geometry, b.primitive); }

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

void intersect_leaf(const RTCIntersectFunctionNArguments* a) {
    auto& query = *reinterpret_cast<Query*>(a->context);
    const auto& geometry = *static_cast<const Geometry*>(a->geometryUserPtr);
    RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
    RTCHitN* hits = RTCRayHitN_HitN(a->rayhit, a->N);
    meet_leaf(a->valid, rays, a->N, *geometry.patch, a->primID, *query.patches, [&](unsigned lane, unsigned ray, const Roots& roots) {
        for (int r = 0; r < roots.count; ++r) {
            const Hit hit = hit_of(roots.root[r], geometry.id, a->primID);
            if (geometry.opacity < 1 && query.patches->layers) {
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
    });
}

void shadow_of_leaf(const RTCOccludedFunctionNArguments* a) {
    auto& query = *reinterpret_cast<Query*>(a->context);
    const auto& geometry = *static_cast<const Geometry*>(a->geometryUserPtr);
    meet_leaf(a->valid, a->ray, a->N, *geometry.patch, a->primID, *query.patches, [&](unsigned lane, unsigned, const Roots& roots) {
        for (int r = 0; r < roots.count; ++r) {
            if (geometry.opacity < 1) *query.patches->transmittance *= sheet_lets_through(geometry, static_cast<ShadowQuery&>(query).shadows);
            else RTCRayN_tfar(a->ray, a->N, lane) = -std::numeric_limits<float>::infinity();
        }
    });
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
            rtcSetGeometryOccludedFilterFunction(g, dim_light);
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
    double transmittance(const Ray& ray, Shadows shadows) const {
        ShadowQuery query;
        query.shadows = shadows;
        RTCRay r;
        RayPacket planes;
        enter(ray, r, planes);
        bool open = false;
        PatchRays to_patches;
        if (patches) {
            to_patches.rays = &planes, to_patches.undecided = &open, to_patches.transmittance = &query.transmittance;
            query.patches = &to_patches;
        }
        occluded_1(scene, query, &r);
        note(&open, 1);
        return r.tfar < 0 ? 0 : query.transmittance;
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
    Geometry& data = s.geometries.emplace_back(Geometry{0, group, static_cast<float>(opacity), false, &patch, &s.centre, &s.radius});
    rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(patch.leaves()));
    rtcSetGeometryUserData(g, &data);
    rtcSetGeometryBoundsFunction(g, bounds_of_leaf, nullptr);
    rtcSetGeometryIntersectFunction(g, intersect_leaf);
    rtcSetGeometryOccludedFunction(g, shadow_of_leaf);
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
    PatchRays to_patches{&planes, hits, open};
    Query query(true);
    if (s.patches) query.patches = &to_patches;
    {
        const FlushSubnormals flush;
        intersect_16(valid, s.scene, query, &r);
    }
    s.note(open, static_cast<std::uint64_t>(n));
    for (int i = 0; i < n; ++i) {
        const std::uint32_t geometry = r.hit.geomID[i];
        if (geometry == RTC_INVALID_GEOMETRY_ID) hits[i] = Hit{};
        else if (s.patches && s.geometries[geometry].patch) hits[i].distance += start[i];
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
    std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
        return std::tie(a.distance, a.geometry, a.primitive) < std::tie(b.distance, b.geometry, b.primitive);
    });
    hits.erase(std::unique(hits.begin(), hits.end(), [&](const Hit& a, const Hit& b) { return s.same_place(a, b); }),
               hits.end());
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (s.geometries[hits[i].geometry].solid)
            hits.erase(std::remove_if(hits.begin() + i + 1, hits.end(),
                                      [&](const Hit& h) { return h.geometry == hits[i].geometry; }),
                       hits.end());
    for (Hit& h : hits) h.distance += start;
}

void EmbreeScene::transmittance(const Ray* rays, int n, std::uint32_t active, double* result, Shadows shadows) const {
    const State& s = *state_;
    std::fill(result, result + n, 1.0);
    if (active == 0) return;
    const FlushSubnormals flush;
    if (s.translucent) {
        for (int i = 0; i < n; ++i)
            if (active >> i & 1) result[i] = s.transmittance(rays[i], shadows);
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
    if (s.patches) query.patches = &to_patches;
    occluded_16(valid, s.scene, query, &r);
    s.note(open, static_cast<std::uint64_t>(std::popcount(active)));
    for (int i = 0; i < n; ++i)
        if (valid[i] && r.tfar[i] < 0) result[i] = 0;
}

}  // namespace isoparm
