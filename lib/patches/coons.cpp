#include "patches/coons.h"

#include "patches/compatibility.h"
#include "patches/edge_scalar.h"

namespace isoparm {
namespace {

template <class Basis> Patch coons(const Basis& basis, const CoonsCurves& c, Part part) {
    return make_patch_with_edges(BooleanSum<Basis>{basis, basis, {c.d0, c.d1}, {c.c0, c.c1}, {{c.c0(0), c.c1(0)}, {c.c0(1), c.c1(1)}}, part});
}

}  // namespace

Function cubic_blend() { return Function::polynomial({0, 0, 3, -2}); }

CoonsCurves closed_frame(const CoonsCurves& curves) {
    const CoonsCurves c{reparametrized(curves.c0, 0, 1), reparametrized(curves.c1, 0, 1), reparametrized(curves.d0, 0, 1), reparametrized(curves.d1, 0, 1)};
    const double size = size_of({&c.c0, &c.c1, &c.d0, &c.d1});
    require_equal("c0(0) = d0(0)", c.c0(0), c.d0(0), size);
    require_equal("c0(1) = d1(0)", c.c0(1), c.d1(0), size);
    require_equal("c1(0) = d0(1)", c.c1(0), c.d0(1), size);
    require_equal("c1(1) = d1(1)", c.c1(1), c.d1(1), size);
    return c;
}

Patch make_coons(const CoonsCurves& curves, const std::optional<Function>& blend, Part part) {
    const CoonsCurves c = closed_frame(curves);
    if (!blend) return coons(LinearBasis{}, c, part);
    if (const double gap = std::abs((*blend)(0)); !(gap <= 1e-12)) throw IncompatibleError("blend H(0) = 0", gap, 1e-12);
    if (const double gap = std::abs((*blend)(1) - 1); !(gap <= 1e-12)) throw IncompatibleError("blend H(1) = 1", gap, 1e-12);
    return coons(BlendBasis{*blend}, c, part);
}

}  // namespace isoparm
