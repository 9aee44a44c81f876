// samples_networks.cpp -- the types of surfaces over many curves: networks, Lagrange, Gordon, generalised Coons over cells.
#include "samples_parts.h"

#include "curves/bezier.h"
#include "curves/interpolate.h"
#include "curves/isocurve.h"
#include "patches/basis.h"
#include "patches/generalized_coons.h"
#include "patches/gordon.h"
#include "patches/lagrange.h"
#include "patches/network.h"

namespace isoparm::tests {
namespace {

/// C1 cubic splines over a grid of points, so that knots are where the curves cross.
Network spline_network(Random& r, int m, int n) {
    std::vector<std::vector<Point>> p(m + 1);
    for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= n; ++j) p[i].push_back(r.point({double(i), double(j), 0}, 0.3));
    Network net;
    for (int i = 0; i <= m; ++i) net.a.push_back(make_interpolate(p[i], SplineEnds::catmull_rom));
    for (int j = 0; j <= n; ++j) {
        std::vector<Point> row;
        for (int i = 0; i <= m; ++i) row.push_back(p[i][j]);
        net.b.push_back(make_interpolate(row, SplineEnds::natural));
    }
    return net;
}
std::vector<Curve> border(const Network& net) { return {net.b.front(), net.a.back(), net.b.back(), net.a.front()}; }
PatchSample network_over(const Network& net, Twist twist) { return {make_network(net, twist), border(net)}; }
CrossDerivatives random_cross(Random& r, const Network& net) {
    Grid<Point> twists(net.a.size());
    for (auto& row : twists)
        for (std::size_t j = 0; j < net.b.size(); ++j) row.push_back(r.vector());
    return from_twists(net, twists);
}

/// Curves of a Bezier patch of degree 6 x 5 at nodes of both directions: they meet, and no blend here reproduces the patch.
GordonNetwork gordon_network(Random& r) {
    const auto p = random_net(r, 7, 6);
    GordonNetwork net{{}, {0, 0.3, 0.8, 1}, {}, {0, 0.55, 1}};
    for (const double v : net.v_nodes) {
        std::vector<Point> points;
        for (const auto& row : p) points.push_back(make_bezier(row)(v));
        net.u_curves.push_back(make_bezier(points));
    }
    for (const double u : net.u_nodes) {
        std::vector<Point> points;
        for (std::size_t j = 0; j < p[0].size(); ++j) {
            std::vector<Point> column;
            for (const auto& row : p) column.push_back(row[j]);
            points.push_back(make_bezier(column)(u));
        }
        net.v_curves.push_back(make_bezier(points));
    }
    return net;
}
PatchSample gordon_over(const GordonNetwork& net, GordonBlend blend) {
    return {make_gordon(net, blend), {net.u_curves.front(), net.v_curves.back(), net.u_curves.back(), net.v_curves.front()}};
}
/// Nodes beyond 0 and 1, breaks in the curves at and between them.
PatchSample gordon_of_splines(Random& r, GordonBlend blend) {
    const Network net = spline_network(r, 2, 3);
    return gordon_over({net.b, {0, 1, 2, 3}, net.a, {0, 1, 2}}, blend);
}
/// A C1 hat of width 2 over [0,2]; its pieces are chosen by the lower end of an interval, or one lane of a pack, so it is right inside
/// cells only. At 2, where the domain ends, no new piece begins.
struct Hat {
    double node;
    template <class S> S operator()(const S& t) const {
        const double inside = representative(t);
        const auto reached = [&](double start) { return inside >= start && start < 2; };
        if (reached(node + 1) || inside < node - 1) return S(0.0);
        const auto h = hermite_polynomials(S(reached(node) ? t - node : t - (node - 1)));
        return reached(node) ? h[0] : h[3];
    }
    Polynomial operator()(const Polynomial&) const { return Polynomial::nothing(); }
};
/// Piecewise cubic functions of both directions over nodes that are not only at the ends: their kinks must become breaks.
PatchSample generalized_hats(Random& r) {
    const Network net = spline_network(r, 2, 2);
    const auto value = Functional::Kind::value;
    const std::vector<Functional> nodes{{value, 0}, {value, 1}, {value, 2}};
    const std::vector<Function> hats{make_function(Hat{0}), make_function(Hat{1}), make_function(Hat{2})};
    return {make_generalized_coons({nodes, nodes, hats, hats, net.a, net.b}), border(net)};
}

/// Nodes inside the domain of the curves, which are no polynomials.
PatchSample gordon_inside(Random& r, GordonBlend blend) {
    const Patch p = make_bezier_patch(random_net(r, 4, 3), random_weights(r, 4, 3));
    GordonNetwork net{{}, {0.25, 0.75}, {}, {0.2, 0.5, 0.9}};
    for (const double v : net.v_nodes) net.u_curves.push_back(make_isocurve(p, Along::u, v));
    for (const double u : net.u_nodes) net.v_curves.push_back(make_isocurve(p, Along::v, u));
    return {make_gordon(net, blend), {}};
}

}  // namespace

