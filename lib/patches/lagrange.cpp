#include "patches/lagrange.h"

#include "error.h"
#include "patches/boolean_sum.h"
#include "patches/edge_scalar.h"

namespace isoparm {

Patch make_lagrange(const std::vector<Curve>& curves, const std::vector<double>& nodes) {
    check_nodes("nodes", nodes, curves.size());
    // P2 alone: the surface interpolates across v.
    BooleanSum<LinearBasis, LagrangeBasis> surface{{}, LagrangeBasis(nodes), {}, {}, {}, Part::P2, {curves[0].begin(), curves[0].end(), nodes.front(), nodes.back()}};
    for (const Curve& c : curves) surface.g.push_back(reparametrized(c, curves[0].begin(), curves[0].end()));
    return make_patch_with_edges(std::move(surface));
}

}  // namespace isoparm
