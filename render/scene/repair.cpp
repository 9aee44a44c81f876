#include "scene/repair.h"

#include <algorithm>

#include "curves/bspline.h"
#include "curves/modify.h"

namespace isoparm {

namespace {

/// The diagnosis, and the data that `apply` makes of its repair.
template <class Data, class Repair, class Apply> Cure<Data> cure_of(const Diagnosis<Repair>& d, Apply apply) {
    Cure<Data> c{d.fits, d.misfit, d.changes, {}};
    if (d.repair) c.data = apply(*d.repair);
    return c;
}

std::array<Curve, 3> three(const Repair& r, const std::array<Curve, 3>& given) {
    const auto c = r({given.begin(), given.end()});
    return {c[0], c[1], c[2]};
}

SplineCurve reversed_spline(SplineCurve s) {
    std::reverse(s.points.begin(), s.points.end());
    const double sum = s.knots.front() + s.knots.back();
    std::reverse(s.knots.begin(), s.knots.end());
    for (double& t : s.knots) t = sum - t;
    return s;
}

}  // namespace

Cure<CoonsCurves> cure(const CoonsCurves& given) {
    return cure_of<CoonsCurves>(diagnose_frame(given), [&](const Repair& r) {
        const auto c = r({given.c0, given.c1, given.d0, given.d1});
        return CoonsCurves{c[0], c[1], c[2], c[3]};
    });
}

Cure<std::array<Curve, 3>> cure(const std::array<Curve, 3>& edges) {
    return cure_of<std::array<Curve, 3>>(diagnose_triangle(edges), [&](const Repair& r) { return three(r, edges); });
}
Cure<TriangleCurves> cure(const TriangleCurves& given) {
    return cure_of<TriangleCurves>(diagnose_triangle(given.edges), [&](const Repair& r) { return TriangleCurves{three(r, given.edges), three(r, given.along)}; });
}

Cure<CommonStart> cure(const CommonStart& given) {
    return cure_of<CommonStart>(diagnose_common_start(given.c, given.d), [&](const Repair& r) {
        const auto c = r({given.c, given.d});
        return CommonStart{c[0], c[1]};
    });
}

Cure<HermiteCurves> cure(const HermiteCurves& given) {
    return cure_of<HermiteCurves>(diagnose_hermite(given.data, given.twist), [&](const HermiteRepair& r) { return HermiteCurves{r(given.data), given.twist}; });
}

Cure<Network> cure(const Network& given) {
    if (given.a.size() < 2 || given.b.size() < 2) return {true, {}, {}, {}};  // another fault
    CurveNetwork n{{}, {}, {}, {}, "b", "a", false};
    for (std::size_t i = 0; i < given.a.size(); ++i) n.u_nodes.push_back(double(i));
    for (std::size_t j = 0; j < given.b.size(); ++j) n.v_nodes.push_back(double(j));
    for (const Curve& c : given.a) n.v_curves.push_back(reparametrized(c, 0, n.v_nodes.back()));
    for (const Curve& c : given.b) n.u_curves.push_back(reparametrized(c, 0, n.u_nodes.back()));
    return cure_of<Network>(diagnose_network(n), [&](const NetworkRepair& r) { return Network{r.v(r.swapped ? given.b : given.a), r.u(r.swapped ? given.a : given.b)}; });
}

Cure<GordonNetwork> cure(const GordonNetwork& given) {
    const CurveNetwork n{given.u_curves, given.v_curves, given.u_nodes, given.v_nodes};
    return cure_of<GordonNetwork>(diagnose_network(n), [&](const NetworkRepair& r) {
        return GordonNetwork{r.u(r.swapped ? given.v_curves : given.u_curves), given.v_nodes, r.v(r.swapped ? given.u_curves : given.v_curves), given.u_nodes, given.tolerance};
    });
}

Cure<ControlFrame> cure(const ControlFrame& given) {
    const std::vector<SplineCurve> splines{given.c0, given.c1, given.d0, given.d1};
    std::vector<Curve> c;
    try {
        for (const SplineCurve& s : splines) c.push_back(make_bspline(s.degree, s.knots, s.points));
    } catch (const Error&) {
        return {true, {}, {}, {}};  // another fault, which is reported already
    }
    return cure_of<ControlFrame>(diagnose_frame({c[0], c[1], c[2], c[3]}), [&](const Repair& r) {
        std::vector<SplineCurve> s;
        for (std::size_t k = 0; k < 4; ++k) s.push_back(r.reversed[k] ? reversed_spline(splines[r.order[k]]) : splines[r.order[k]]);
        return ControlFrame{s[0], s[1], s[2], s[3]};
    });
}

bool repair_wanted(const Json& surface, const SceneBuilder& scene) {
    if (surface.find("loop")) return true;  // its curves come in any order and direction
    const auto repair = surface.find("repair");
    return repair && scene.values().boolean(*repair);
}

void throw_advised(const Error& error, const std::string& advice) {
    if (const auto* e = dynamic_cast<const IncompatibleError*>(&error)) throw IncompatibleError(e->condition(), e->gap(), e->tolerance(), advice);
    throw Error(error.kind(), std::string(error.what()) + "; " + advice);
}

}  // namespace isoparm
