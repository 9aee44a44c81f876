#include "bare_embree.h"

#include <limits>
#include <stdexcept>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace isoparm::bench {
namespace {

/// As Embree's manual asks of threads that trace.
struct FlushSubnormals {
#if defined(__SSE__)
    unsigned before = _mm_getcsr();
    FlushSubnormals() { _mm_setcsr(before | 0x8040); }
    ~FlushSubnormals() { _mm_setcsr(before); }
#endif
};

#if RTC_VERSION_MAJOR >= 4
struct Query {
    RTCRayQueryContext context;
    RTCIntersectArguments arguments;
    Query() {
        rtcInitRayQueryContext(&context);
        rtcInitIntersectArguments(&arguments);
        arguments.context = &context;
        arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    }
};
void trace(RTCScene s, Query& q, RTCRayHit* r) { rtcIntersect1(s, r, &q.arguments); }
void trace(const int* valid, RTCScene s, Query& q, RTCRayHit16* r) { rtcIntersect16(valid, s, r, &q.arguments); }
#else
struct Query {
    RTCIntersectContext context;
    Query() {
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    }
};
void trace(RTCScene s, Query& q, RTCRayHit* r) { rtcIntersect1(s, &q.context, r); }
void trace(const int* valid, RTCScene s, Query& q, RTCRayHit16* r) { rtcIntersect16(valid, s, &q.context, r); }
#endif

RTCRayHit made(const Ray& ray, const Point& centre) {
    const Point o = ray.origin - centre;
    RTCRayHit r{};
    r.ray.org_x = float(o.x), r.ray.org_y = float(o.y), r.ray.org_z = float(o.z);
    r.ray.dir_x = float(ray.direction.x), r.ray.dir_y = float(ray.direction.y), r.ray.dir_z = float(ray.direction.z);
    r.ray.tfar = std::numeric_limits<float>::infinity();
    r.ray.mask = ~0u;
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return r;
}

RTCRayHit16 joined(const RTCRayHit* r) {
    RTCRayHit16 p{};
    for (int i = 0; i < 16; ++i) {
        p.ray.org_x[i] = r[i].ray.org_x, p.ray.org_y[i] = r[i].ray.org_y, p.ray.org_z[i] = r[i].ray.org_z;
        p.ray.dir_x[i] = r[i].ray.dir_x, p.ray.dir_y[i] = r[i].ray.dir_y, p.ray.dir_z[i] = r[i].ray.dir_z;
        p.ray.tfar[i] = r[i].ray.tfar;
        p.ray.mask[i] = r[i].ray.mask;
        p.hit.geomID[i] = p.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    return p;
}

}  // namespace

struct BareEmbree::State {
    RTCDevice device = rtcNewDevice("");
    RTCScene scene = rtcNewScene(device);
    std::vector<RTCRayHit> rays;
    std::vector<RTCRayHit16> packets;
    ~State() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
};

BareEmbree::BareEmbree(const Mesh& mesh, const Point& centre, const std::vector<Ray>& rays, bool robust)
    : state_(std::make_unique<State>()) {
    State& s = *state_;
    if (rays.size() % 16 != 0) throw std::logic_error("the number of rays is not divisible by 16");
    RTCGeometry g = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* x = static_cast<float*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                          3 * sizeof(float), mesh.positions.size()));
    auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), mesh.triangle_count()));
    if (!x || !index) throw std::runtime_error("Embree refuses the mesh");
    for (const Point& p : mesh.positions)
        for (int axis = 0; axis < 3; ++axis) *x++ = float(p[axis] - centre[axis]);
    for (const MeshPart& part : mesh.parts)
        for (const auto& t : part.triangles)
            for (const auto corner : t) *index++ = part.vertex[corner];
    rtcCommitGeometry(g);
    rtcAttachGeometry(s.scene, g);
    rtcReleaseGeometry(g);
    rtcSetSceneFlags(s.scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcCommitScene(s.scene);
    for (const Ray& ray : rays) s.rays.push_back(made(ray, centre));
    for (std::size_t k = 0; k < rays.size(); k += 16) s.packets.push_back(joined(&s.rays[k]));
}
BareEmbree::~BareEmbree() = default;

std::size_t BareEmbree::intersect_1() const {
    const FlushSubnormals flush;
    Query query;
    std::size_t hits = 0;
    for (const RTCRayHit& ray : state_->rays) {
        RTCRayHit r = ray;
        trace(state_->scene, query, &r);
        hits += r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
}

std::size_t BareEmbree::intersect_16() const {
    const FlushSubnormals flush;
    Query query;
    alignas(64) int valid[16];
    for (int& v : valid) v = -1;
    std::size_t hits = 0;
    for (const RTCRayHit16& packet : state_->packets) {
        RTCRayHit16 r = packet;
        trace(valid, state_->scene, query, &r);
        for (int i = 0; i < 16; ++i) hits += r.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
}

}  // namespace isoparm::bench
