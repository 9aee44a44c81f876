#include "patches/cone.h"

#include "error.h"
#include "patches/edge_scalar.h"

namespace isoparm {
namespace {

struct Cone {
    static constexpr Domain domain = Domain::quad;
    Curve curve;
    Point apex;
    std::vector<double> breaks_u() const { return break_parameters({curve}); }
    static std::vector<double> breaks_v() { return {}; }
    template <class U, class V> auto operator()(const U& u, const V& v) const { return (1.0 - v) * curve(u) + v * apex; }
};

}  // namespace

Patch make_cone(const Curve& curve, const Point& apex) {
    if (!finite(apex)) throw_input("apex: found a number that is not finite");
    return make_patch_with_edges(Cone{reparametrized(curve, 0, 1), apex});
}

}  // namespace isoparm
