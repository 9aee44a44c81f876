// limit_composite.h -- the limit surface of a cage and the composite built on it, one patch a face of either, to be drawn beside each other.
#pragma once
#include "composite.h"
#include "limit.h"
#include "subdivision/limit_faces.h"

namespace isoparm {

/// Patches of the same names over the same parameters. The composite: over regular quads Hermite Coons patches of the limit's network (limit_network()); over all other faces
/// what limit_cell.h has as its best method, Gregory's on quads and Nielson's on triangles. All of them are of polynomial curves, so that they can be tessellated with a certificate.
struct LimitComposite {
    Composite limit, composite;
    int left_out = 0;  // patches of the limit that have none: a corner without tangents, or data that rounding keeps from fitting; in neither surface
};
/// `faces`: of the cage of `limit`. Does not depend on the number of threads.
LimitComposite make_limit_composite(const LimitSurface& limit, const LimitFaces& faces);

}  // namespace isoparm
