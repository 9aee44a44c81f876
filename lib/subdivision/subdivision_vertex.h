// subdivision_vertex.h -- position and normal of the limit surface at a corner of a face; internal to subdivision_face.cpp.
#pragma once
#include <optional>

#include "subdivision/subdivision_ring.h"

namespace isoparm {

using Box3 = Vec3<Interval>;

inline double size_of(const Box3& b) { return rounding::length_up(b.x.hi - b.x.lo, b.y.hi - b.y.lo, b.z.hi - b.z.lo); }
inline Point middle(const Box3& b) { return {mid(b.x), mid(b.y), mid(b.z)}; }
inline Box3 hull(const Box3& a, const Box3& b) { return {hull(a.x, b.x), hull(a.y, b.y), hull(a.z, b.z)}; }
/// All rules are means with weights >= 0, so the limit surface over the face lies in the hull of its ring.
inline Box3 hull_of(const Ring<Interval>& ring) {
    Box3 all = ring.points[0];
    for (const auto& p : ring.points) all = hull(all, p);
    return all;
}

/// The limit position of corner k of the face: its ring shrinks towards it.
Box3 limit_position(Ring<Interval> ring, int k, Scheme scheme);
/// The limit of the normals of the sub-faces at corner k; none where that is not found to some 1e-13.
std::optional<Point> limit_normal(const Ring<Interval>& exact, int k, Scheme scheme);

}  // namespace isoparm
