// embree_rays.h -- how rays are asked for and answered: internal to embree_scene.cpp and embree_patches.cpp, the only files that know Embree.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include <cstdint>
#include <exception>
#include <tuple>
#include <vector>

#include "rays/embree_scene.h"
#include "rays/exact_quick.h"

namespace isoparm {

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

struct Geometry {
    std::uint32_t id = 0;
    std::uint32_t mesh = 0;  // number of the mesh it is a part of; meaningless for others
    EmbreeScene::Sheet sheet{1};
    EmbreeScene::Plane plane;
    bool solid = false;  // a tube or ball: counts once however often a ray passes through its skin
    bool quads = false;  // a QuadPart
    const ExactPatch* patch = nullptr;  // rays meet it itself; mesh is then its group
    const QuickPatch* quick = nullptr;  // of it; nullptr where float32 is of no use
    const Point* centre = nullptr;
    const double* radius = nullptr;  // of the scene, once it is complete
    bool ends_rays() const { return opaque() && !plane.shared(); }
    bool opaque() const { return sheet.opacity == 1 && !sheet.pane; }
};

/// Of each ray, what was surely met, as far as float32 tells: the hit that ends first.
struct QuickBest {
    std::uint32_t some = 0;  // lanes that have one
    const Geometry* geometry[EmbreeScene::packet];
    std::uint32_t leaf[EmbreeScene::packet];
    float x[EmbreeScene::packet], y[EmbreeScene::packet], near[EmbreeScene::packet], far[EmbreeScene::packet];
    float other[EmbreeScene::packet];  // where the nearest other one begins

    void put(int lane, const Geometry& from, std::uint32_t of_leaf, const QuickHits& hits);
};

/// What queries tell the callbacks of patches, which compute in double.
/// There is one of each for every ray of the query.
struct PatchRays {
    const RayPacket* rays = nullptr;
    Hit* nearest = nullptr;               // of patches
    bool* undecided = nullptr;
    std::vector<Hit>* layers = nullptr;   // of a single ray: where hits of what lets light through go; otherwise they count as any other
    const QuickRays* quick = nullptr;     // of packets, where float32 may tell
    QuickBest* best = nullptr;
};
/// Proves what rays in `active` surely meet, and leaves the nearest hit of each in rays.nearest; the lanes that must be traced again, in double.
std::uint32_t settle(PatchRays& rays, std::uint32_t active);

// ---- Embree 3 and 4 ask the same questions with different words ---------------------------------------------------
#if RTC_VERSION_MAJOR >= 4
using Context = RTCRayQueryContext;
struct Query {
    Context context;  // first: filters find the query by its address
    PatchRays* patches = nullptr;
    std::exception_ptr failed;  // no exception may pass through Embree
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
inline void intersect_1(RTCScene s, Query& q, RTCRayHit* r) { rtcIntersect1(s, r, &q.nearest); }
inline void intersect_16(const int* valid, RTCScene s, Query& q, RTCRayHit16* r) { rtcIntersect16(valid, s, r, &q.nearest); }
inline void occluded_1(RTCScene s, Query& q, RTCRay* r) { rtcOccluded1(s, r, &q.any); }
inline void occluded_16(const int* valid, RTCScene s, Query& q, RTCRay16* r) { rtcOccluded16(valid, s, r, &q.any); }
#else
using Context = RTCIntersectContext;
struct Query {
    Context context;
    PatchRays* patches = nullptr;
    std::exception_ptr failed;  // no exception may pass through Embree
    explicit Query(bool coherent = false) {
        rtcInitIntersectContext(&context);
        if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    }
};
inline void intersect_1(RTCScene s, Query& q, RTCRayHit* r) { rtcIntersect1(s, &q.context, r); }
inline void intersect_16(const int* valid, RTCScene s, Query& q, RTCRayHit16* r) { rtcIntersect16(valid, s, &q.context, r); }
inline void occluded_1(RTCScene s, Query& q, RTCRay* r) { rtcOccluded1(s, &q.context, r); }
inline void occluded_16(const int* valid, RTCScene s, Query& q, RTCRay16* r) { rtcOccluded16(valid, s, &q.context, r); }
#endif

/// What a callback does: what it throws ends its query, and is thrown again by rethrow().
template <class Work> void guarded(Query& query, Work work) {
    if (query.failed) return;
    try {
        work();
    } catch (...) {
        query.failed = std::current_exception();
    }
}
inline void rethrow(const Query& query) {
    if (query.failed) std::rethrow_exception(query.failed);
}

inline bool nearer(const Hit& a, const Hit& b) { return std::tie(a.distance, a.geometry, a.primitive) < std::tie(b.distance, b.geometry, b.primitive); }

/// Makes the leaves of a patch what rays meet: of user geometry whose user data is a Geometry.
void set_patch_callbacks(RTCGeometry geometry);

}  // namespace isoparm
