// patches/nielson.h -- Nielson's side-vertex interpolants of boundary curves with cross derivatives (C1) or normals (G1) (Nielson
// 1979, 1987; formula sheet B6, B7).
#pragma once
#include <array>

#include "patch.h"
#include "patches/triangle_part.h"

namespace isoparm {
/// cross as in make_bbg_c1. A part is the interpolant T_k along the rays of vertex k alone; the sum has the weights
/// v^2 w^2 / (u^2 v^2 + v^2 w^2 + w^2 u^2). C1, at vertices with the gradient of the boundary tangents; second derivatives there depend on
/// the direction. Over boxes that hold a vertex positions are enclosed, derivatives are not (Interval::all()).
Patch make_nielson_c1(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& cross, TrianglePart part = TrianglePart::sum);
/// normals[k](t) is normal to the surface along E_k, of any length but 0 (it is scaled by one factor for each edge: lengths along it may differ by 1e100); at a vertex those of the two edges are parallel. The tangent
/// plane is interpolated along the boundary; at a vertex derivatives depend on the direction, within the plane. Throws IncompatibleError also
/// where a normal is not normal to its own edge (at 17 samples) or to the other edge of a vertex, Error(input) where one is not proved not to be 0.
Patch make_nielson_g1(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& normals, TrianglePart part = TrianglePart::sum);
}
