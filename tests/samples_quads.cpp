// samples_quads.cpp -- the types of surfaces on a rectangle.
#include "samples_parts.h"

#include <cmath>
#include <numbers>

#include "curves/bezier.h"
#include "curves/bspline.h"
#include "curves/hermite.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "patches/cone.h"
#include "patches/control_net.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/generalized_coons.h"
#include "patches/ruled.h"
#include "patches/tensor_bezier.h"
#include "patches/tensor_hermite.h"
#include "patches/transformed.h"
#include "patches/translational.h"
#include "scalar/elementary.h"

namespace isoparm::tests {
namespace {

/// Boundary of a Bezier patch, from the border of its net.
std::vector<Curve> border(const Grid<Point>& p, const Grid<double>& w = {}) {
    std::vector<Point> c0, c1;
    std::vector<double> w0, w1;
    for (std::size_t i = 0; i < p.size(); ++i) {
        c0.push_back(p[i].front()), c1.push_back(p[i].back());
        if (!w.empty()) w0.push_back(w[i].front()), w1.push_back(w[i].back());
    }
    return {make_bezier(c0, w0), make_bezier(p.back(), w.empty() ? w0 : w.back()), make_bezier(c1, w1),
            make_bezier(p.front(), w.empty() ? w0 : w.front())};
}
PatchSample rational_bezier_patch(Random& r) {
    const auto net = random_net(r, 4, 3);
    const auto w = random_weights(r, 4, 3);
    return {make_bezier_patch(net, w), border(net, w)};
}
PatchSample sphere_octant(Random& r) {
    const double s = std::sqrt(0.5);
    Grid<Point> p{
        {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    const Grid<double> w{{1, s, 1}, {s, 0.5, s}, {1, s, 1}};
    for (auto& row : p)
        for (auto& x : row) x += r.offset();
    return {make_bezier_patch(p, w), border(p, w)};
}
PatchSample spline_patch(Random& r) {
    const auto net = random_net(r, 6, 5);
    std::vector<Point> c0, c1;
    for (const auto& row : net) c0.push_back(row.front()), c1.push_back(row.back());
    const std::vector<double> ku{0, 0, 0, 0, 0.3, 0.7, 1, 1, 1, 1}, kv{-1, -1, -1, 0.5, 1, 2, 2, 2};
    return {make_bspline_patch(3, 2, ku, kv, net),
            {make_bspline(3, ku, c0), make_bspline(2, kv, net.back()), make_bspline(3, ku, c1),
             make_bspline(2, kv, net.front())}};
}

PatchSample coons_over(const Frame& e, const std::optional<Function>& blend = {}) {
    return {make_coons({e.c0, e.c1, e.d0, e.d1}, blend), {e.c0, e.d1, e.c1, e.d0}};
}
/// sin(pi t / 2)^2: a blend that is no polynomial
struct SineBlend {
    template <class S> S operator()(const S& t) const { return 0.5 * (1.0 - cos(t * std::numbers::pi)); }
};

/// Boundary, cross derivatives and their Bezier points; from a Bezier patch they are compatible.
struct HermiteNet {
    std::array<std::vector<Point>, 4> f, g;
};
HermiteNet hermite_net(Random& r) {
    const auto p = random_net(r, 5, 4);
    const int m = 4, n = 3;
    HermiteNet d;
    for (int j = 0; j <= n; ++j) {
        d.f[0].push_back(p[0][j]), d.f[3].push_back(p[m][j]);
        d.f[1].push_back(double(m) * (p[1][j] - p[0][j])), d.f[2].push_back(double(m) * (p[m][j] - p[m - 1][j]));
    }
    for (int i = 0; i <= m; ++i) {
        d.g[0].push_back(p[i][0]), d.g[3].push_back(p[i][n]);
        d.g[1].push_back(double(n) * (p[i][1] - p[i][0])), d.g[2].push_back(double(n) * (p[i][n] - p[i][n - 1]));
    }
    return d;
}
HermiteData hermite_data(const HermiteNet& d) {
    const auto curves = [](const std::array<std::vector<Point>, 4>& p) {
        return std::array<Curve, 4>{make_bezier(p[0]), make_bezier(p[1]), make_bezier(p[2]), make_bezier(p[3])};
    };
    return {curves(d.f), curves(d.g)};
}
PatchSample hermite_over(const HermiteData& d, Twist twist) {
    return {make_coons_hermite(d, twist), {d.g[0], d.f[3], d.g[3], d.f[0]}};
}
/// The inner points of the cross derivatives move: the twists no longer agree.
HermiteData twisted_data(Random& r) {
    HermiteNet d = hermite_net(r);
    for (int k : {1, 2}) {
        for (std::size_t i = 1; i + 1 < d.f[k].size(); ++i) d.f[k][i] += r.vector();
        for (std::size_t i = 1; i + 1 < d.g[k].size(); ++i) d.g[k][i] += r.vector();
    }
    return hermite_data(d);
}

/// 1 minus it
struct OtherBlend {
    template <class S> S operator()(const S& t) const { return 0.5 * (1.0 + cos(t * std::numbers::pi)); }
};
/// Hermite functionals along u, values with a blend that is no polynomial along v.
PatchSample generalized(Random& r) {
    const HermiteData d = hermite_data(hermite_net(r));
    const auto value = Functional::Kind::value, derivative = Functional::Kind::derivative;
    const GeneralizedCoons data{
        {{value, 0}, {derivative, 0}, {derivative, 1}, {value, 1}},
        {{value, 0}, {value, 1}},
        {Function::polynomial({1, 0, -3, 2}), Function::polynomial({0, 1, -2, 1}), Function::polynomial({0, 0, -1, 1}), Function::polynomial({0, 0, 3, -2})},
        {make_function(OtherBlend{}), make_function(SineBlend{})},
        {d.f[0], d.f[1], d.f[2], d.f[3]},
        {d.g[0], d.g[3]}};
    return {make_generalized_coons(data), {d.g[0], d.f[3], d.g[3], d.f[0]}};
}
PatchSample tensor_hermite(Random& r) {
    Grid<Point> p(3), du(3), dv(3), duv(3);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j) {
            p[i].push_back(r.point({double(i), double(j), 0}, 0.3));
            du[i].push_back(r.vector() + Point{1, 0, 0}), dv[i].push_back(r.vector() + Point{0, 1, 0}), duv[i].push_back(r.vector());
        }
    std::vector<Point> p0, p1, t0, t1;
    for (int i = 0; i < 3; ++i) p0.push_back(p[i][0]), p1.push_back(p[i][3]), t0.push_back(du[i][0]), t1.push_back(du[i][3]);
    return {make_tensor_hermite(p, du, dv, duv), {make_hermite(p0, t0), make_hermite(p[2], dv[2]), make_hermite(p1, t1), make_hermite(p[0], dv[0])}};
}
/// Control polygons of a frame, cubic with inner knots along u, quadratic along v.
PatchSample control_net(Random& r) {
    const auto p = random_net(r, 6, 4);
    const std::vector<double> ku{0, 0, 0, 0, 0.3, 1.1, 2, 2, 2, 2}, kv{1, 1, 1, 2.5, 3, 3, 3};
    SplineCurve c0{3, ku, {}}, c1{3, ku, {}}, d0{2, kv, p.front()}, d1{2, kv, p.back()};
    for (const auto& row : p) c0.points.push_back(row.front()), c1.points.push_back(row.back());
    const auto curve = [](const SplineCurve& c) { return make_bspline(c.degree, c.knots, c.points); };
    return {make_control_net({c0, c1, d0, d1}), {curve(c0), curve(d1), curve(c1), curve(d0)}};
}
PatchSample translational(Random& r, Curve (*between)(Random&, const Point&, const Point&)) {
    const Frame e = random_frame(r, between);
    return {make_translational(e.c0, e.d0), {e.c0}};
}
PatchSample translational_blend(Random& r) {
    const Frame e = random_frame(r);
    return {make_translational_blend({e.c0, e.c1, e.d0, e.d1}), {e.c0, e.d1, e.c1, e.d0}};
}
PatchSample ruled(Random& r, Curve (*between)(Random&, const Point&, const Point&)) {
    const Frame e = random_frame(r, between);
    return {make_ruled(e.c0, e.c1), {e.c0, make_line(e.c0(1), e.c1(1)), e.c1, make_line(e.c0(0), e.c1(0))}};
}
PatchSample cone_over(Random& r, const Curve& c) {
    const Point apex = r.point({1, 1, 2});
    const double a = c.begin(), b = c.end();
    return {make_cone(c, apex), {c, make_line(c(b), apex), make_line(apex, apex), make_line(c(a), apex)}};
}

}  // namespace

PatchSample bezier_patch(Random& r) {
    const auto net = random_net(r, 5, 4);
    return {make_bezier_patch(net), border(net)};
}
/// Knots of full multiplicity inside (C0 along u = 0.4), and a knot vector that is not clamped along v.
PatchSample nurbs_patch(Random& r) {
    return {make_bspline_patch(2, 3, {0, 0, 0, 0.4, 0.4, 1, 1, 1}, {0, 1, 2, 3, 4, 5, 6, 7, 8}, random_net(r, 5, 5),
                               random_weights(r, 5, 5)),
            {}};
}

const std::vector<PatchType>& quad_types() {
    static const std::vector<PatchType> list{
        {"bezier", bezier_patch},
        {"bezier_rational", rational_bezier_patch},
        {"sphere_octant", sphere_octant},
        {"bspline", spline_patch},
        {"nurbs_multiple_knots", nurbs_patch},
        {"coons", [](Random& r) { return coons_over(random_frame(r)); }},
        {"coons_of_lines",
         [](Random& r) {
             return coons_over(
                 random_frame(r, [](Random&, const Point& a, const Point& b) { return make_line(a, b); }));
         }},
        {"coons_of_splines", [](Random& r) { return coons_over(random_frame(r, cubic_spline)); }},
        {"coons_of_rationals", [](Random& r) { return coons_over(random_frame(r, rational_cubic)); }},
        {"coons_cubic_blend", [](Random& r) { return coons_over(random_frame(r), cubic_blend()); }},
        {"coons_sine_blend", [](Random& r) { return coons_over(random_frame(r), make_function(SineBlend{})); }},
        {"coons_hermite", [](Random& r) { return hermite_over(hermite_data(hermite_net(r)), Twist::compatible); }},
        {"coons_hermite_average", [](Random& r) { return hermite_over(twisted_data(r), Twist::average); }},
        {"coons_hermite_zero", [](Random& r) { return hermite_over(twisted_data(r), Twist::zero); }},
        {"gregory", [](Random& r) { return hermite_over(twisted_data(r), Twist::gregory); }},
        {"hermite_P1", [](Random& r) { return PatchSample{make_coons_hermite(twisted_data(r), Twist::average, Part::P1), {}}; }},
        {"coons_P2",
         [](Random& r) {
             const Frame e = random_frame(r);
             return PatchSample{make_coons({e.c0, e.c1, e.d0, e.d1}, {}, Part::P2), {e.c0}};
         }},
        {"generalized_coons", generalized},
        {"tensor_hermite", tensor_hermite},
        {"control_net", control_net},
        {"translational", [](Random& r) { return translational(r, random_cubic); }},
        {"translational_of_splines", [](Random& r) { return translational(r, cubic_spline); }},
        {"translational_blend", translational_blend},
        {"ruled", [](Random& r) { return ruled(r, random_cubic); }},
        {"ruled_of_rationals", [](Random& r) { return ruled(r, rational_cubic); }},
        {"cone", [](Random& r) { return cone_over(r, random_cubic(r, r.point(), r.point({2, 0, 0}))); }},
        {"cone_of_nurbs", [](Random& r) { return cone_over(r, nurbs(r)); }},
        {"transformed",
         [](Random& r) {
             Random h = r.here();
             PatchSample s = hermite_over(twisted_data(h), Twist::gregory);
             const Transform map = random_map(r);
             for (auto& c : s.boundary) c = transformed(c, map);
             return PatchSample{transformed(s.patch, map), s.boundary};
         }},
    };
    return list;
}

}  // namespace isoparm::tests
