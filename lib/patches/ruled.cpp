#include "patches/ruled.h"

#include "patches/boolean_sum.h"
#include "patches/edge_scalar.h"

namespace isoparm {

Patch make_ruled(const Curve& c0, const Curve& c1) {
    // P2 alone: linear across v.
    return make_patch_with_edges(BooleanSum<LinearBasis>{{}, {}, {}, {reparametrized(c0, 0, 1), reparametrized(c1, 0, 1)}, {}, Part::P2});
}

}  // namespace isoparm
