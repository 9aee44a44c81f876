// patches/coons_hermite.h -- bicubically blended (Hermite) Coons patch and Gregory's square: boundary curves and cross
// derivatives are interpolated (Coons 1967; Gregory 1974; Farin 2002, 22.4-22.5; formula sheet A4, A5).
#pragma once
#include <array>

#include "patch.h"
#include "patches/boolean_sum.h"

namespace isoparm {
/// What to do where d/dv x_u and d/du x_v disagree at a corner. compatible: throw; average: their mean; zero: 0 (both
/// leave the cross derivatives uninterpolated near such corners); gregory: the rational twist, which interpolates both.
enum class Twist { compatible, gregory, average, zero };

struct HermiteData {
    std::array<Curve, 4> f;  // x(0,v), x_u(0,v), x_u(1,v), x(1,v)
    std::array<Curve, 4> g;  // x(u,0), x_v(u,0), x_v(u,1), x(u,1)
};
/// Throws IncompatibleError for positions and tangents that disagree, and for twists when `twist` is compatible.
Patch make_coons_hermite(const HermiteData& data, Twist twist = Twist::compatible, Part part = Part::sum);
/// The same with Gregory's twist, near its edges u = 0, 1 (`of_f`) or v = 0, 1: on_edges() of hermite_surface.h.
Patch gregory_on_edges(const HermiteData& data, bool of_f, double& slack);
}
