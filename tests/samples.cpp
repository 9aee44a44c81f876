#include "samples.h"

#include <algorithm>
#include <cmath>

#include "curves/arc.h"
#include "curves/bezier.h"
#include "curves/bspline.h"
#include "curves/hermite.h"
#include "curves/interpolate.h"
#include "curves/isocurve.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "patches/basis.h"
#include "patches/bbg.h"
#include "patches/bezier_triangle.h"
#include "patches/cone.h"
#include "patches/control_net.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/generalized_coons.h"
#include "patches/gordon.h"
#include "patches/lagrange.h"
#include "patches/network.h"
#include "patches/nielson.h"
#include "patches/ruled.h"
#include "patches/side_vertex.h"
#include "patches/tensor_bezier.h"
#include "patches/tensor_hermite.h"
#include "patches/three_curves.h"
#include "patches/transformed.h"
#include "patches/translational.h"
#include "scalar/elementary.h"

namespace isoparm::tests {
namespace {

std::vector<Point> random_points(Random& r, int count) {
    std::vector<Point> list;
    for (int i = 0; i < count; ++i) list.push_back(r.point({0.7 * i, 0, 0}));
    return list;
}
std::vector<double> random_weights(Random& r, int count) {
    std::vector<double> list;
    for (int i = 0; i < count; ++i) list.push_back(r.number(0.4, 2.5));
    return list;
}
Grid<double> random_weights(Random& r, int rows, int columns) {
    Grid<double> grid;
    for (int i = 0; i < rows; ++i) grid.push_back(random_weights(r, columns));
    return grid;
}
/// An affine map without symmetry, and the offset of the data after it.
Transform random_map(Random& r) {
    return Transform::translate(r.offset()) * Transform::mirror(r.vector() + Point{0, 0, 2}, 0.3) *
           Transform::rotate({1, 2, 3}, r.number(0, 360)) * Transform::scale({1.5, 0.5, 2});
}

// ---- curves ---------------------------------------------------------------------------------------------------------
Curve nurbs(Random& r) {
    return make_bspline(3, {0, 0, 0, 0, 0.2, 0.5, 0.5, 1.1, 1.1, 1.1, 2, 2, 2, 2}, random_points(r, 10),
                        random_weights(r, 10));
}
Curve isocurve_of_spline(Random& r) {
    return make_isocurve(
        make_bspline_patch(3, 2, {0, 0, 0, 0, 0.4, 1, 1, 1, 1}, {0, 0, 0, 1, 2, 2, 2}, random_net(r, 5, 4)), Along::u,
        0.7);
}
Curve arc(Random& r, double degrees) {
    const Point center = r.point(), a = r.vector() + Point{2, 0, 0};
    const Transform turn = Transform::rotate(cross(a, r.vector() + Point{0, 3, 0}), degrees);
    return make_arc(center, center + a, center + turn.vector(a));
}
/// A helix: not a spline, so it runs on jets only.
struct Helix {
    Point center;
    double begin = -1, end = 2.5;
    template <class S> Vec3<S> operator()(const S& t) const {
        return {cos(t) + center.x, sin(t) + center.y, S(exp(t * 0.3)) + center.z};
    }
    Vec3<Polynomial> operator()(const Polynomial&) const {
        return {Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()};
    }
};

Curve cubic_spline(Random& r, const Point& from, const Point& to) {
    return make_interpolate({from, 0.6 * from + 0.4 * to + r.vector(0.3), 0.3 * from + 0.7 * to + r.vector(0.3), to},
                            SplineEnds::natural);
}
Curve rational_cubic(Random& r, const Point& from, const Point& to) {
    return make_bezier({from, 0.7 * from + 0.3 * to + r.vector(0.5), 0.3 * from + 0.7 * to + r.vector(0.5), to},
                       random_weights(r, 4));
}

// ---- surfaces on a rectangle ----------------------------------------------------------------------------------------
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
PatchSample bezier_patch(Random& r) {
    const auto net = random_net(r, 5, 4);
    return {make_bezier_patch(net), border(net)};
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
/// Knots of full multiplicity inside (C0 along u = 0.4), and a knot vector that is not clamped along v.
PatchSample nurbs_patch(Random& r) {
    return {make_bspline_patch(2, 3, {0, 0, 0, 0.4, 0.4, 1, 1, 1}, {0, 1, 2, 3, 4, 5, 6, 7, 8}, random_net(r, 5, 5),
                               random_weights(r, 5, 5)),
            {}};
}

PatchSample coons_over(const Frame& e, const std::optional<Function>& blend = {}) {
    return {make_coons({e.c0, e.c1, e.d0, e.d1}, blend), {e.c0, e.d1, e.c1, e.d0}};
}
/// sin(pi t / 2)^2: a blend that is no polynomial
struct SineBlend {
    template <class S> S operator()(const S& t) const { return 0.5 * (1.0 - cos(t * std::numbers::pi)); }
    Polynomial operator()(const Polynomial&) const { return Polynomial::nothing(); }
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
/// 1 minus it
struct OtherBlend {
    template <class S> S operator()(const S& t) const { return 0.5 * (1.0 + cos(t * std::numbers::pi)); }
    Polynomial operator()(const Polynomial&) const { return Polynomial::nothing(); }
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
/// A C1 hat of width 2; its pieces are chosen by the lower end of an interval, so it is right inside cells only.
struct Hat {
    double node;
    template <class S> S operator()(const S& t) const {
        const double inside = representative(t);
        const bool beyond = inside > node + 1 || (inside == node + 1 && inside < 2);  // at 2 the domain ends: no new piece begins
        if (beyond || inside < node - 1) return S(0.0);
        const auto h = hermite_polynomials(S(inside >= node ? t - node : t - (node - 1)));
        return inside >= node ? h[0] : h[3];
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

// ---- surfaces on a triangle -----------------------------------------------------------------------------------------
PatchSample bezier_triangle(Random& r, int degree, bool rational) {
    std::vector<Point> points;
    std::vector<double> weights;
    std::vector<std::vector<Point>> p(degree + 1);
    std::vector<std::vector<double>> w(degree + 1);
    for (int k = 0; k <= degree; ++k)
        for (int j = 0; j <= degree - k; ++j) {
            const double u = double(degree - j - k) / degree, v = double(j) / degree;
            p[k].push_back(r.point({2 * u, 2 * v, u * v}, 0.3));
            w[k].push_back(rational ? r.number(0.5, 2) : 1);
            points.push_back(p[k][j]), weights.push_back(w[k][j]);
        }
    std::vector<Point> e[3];
    std::vector<double> x[3];
    for (int t = 0; t <= degree; ++t) {
        e[0].push_back(p[t][degree - t]), x[0].push_back(w[t][degree - t]);
        e[1].push_back(p[degree - t][0]), x[1].push_back(w[degree - t][0]);
        e[2].push_back(p[0][t]), x[2].push_back(w[0][t]);
    }
    PatchSample s{make_bezier_triangle(degree, points, rational ? weights : std::vector<double>{}), {}};
    for (int k = 0; k < 3; ++k) s.boundary.push_back(make_bezier(e[k], rational ? x[k] : std::vector<double>{}));
    return s;
}
PatchSample side_vertex(const std::array<Curve, 3>& e, const Function& h, SideVertexForm form) {
    return {make_side_vertex(e, h, form), {e[0], e[1], e[2]}};
}
template <SideVertexForm form> PatchSample side_vertex(Random& r, std::vector<double> h) {
    return side_vertex(random_triangle(r), Function::polynomial(std::move(h)), form);
}
constexpr auto kDelta = SideVertexForm::delta, kSeed = SideVertexForm::seed;

PatchSample side_vertex_part(Random& r, SideVertexForm form, SideVertexPart part, std::vector<int> free) {
    const auto e = random_triangle(r);
    return {make_side_vertex(e, Function::polynomial({0, 0, 1}), form, part), {e[0], e[1], e[2]}, std::move(free)};
}
PatchSample bbg_over(const std::array<Curve, 3>& e, const BbgForm& form) {
    std::vector<int> free;
    if (form.kind == BbgForm::Kind::projector) free = {form.i - 1};
    return {make_bbg(e, form), {e[0], e[1], e[2]}, free};
}
template <BbgForm::Kind kind, int i = 1, int j = 2> PatchSample bbg(Random& r) { return bbg_over(random_triangle(r), {kind, i, j}); }
PatchSample bbg_c1(const std::array<Curve, 3>& e, const std::array<Curve, 3>& d, int projector = 0) {
    return {make_bbg_c1(e, d, TrianglePart(projector)), {e[0], e[1], e[2]}, projector == 0 ? std::vector<int>{} : std::vector<int>{projector - 1}};
}
PatchSample nielson_c1(const std::array<Curve, 3>& e, const std::array<Curve, 3>& d, int ray = 0) {
    return {make_nielson_c1(e, d, TrianglePart(ray)), {e[0], e[1], e[2]}, ray == 0 ? std::vector<int>{} : std::vector<int>{ray % 3, (ray + 1) % 3}};
}
PatchSample with_cross(Random& r, PatchSample (*make)(const std::array<Curve, 3>&, const std::array<Curve, 3>&, int), int part = 0,
                       Curve (*between)(Random&, const Point&, const Point&) = random_cubic) {
    const auto e = random_triangle(r, between);
    return make(e, random_cross(r, e), part);
}
PatchSample nielson_g1(Random& r) {
    const auto e = random_triangle(r);
    return {make_nielson_g1(e, normals_of(e, random_cross(r, e, 0.2))), {e[0], e[1], e[2]}};
}
/// Edges that are no splines: sines, so that all runs on jets.
struct Wave {
    Point from, to, bend;
    double begin = 0, end = 1;
    template <class S> Vec3<S> operator()(const S& t) const {
        const S wave = sin(t * 3.0);
        const auto bump = t * (1.0 - t) * wave;
        const auto at = [&](int axis) -> S { return from[axis] + t * (to[axis] - from[axis]) + bump * bend[axis]; };
        return {at(0), at(1), at(2)};
    }
    Vec3<Polynomial> operator()(const Polynomial&) const { return {Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()}; }
};
Curve wave(Random& r, const Point& from, const Point& to) { return make_curve(Wave{from, to, r.vector(2)}); }

/// A rational cubic with weights of 1e-3 to 1e3; a narrow bump beside the far end; a corner that no break tells of.
Curve heavy(Random& r, const Point& from, const Point& to) {
    return make_bezier({from, 0.7 * from + 0.3 * to + r.vector(0.5), 0.3 * from + 0.7 * to + r.vector(0.5), to}, {1, 1e3, 1e-3, 1});
}
struct Bump {
    Point from, to;
    bool corner;
    double begin = 0, end = 1;
    template <class S> Vec3<S> operator()(const S& t) const {
        const S high = corner ? S(absolute(S(t - 0.9)) - 0.9 + t * 0.8) : S(t * (1.0 - t) * exp(S(-square(S((t - 0.9) * 50.0)))));
        return {S(from.x + t * (to.x - from.x)), S(from.y + t * (to.y - from.y)), S(from.z + t * (to.z - from.z) + high)};
    }
    Vec3<Polynomial> operator()(const Polynomial&) const { return {Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()}; }
};
Curve bump(Random&, const Point& from, const Point& to) { return make_curve(Bump{from, to, false}); }
Curve corner(Random&, const Point& from, const Point& to) { return make_curve(Bump{from, to, true}); }
/// H = t from 0 on, with a kink or a switch there.
struct FromZero {
    bool larger_of;
    template <class S> S operator()(const S& t) const { return larger_of ? larger(S(0.0), t) : choose(Comparison::less_equal, t, S(0.0), S(0.0), t, true); }
    Polynomial operator()(const Polynomial&) const { return Polynomial::nothing(); }
};

const std::vector<double> kT{0, 1}, kT2{0, 0, 1}, kT3{0, 0, 0, 1}, kQuartic{0, 0, 0, 2, -1}, kSmooth{0, 0, 3, -2};

}  // namespace

const std::vector<CurveType>& curve_types() {
    static const std::vector<CurveType> list{
        {"line", [](Random& r) { return make_line(r.point(), r.point()); }},
        {"bezier", [](Random& r) { return make_bezier(random_points(r, 6)); }},
        {"bezier_point", [](Random& r) { return make_bezier({r.point()}); }},
        {"bezier_degree_12", [](Random& r) { return make_bezier(random_points(r, 13)); }},
        {"bezier_rational", [](Random& r) { return make_bezier(random_points(r, 5), random_weights(r, 5)); }},
        {"bspline",
         [](Random& r) {
             return make_bspline(3, {0, 0, 0, 0, 0.3, 1, 1.7, 2, 2, 2, 2}, random_points(r, 7));
         }},
        {"bspline_multiple_knots",
         [](Random& r) {
             return make_bspline(3, {0, 0, 0, 0, 1, 1, 2, 2, 2, 3, 3, 3, 3}, random_points(r, 9));
         }},
        {"bspline_unclamped",
         [](Random& r) {
             return make_bspline(2, {0, 0.5, 1, 1.7, 3, 4, 4.5}, random_points(r, 4));
         }},
        {"nurbs", nurbs},
        {"hermite",
         [](Random& r) {
             return make_hermite(random_points(r, 4), {r.vector(), r.vector(), r.vector(), r.vector()});
         }},
        {"interpolate_natural", [](Random& r) { return make_interpolate(random_points(r, 6), SplineEnds::natural); }},
        {"interpolate_clamped", [](Random& r) { return make_interpolate(random_points(r, 5), SplineEnds::clamped); }},
        {"interpolate_catmull_rom",
         [](Random& r) { return make_interpolate(random_points(r, 5), SplineEnds::catmull_rom); }},
        {"arc_short", [](Random& r) { return arc(r, 47); }},
        {"arc_long", [](Random& r) { return arc(r, 165); }},
        {"formula", [](Random& r) { return make_curve(Helix{r.point()}); }},
        {"isocurve", [](Random& r) { return make_isocurve(bezier_patch(r).patch, Along::v, 0.3); }},
        {"isocurve_of_spline", isocurve_of_spline},
        {"isocurve_with_a_corner", [](Random& r) { return make_isocurve(nurbs_patch(r).patch, Along::u, 3.5); }},
        {"reversed", [](Random& r) { return reversed(nurbs(r)); }},
        {"reversed_formula", [](Random& r) { return reversed(make_curve(Helix{r.point()})); }},
        {"reversed_isocurve", [](Random& r) { return reversed(isocurve_of_spline(r)); }},
        {"segment", [](Random& r) { return segment(nurbs(r), 0.3, 1.6); }},
        {"segment_same_parameter", [](Random& r) { return segment(nurbs(r), 0.3, 1.6, false); }},
        {"segment_formula", [](Random& r) { return segment(make_curve(Helix{r.point()}), -0.5, 1.25); }},
        {"segment_isocurve", [](Random& r) { return segment(isocurve_of_spline(r), 0.1, 0.9); }},
        {"transformed",
         [](Random& r) {
             Random h = r.here();
             const Curve c = nurbs(h);
             return transformed(c, random_map(r));
         }},
        {"transformed_formula",
         [](Random& r) {
             Random h = r.here();
             const Curve c = make_curve(Helix{h.point()});
             return transformed(c, random_map(r));
         }},
        {"reparametrized", [](Random& r) { return reparametrized(nurbs(r), -1, 4); }},
        {"reparametrized_formula", [](Random& r) { return reparametrized(make_curve(Helix{r.point()}), 0, 1); }},
        {"combination",
         [](Random& r) {
             const Curve a = make_interpolate(random_points(r, 4), SplineEnds::natural),
                         b = make_bezier(random_points(r, 5)),
                         c = make_hermite(random_points(r, 3), {r.vector(), r.vector(), r.vector()});
             return linear_combination({-0.5, 2, -0.5}, {a, reparametrized(b, 0, 3), reparametrized(c, 0, 3)});
         }},
        {"combination_rational",
         [](Random& r) {
             const Curve a = nurbs(r), b = make_bezier(random_points(r, 5));
             return linear_combination({0.25, 0.75}, {a, reparametrized(b, 0, 2)});
         }},
    };
    return list;
}

const std::vector<PatchType>& patch_types() {
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
        {"hermite_P1", [](Random& r) { return PatchSample{make_coons_hermite(twisted_data(r), Twist::average, Part::P1), {}}; }},
        {"coons_P2",
         [](Random& r) {
             const Frame e = random_frame(r);
             return PatchSample{make_coons({e.c0, e.c1, e.d0, e.d1}, {}, Part::P2), {e.c0}};
         }},
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
        {"generalized_coons", generalized},
        {"generalized_coons_hats", generalized_hats},
        {"tensor_hermite", tensor_hermite},
        {"control_net", control_net},
        {"translational", [](Random& r) { return translational(r, random_cubic); }},
        {"translational_of_splines", [](Random& r) { return translational(r, cubic_spline); }},
        {"translational_blend", translational_blend},
        {"ruled", [](Random& r) { return ruled(r, random_cubic); }},
        {"ruled_of_rationals", [](Random& r) { return ruled(r, rational_cubic); }},
        {"cone", [](Random& r) { return cone_over(r, random_cubic(r, r.point(), r.point({2, 0, 0}))); }},
        {"cone_of_nurbs", [](Random& r) { return cone_over(r, nurbs(r)); }},
        {"bezier_triangle", [](Random& r) { return bezier_triangle(r, 4, false); }},
        {"bezier_triangle_rational", [](Random& r) { return bezier_triangle(r, 3, true); }},
        {"side_vertex_t", [](Random& r) { return side_vertex<kDelta>(r, kT); }, true, false},
        {"side_vertex_t2", [](Random& r) { return side_vertex<kDelta>(r, kT2); }},
        {"side_vertex_quartic", [](Random& r) { return side_vertex<kDelta>(r, kQuartic); }},
        {"side_vertex_smooth", [](Random& r) { return side_vertex<kDelta>(r, kSmooth); }},
        {"side_vertex_t3", [](Random& r) { return side_vertex<kDelta>(r, kT3); }},
        {"side_vertex_max_0_t", [](Random& r) { return side_vertex(random_triangle(r), make_function(FromZero{true}), kDelta); }, true, false},
        {"side_vertex_if_t", [](Random& r) { return side_vertex(random_triangle(r), make_function(FromZero{false}), kDelta); }, true, false},
        {"side_vertex_rational",
         [](Random& r) { return side_vertex(random_triangle(r, rational_cubic), Function::polynomial(kT2), kDelta); }},
        {"side_vertex_seed_t", [](Random& r) { return side_vertex<kSeed>(r, kT); }, true, false},
        {"side_vertex_seed_t2", [](Random& r) { return side_vertex<kSeed>(r, kT2); }},
        {"side_vertex_seed_quartic", [](Random& r) { return side_vertex<kSeed>(r, kQuartic); }},
        {"side_vertex_seed_smooth", [](Random& r) { return side_vertex<kSeed>(r, kSmooth); }, false},
        {"side_vertex_seed_t3", [](Random& r) { return side_vertex<kSeed>(r, kT3); }, false},
        {"side_vertex_s1", [](Random& r) { return side_vertex_part(r, kDelta, SideVertexPart::s1, {0, 2}); }},
        {"side_vertex_s2", [](Random& r) { return side_vertex_part(r, kDelta, SideVertexPart::s2, {0, 1}); }},
        {"side_vertex_s3", [](Random& r) { return side_vertex_part(r, kDelta, SideVertexPart::s3, {1, 2}); }},
        {"side_vertex_s4", [](Random& r) { return side_vertex_part(r, kDelta, SideVertexPart::s4, {0, 1, 2}); }},
        {"three_curves", [](Random& r) { auto e = random_triangle(r); return PatchSample{make_three_curves(e), {e[0], e[1], e[2]}}; }},
        {"three_curves_rational", [](Random& r) { auto e = random_triangle(r, rational_cubic); return PatchSample{make_three_curves(e), {e[0], e[1], e[2]}}; }},
        {"bbg_P1", bbg<BbgForm::Kind::projector, 1>},
        {"bbg_P2", bbg<BbgForm::Kind::projector, 2>},
        {"bbg_P3", bbg<BbgForm::Kind::projector, 3>},
        {"bbg_convex", bbg<BbgForm::Kind::convex>},
        {"bbg_convex_rational", [](Random& r) { return bbg_over(random_triangle(r, rational_cubic), {BbgForm::Kind::convex}); }},
        {"bbg_boolean", bbg<BbgForm::Kind::boolean>},
        {"bbg_boolean_31", bbg<BbgForm::Kind::boolean, 3, 1>},
        {"bbg_boolean_32_splines", [](Random& r) { return bbg_over(random_triangle(r, cubic_spline), {BbgForm::Kind::boolean, 3, 2}); }},
        {"bbg_symmetric", bbg<BbgForm::Kind::symmetric>},
        {"bbg_symmetric_waves", [](Random& r) { return bbg_over(random_triangle(r, wave), {BbgForm::Kind::symmetric}); }},
        {"bbg_symmetric_heavy", [](Random& r) { return bbg_over(random_triangle(r, heavy), {BbgForm::Kind::symmetric}); }},
        {"bbg_symmetric_bump", [](Random& r) { return bbg_over(random_triangle(r, bump), {BbgForm::Kind::symmetric}); }},
        {"bbg_symmetric_corner", [](Random& r) { return bbg_over(random_triangle(r, corner), {BbgForm::Kind::symmetric}); }},
        {"bbg_c1", [](Random& r) { return with_cross(r, bbg_c1); }},
        {"bbg_c1_P1", [](Random& r) { return with_cross(r, bbg_c1, 1); }},
        {"bbg_c1_P3", [](Random& r) { return with_cross(r, bbg_c1, 3); }},
        {"bbg_c1_rational", [](Random& r) { return with_cross(r, bbg_c1, 0, rational_cubic); }},
        {"nielson_c1", [](Random& r) { return with_cross(r, nielson_c1); }, true, true, false},
        {"nielson_c1_T1", [](Random& r) { return with_cross(r, nielson_c1, 1); }},
        {"nielson_c1_T2", [](Random& r) { return with_cross(r, nielson_c1, 2); }},
        {"nielson_c1_rational", [](Random& r) { return with_cross(r, nielson_c1, 0, rational_cubic); }, true, true, false},
        {"nielson_g1", nielson_g1, true, false},
        {"transformed",
         [](Random& r) {
             Random h = r.here();
             PatchSample s = hermite_over(twisted_data(h), Twist::gregory);
             const Transform map = random_map(r);
             for (auto& c : s.boundary) c = transformed(c, map);
             return PatchSample{transformed(s.patch, map), s.boundary};
         }},
        {"transformed_triangle",
         [](Random& r) {
             Random h = r.here();
             PatchSample s = side_vertex<kDelta>(h, kT2);
             const Transform map = random_map(r);
             for (auto& c : s.boundary) c = transformed(c, map);
             return PatchSample{transformed(s.patch, map), s.boundary};
         }},
    };
    return list;
}

Vec2 random_parameter(Random& random, const Patch& patch, double margin) {
    if (patch.domain() == Domain::triangle) {
        double a = random.number(), b = random.number();
        if (a + b > 1) a = 1 - a, b = 1 - b;
        return {margin + (1 - 3 * margin) * a, margin + (1 - 3 * margin) * b};
    }
    const Rect r = patch.rect();
    return {r.u0 + (r.u1 - r.u0) * random.number(margin, 1 - margin),
            r.v0 + (r.v1 - r.v0) * random.number(margin, 1 - margin)};
}

double size_of_sample(const Patch& patch, const Point& origin) {
    Random random(1);
    double size = 0;
    for (int k = 0; k < 20; ++k) {
        const Vec2 p = random_parameter(random, patch);
        size = std::max(size, distance(patch.point(p.x, p.y), origin));
    }
    return size;
}
double size_of_sample(const Curve& curve, const Point& origin) {
    double size = 0;
    for (int k = 0; k <= 20; ++k)
        size = std::max(size, distance(curve(curve.begin() + (curve.end() - curve.begin()) * k / 20), origin));
    return size;
}

Curve random_cubic(Random& r, const Point& from, const Point& to) {
    return make_bezier({from, 0.7 * from + 0.3 * to + r.vector(0.5), 0.3 * from + 0.7 * to + r.vector(0.5), to});
}
Frame random_frame(Random& r, Curve (*between)(Random&, const Point&, const Point&)) {
    const Point p00 = r.point({0, 0, 0}, 0.3), p10 = r.point({2, 0, 0}, 0.3), p01 = r.point({0, 2, 0}, 0.3),
                p11 = r.point({2, 2, 0}, 0.3);
    const Curve c0 = between(r, p00, p10), c1 = between(r, p01, p11), d0 = between(r, p00, p01),
                d1 = between(r, p10, p11);
    return {c0, c1, d0, d1};
}
std::array<Curve, 3> random_triangle(Random& r, Curve (*between)(Random&, const Point&, const Point&)) {
    const Point a = r.point({2, 0, 0}, 0.3), b = r.point({0, 2, 0}, 0.3), c = r.point({0, 0, 0}, 0.3);
    const Curve e1 = between(r, b, c), e2 = between(r, c, a), e3 = between(r, a, b);
    return {e1, e2, e3};
}
std::array<Curve, 3> random_cross(Random& r, const std::array<Curve, 3>& e, double spread) {
    std::vector<Curve> d;
    for (int k = 0; k < 3; ++k) {
        const Curve &own = e[k], &before = e[(k + 2) % 3], &after = e[(k + 1) % 3];
        const Point first = -before.derivative(1) - 0.5 * own.derivative(0), last = after.derivative(0) + 0.5 * own.derivative(1);
        d.push_back(make_bezier({first, 0.5 * (first + last) + r.vector(spread), last}));
    }
    return {d[0], d[1], d[2]};
}
std::array<Curve, 3> normals_of(const std::array<Curve, 3>& e, const std::array<Curve, 3>& d) {
    std::vector<Curve> list;
    for (int k = 0; k < 3; ++k) {
        Point x[4], y[4], n[5]{};
        e[k].taylor(0.0, 3, x);
        d[k].taylor(0.0, 3, y);
        for (int i = 0; i <= 2; ++i)
            for (int j = 0; j <= 2; ++j) n[i + j] += (i + 1.0) * cross(x[i + 1], y[j]);
        std::vector<Point> b(5);  // powers to Bezier
        for (int i = 0; i <= 4; ++i)
            for (int j = 0; j <= i; ++j) b[i] += (binomial(i, j) / binomial(4, j)) * n[j];
        list.push_back(make_bezier(b));
    }
    return {list[0], list[1], list[2]};
}
std::vector<std::vector<Point>> random_net(Random& r, int rows, int columns) {
    std::vector<std::vector<Point>> p(rows);
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) p[i].push_back(r.point({double(i), double(j), 0}, 0.4));
    return p;
}

}  // namespace isoparm::tests
