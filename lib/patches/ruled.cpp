#include "patches/ruled.h"

#include "error.h"
#include "patches/boolean_sum.h"

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

Patch make_ruled(const Curve& c0, const Curve& c1) {
    return make_patch(BooleanSum<LinearBasis>{{}, {}, {}, {reparametrized(c0, 0, 1), reparametrized(c1, 0, 1)}, {}, Part::P2});
}

Patch make_cone(const Curve& curve, const Point& apex) {
    if (!finite(apex)) throw_input("apex: found a number that is not finite");
    return make_patch(Cone{reparametrized(curve, 0, 1), apex});
}

}  // namespace isoparm