const std::vector<PatchType>& network_types() {
    static const std::vector<PatchType> list{
        {"network", [](Random& r) { return network_over(spline_network(r, 3, 2), Twist::average); }},
        {"network_of_isocurves",
         [](Random& r) {
             const Patch p = bezier_patch(r).patch;
             return network_over(
                 {{make_isocurve(p, Along::v, 0), make_isocurve(p, Along::v, 0.5), make_isocurve(p, Along::v, 1)},
                  {make_isocurve(p, Along::u, 0), make_isocurve(p, Along::u, 1)}},
                 Twist::average);
         }},
        {"network_twists",
         [](Random& r) {
             const Network net = spline_network(r, 2, 2);
             return PatchSample{make_network(net, random_cross(r, net), Twist::compatible), border(net)};
         }},
        {"network_cross_derivatives_gregory",
         [](Random& r) {
             const Network net = spline_network(r, 2, 1);
             const CrossDerivatives A = random_cross(r, net), B = random_cross(r, net);  // of different twists
             return PatchSample{make_network(net, {A.A, B.B}, Twist::gregory), border(net)};
         }},
        {"network_zero", [](Random& r) { return network_over(spline_network(r, 1, 2), Twist::zero); }},
        {"network_gregory", [](Random& r) { return network_over(spline_network(r, 2, 3), Twist::gregory); }},
        {"network_P1P2_gregory",
         [](Random& r) { return PatchSample{make_network(spline_network(r, 2, 2), Twist::gregory, Part::P1P2), {}}; }},
        {"lagrange",
         [](Random& r) {
             const auto net = gordon_network(r);
             return PatchSample{make_lagrange(net.u_curves, {0, 1, 2.5, 3}), {net.u_curves.front()}};
         }},
        {"lagrange_of_splines",
         [](Random& r) {
             const auto net = spline_network(r, 3, 2);
             return PatchSample{make_lagrange(net.b, {-1, 0.5, 1}), {net.b.front()}};
         }},
        {"gordon", [](Random& r) { return gordon_over(gordon_network(r), GordonBlend::lagrange); }},
        {"gordon_hats", [](Random& r) { return gordon_over(gordon_network(r), GordonBlend::hermite); }},
        {"gordon_of_splines", [](Random& r) { return gordon_of_splines(r, GordonBlend::lagrange); }},
        {"gordon_hats_of_splines", [](Random& r) { return gordon_of_splines(r, GordonBlend::hermite); }},
        {"gordon_inside", [](Random& r) { return gordon_inside(r, GordonBlend::lagrange); }},
        {"gordon_hats_inside", [](Random& r) { return gordon_inside(r, GordonBlend::hermite); }},
        {"generalized_coons_hats", generalized_hats},
    };
    return list;
}

}  // namespace isoparm::tests
