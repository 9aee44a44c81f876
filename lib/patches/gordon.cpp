#include "patches/gordon.h"

#include "patches/compatibility.h"
#include "patches/edge_scalar.h"

namespace isoparm {
namespace {

template <class Basis> Patch gordon(const Basis& u, const Basis& v, std::vector<Curve> f, std::vector<Curve> g, Grid<Point> corner, Part part, const Rect& rect) {
    return make_patch_with_edges(BooleanSum<Basis>{u, v, std::move(f), std::move(g), std::move(corner), part, rect});
}

}  // namespace

std::vector<Curve> run_over_nodes(const std::vector<Curve>& curves, const std::vector<double>& nodes) {
    const double begin = curves[0].begin(), end = curves[0].end();
    const auto own = [&](const Curve& c) { return c.begin() == begin && c.end() == end; };
    const bool share = std::all_of(curves.begin(), curves.end(), own) && begin <= nodes.front() && nodes.back() <= end;
    std::vector<Curve> list;
    for (const Curve& c : curves) list.push_back(share ? c : reparametrized(c, nodes.front(), nodes.back()));
    return list;
}

Patch make_gordon(const GordonNetwork& network, GordonBlend blend, Part part) {
    const auto &u = network.u_nodes, &v = network.v_nodes;
    check_nodes("v_nodes", v, network.u_curves.size());
    check_nodes("u_nodes", u, network.v_curves.size());
    const auto g = run_over_nodes(network.u_curves, u), f = run_over_nodes(network.v_curves, v);
    const double size = std::max(size_of({&f.front(), &f.back()}), size_of({&g.front(), &g.back()}));
    Grid<Point> corner(f.size(), std::vector<Point>(g.size()));
    for (std::size_t i = 0; i < f.size(); ++i)
        for (std::size_t j = 0; j < g.size(); ++j) {
            const Point a = f[i](v[j]), b = g[j](u[i]);
            const double gap = distance(a, b), tolerance = compatibility_tolerance * size + rounding_of(a, b);
            if (!(gap <= std::max(tolerance, network.tolerance)))
                throw IncompatibleError("v_curves[" + std::to_string(i) + "](" + to_text(v[j]) + ") = u_curves[" + std::to_string(j) + "](" + to_text(u[i]) + ")", gap, std::max(tolerance, network.tolerance));
            corner[i][j] = gap <= tolerance ? a : 0.5 * (a + b);
        }
    if (blend == GordonBlend::hermite)
        return gordon(HatBasis{Cells(u)}, HatBasis{Cells(v)}, f, g, corner, part, {u.front(), u.back(), v.front(), v.back()});
    return gordon(LagrangeBasis(u), LagrangeBasis(v), f, g, corner, part, {g[0].begin(), g[0].end(), f[0].begin(), f[0].end()});
}

}  // namespace isoparm
