#include "patches/translational.h"

#include "patches/compatibility.h"
#include "patches/edge_scalar.h"

namespace isoparm {
namespace {

struct Translational {
    static constexpr Domain domain = Domain::quad;
    Curve c, d;
    Point a;
    std::vector<double> breaks_u() const { return break_parameters({c}); }
    std::vector<double> breaks_v() const { return break_parameters({d}); }
    template <class U, class V> auto operator()(const U& u, const V& v) const { return c(u) + (d(v) - a); }
};

struct TranslationalBlend {
    static constexpr Domain domain = Domain::quad;
    CoonsCurves x;
    Point p00, p01, p10, p11;
    std::vector<double> breaks_u() const { return break_parameters({x.c0, x.c1}); }
    std::vector<double> breaks_v() const { return break_parameters({x.d0, x.d1}); }
    template <class U, class V> auto operator()(const U& u, const V& v) const {
        const auto c0 = x.c0(u), c1 = x.c1(u);
        const auto d0 = x.d0(v), d1 = x.d1(v);
        const auto t00 = c0 + (d0 - p00), t01 = c1 + (d0 - p01), t10 = c0 + (d1 - p10), t11 = c1 + (d1 - p11);
        return (1.0 - u) * ((1.0 - v) * t00 + v * t01) + u * ((1.0 - v) * t10 + v * t11);
    }
};

}  // namespace

Patch make_translational(const Curve& c, const Curve& d) {
    const Curve x = reparametrized(c, 0, 1), y = reparametrized(d, 0, 1);
    require_equal("c(0) = d(0)", x(0), y(0), size_of({&x, &y}));
    return make_patch_with_edges(Translational{x, y, x(0)});
}

Patch make_translational_blend(const CoonsCurves& curves) {
    const CoonsCurves x = closed_frame(curves);
    return make_patch_with_edges(TranslationalBlend{x, x.c0(0), x.c1(0), x.c0(1), x.c1(1)});
}

}  // namespace isoparm
