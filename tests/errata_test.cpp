// errata_test.cpp -- docs/errata.md, surfaces on a rectangle. Each test evaluates a formula of the sources as it is printed,
// shows which promise it breaks and by how much, and that the corrected formula, isoparm's own surface, keeps the promise.
// Numbers of equations: (6.x) of the lecture; others say where they are from.
#include <gtest/gtest.h>

#include <functional>

#include "curves/bezier.h"
#include "curves/hermite.h"
#include "curves/isocurve.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "error.h"
#include "patches/coons_hermite.h"
#include "patches/generalized_coons.h"
#include "patches/gordon.h"
#include "patches/network.h"
#include "patches/tensor_bezier.h"
#include "patches/tensor_hermite.h"
#include "patches/transformed.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

constexpr double kRounding = 1e-13;
const std::vector<double> kParameters{0, 0.2, 0.5, 0.7, 1};
const Point kShift{100, 0, 0};

using Weights = std::array<double, 4>;
/// Cubic Hermite polynomials: value, derivative at 0, derivative, value at 1.
Weights hermite(double t) { return {2 * t * t * t - 3 * t * t + 1, t * t * t - 2 * t * t + t, t * t * t - t * t, 3 * t * t - 2 * t * t * t}; }
double lagrange(int k, int last, double t) {
    double product = 1;
    for (int s = 0; s <= last; ++s)
        if (s != k) product *= (t - s) / (k - s);
    return product;
}
/// Largest length of f over the parameters.
double largest(const std::function<Point(double)>& f) {
    double worst = 0;
    for (double t : kParameters) worst = std::max(worst, length(f(t)));
    return worst;
}
Point second(const Patch& p, int i, int j, double u, double v) {
    const PointJet x = p.jet(u, v);
    return double(i == 2 || j == 2 ? 2 : 1) * Point{x.x.coefficient(i, j), x.y.coefficient(i, j), x.z.coefficient(i, j)};
}

/// Lines u = 0..m, v = 0..n of a random Bezier patch run over [0,m] x [0,n], with the cross derivatives of the patch.
struct Lines {
    static constexpr int m = 3, n = 2;
    Network curves;
    CrossDerivatives cross;
    Grid<Point> twist;

    explicit Lines(int seed) {
        Random r(seed);
        const auto p = random_net(r, 5, 4);
        Grid<Point> pu, pv;
        for (int i = 0; i < 4; ++i) {
            pu.emplace_back();
            for (int j = 0; j < 4; ++j) pu[i].push_back(4.0 / m * (p[i + 1][j] - p[i][j]));
        }
        for (int i = 0; i < 5; ++i) {
            pv.emplace_back();
            for (int j = 0; j < 3; ++j) pv[i].push_back(3.0 / n * (p[i][j + 1] - p[i][j]));
        }
        const Patch x = make_bezier_patch(p), x_u = make_bezier_patch(pu), x_v = make_bezier_patch(pv);
        const auto lines = [](const Patch& patch, Along along, int count, double end) {
            std::vector<Curve> list;
            for (int k = 0; k <= count; ++k) list.push_back(reparametrized(make_isocurve(patch, along, double(k) / count), 0, end));
            return list;
        };
        curves = {lines(x, Along::v, m, n), lines(x, Along::u, n, m)};
        cross = {lines(x_u, Along::v, m, n), lines(x_v, Along::u, n, m)};
        for (int i = 0; i <= m; ++i) {
            twist.emplace_back();
            for (int j = 0; j <= n; ++j) twist[i].push_back(cross.A[i].derivative(j));
        }
    }
    GordonNetwork gordon() const { return {curves.b, {0, 1, 2}, curves.a, {0, 1, 2, 3}}; }
};

// ---- Grigoriev 2007: the sphere -------------------------------------------------------------------------------------
Grid<Point> octant() {
    return {{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
}
TEST(Errata, SpherePoleHasNoNormalByTheCrossProduct) {
    const double s = std::sqrt(0.5);
    const Patch patch = make_bezier_patch(octant(), {{1, s, 1}, {s, 0.5, s}, {1, s, 1}});
    for (double v : kParameters) {
        const SurfacePoint pole = evaluate(patch, 0, v);
        EXPECT_LE(length(cross(*pole.du, *pole.dv)), kRounding) << "degenerate for every v";
        ASSERT_TRUE(pole.normal) << "but the limit exists";
        EXPECT_LE(distance(*pole.normal, {0, 0, 1}), kRounding);
        for (double u : kParameters) EXPECT_NEAR(length(patch.point(u, v)), 1, kRounding) << "printed weights are right";
    }
}
TEST(Errata, SphereReflectionsTurnTheNormalsInside) {
    const double s = std::sqrt(0.5);
    const Grid<double> w{{1, s, 1}, {s, 0.5, s}, {1, s, 1}};
    const auto outward = [](const Patch& p) {
        const SurfacePoint x = evaluate(p, 0.4, 0.7);
        return dot(*x.normal, x.position);
    };
    EXPECT_NEAR(outward(make_bezier_patch(octant(), w)), 1, kRounding);
    auto mirrored = octant(), swapped = mirrored;
    for (auto& row : mirrored)
        for (auto& p : row) p.z = -p.z;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) swapped[j][i] = mirrored[i][j];
    EXPECT_NEAR(outward(make_bezier_patch(mirrored, w)), -1, kRounding) << "an odd number of reflections, as printed";
    EXPECT_NEAR(outward(make_bezier_patch(swapped, w)), 1, kRounding) << "with the parameters exchanged";
}

// ---- Chashnikov 2008: composite and generalised Coons surfaces ------------------------------------------------------
/// (4): four functions a side, corner data M_ij = L_i(g_j).
using Side = std::array<std::function<Point(double)>, 4>;
Point coons4(const Side& f, const Side& g, const Grid<Point>& M, const Weights& hu, const Weights& hv, double u, double v) {
    Point x;
    for (int i = 0; i < 4; ++i) x += hu[i] * f[i](v) + hv[i] * g[i](u);
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) x = x - hu[i] * hv[j] * M[i][j];
    return x;
}
/// The cell (i,j) of lines by (12).
struct Cell12 {
    Side f, g;
    Grid<Point> M;
    Cell12(const Lines& l, int i, int j) {
        const auto& [a, b] = l.curves;
        const auto& [A, B] = l.cross;
        const Curve *fs[] = {&a[i], &A[i], &A[i + 1], &a[i + 1]}, *gs[] = {&b[j], &B[j], &B[j + 1], &b[j + 1]};
        for (int k = 0; k < 4; ++k) {
            f[k] = [c = *fs[k], j](double v) { return c(j + v); };
            g[k] = [c = *gs[k], i](double u) { return c(i + u); };
            M.push_back({(*fs[k])(j), fs[k]->derivative(j), fs[k]->derivative(j + 1), (*fs[k])(j + 1)});
        }
    }
    Point operator()(double u, double v) const { return coons4(f, g, M, hermite(u), hermite(v), u, v); }
};

TEST(Errata, BlendsOfCompositeSurfaceMustSumToOne) {
    // H1 + t^2 (1-t)^2 satisfies every condition of (2). A shift by s then moves the surface by s (1 - (1/16)^2) in the middle.
    const auto with_bump = [](double t) {
        Weights h = hermite(t);
        h[0] += t * t * (1 - t) * (1 - t);
        return h;
    };
    const Lines lines(1);
    Cell12 here(lines, 0, 0), there = here;
    for (int k : {0, 3}) {
        there.f[k] = [f = here.f[k]](double t) { return f(t) + kShift; };
        there.g[k] = [g = here.g[k]](double t) { return g(t) + kShift; };
        for (int l : {0, 3}) there.M[k][l] += kShift;
    }
    const auto printed = [&](const Cell12& c, double u, double v) { return coons4(c.f, c.g, c.M, with_bump(u), with_bump(v), u, v); };
    EXPECT_LE(largest([&](double t) { return printed(here, 0, t) - here.f[0](t); }), kRounding) << "it interpolates";
    EXPECT_NEAR(distance(printed(there, 0.5, 0.5), printed(here, 0.5, 0.5) + kShift), 100 / 256.0, 1e-10);
    EXPECT_LE(distance(there(0.5, 0.5), here(0.5, 0.5) + kShift), 1e-12);

    // isoparm refuses such blends: with two functionals a side, in both directions.
    GeneralizedCoons data;
    data.u = data.v = {{Functional::Kind::value, 0}, {Functional::Kind::value, 1}};
    data.f = {make_line({0, 0, 0}, {0, 1, 0}), make_line({1, 0, 0}, {1, 1, 0})};
    data.g = {make_line({0, 0, 0}, {1, 0, 0}), make_line({0, 1, 0}, {1, 1, 0})};
    data.blend_u = data.blend_v = {Function::polynomial({1, -1, 1, -2, 1}), Function::polynomial({0, 1})};
    EXPECT_THROW(make_generalized_coons(data), Error);
    data.blend_u[0] = Function::polynomial({1, -1});  // one direction is enough
    EXPECT_NO_THROW(make_generalized_coons(data));
}

TEST(Errata, IndicesOfTheGeneralisedSurfaceOfANetworkRunFromZero) {
    // Section 5 numbers from 0 to 2m+1, but (5), (6), (9) sum over 1..m: the first curve, and most others, are left out.
    const Lines l(2);
    const int m = Lines::m, n = Lines::n;
    const auto hat = [](int k, double t) {  // (17)
        const int node = k / 2;
        const bool slope = k % 2;
        if (t >= node && t <= node + 1) return hermite(t - node)[slope ? 1 : 0];
        return t >= node - 1 && t <= node ? hermite(t - node + 1)[slope ? 2 : 3] : 0.0;
    };
    const auto& [a, b] = l.curves;
    const auto& [A, B] = l.cross;
    const auto sum = [&](int first, int last_u, int last_v, double u, double v) {
        Point x;
        const auto f = [&](int k) -> const Curve& { return k % 2 ? A[k / 2] : a[k / 2]; };
        const auto g = [&](int k) -> const Curve& { return k % 2 ? B[k / 2] : b[k / 2]; };
        for (int i = first; i <= last_u; ++i) x += hat(i, u) * f(i)(v);
        for (int j = first; j <= last_v; ++j) x += hat(j, v) * g(j)(u);
        for (int i = first; i <= last_u; ++i)
            for (int j = first; j <= last_v; ++j)
                x = x - hat(i, u) * hat(j, v) * (j % 2 ? f(i).derivative(j / 2) : f(i)(j / 2));
        return x;
    };
    EXPECT_GE(largest([&](double t) { return sum(1, m, n, 0, n * t) - a[0](n * t); }), 0.3);
    const Patch patch = make_network(l.curves, l.cross, Twist::compatible);
    EXPECT_LE(largest([&](double t) { return patch.point(0, n * t) - a[0](n * t); }), kRounding);
    for (double s : kParameters)
        EXPECT_LE(largest([&](double t) { return sum(0, 2 * m + 1, 2 * n + 1, m * s, n * t) - patch.point(m * s, n * t); }), kRounding);
}

TEST(Errata, CrossDerivativesOfACompositeSurfaceMustBeC1) {
    // (11) asks for values and slopes at the nodes only. 16 v^2 (1-v)^2 |v - 1/2| keeps them, and bends A_0 by 2 at v = 1/2:
    // s_v jumps there by 2 H2(u), against s in C1 of (14).
    const Lines l(3);
    Cell12 cell(l, 0, 0);
    cell.f[1] = [A = cell.f[1]](double v) { return A(v) + Point{16 * v * v * (1 - v) * (1 - v) * std::abs(v - 0.5), 0, 0}; };
    const auto jump = [](const std::function<Point(double)>& x) {
        const double h = 1e-5;
        return length((x(0.5 + h) - 2.0 * x(0.5) + x(0.5 - h)) / h);
    };
    const double u = 1 / 3.0;  // where H2 is largest: 4/27
    EXPECT_NEAR(jump([&](double v) { return cell(u, v); }), 8 / 27.0, 1e-3);
    const Patch patch = make_network(l.curves, l.cross, Twist::compatible);
    EXPECT_LE(jump([&](double v) { return patch.point(u, v); }), 1e-3);
}

// ---- the lecture: Gordon surfaces -----------------------------------------------------------------------------------
TEST(Errata, GordonCurvesOfTheSecondFamilyHaveARunningIndex) {
    // (6.22) prints r(I,v) in the sum over i: whatever the constant I is, another curve is not interpolated.
    const Lines l(4);
    const auto& [a, b] = l.curves;
    const int m = Lines::m, n = Lines::n;
    for (int I = 0; I <= m; ++I) {
        const auto printed = [&](double u, double v) {
            Point x;
            for (int j = 0; j <= n; ++j) x += lagrange(j, n, v) * b[j](u);
            for (int i = 0; i <= m; ++i) {
                x += lagrange(i, m, u) * a[I](v);
                for (int j = 0; j <= n; ++j) x = x - lagrange(i, m, u) * lagrange(j, n, v) * a[i](j);
            }
            return x;
        };
        double worst = 0;
        for (int i = 0; i <= m; ++i) worst = std::max(worst, largest([&](double t) { return printed(i, n * t) - a[i](n * t); }));
        EXPECT_GE(worst, 0.3) << "I = " << I;
    }
    const Patch patch = make_gordon(l.gordon());
    for (int i = 0; i <= m; ++i)
        EXPECT_LE(largest([&](double t) { return patch.point(i, n * t) - a[i](n * t); }), kRounding) << i;
}

TEST(Errata, LagrangeCoefficientsLeaveOutTheirOwnNode) {
    // (6.23) leaves out r = 0 above and below, and s = 0 below, whatever i and j: a factor 0 in the denominator for i, j >= 1.
    const auto printed_u = [](int i, int m, double u) {
        double above = 1, below = 1;
        for (int r = 1; r <= m; ++r) above *= u - r, below *= i - r;
        return above / below;
    };
    const auto printed_v = [](int j, int n, double v) {
        double above = 1, below = 1;
        for (int s = 0; s <= n; ++s) {
            if (s != j) above *= v - s;
            if (s != 0) below *= j - s;
        }
        return above / below;
    };
    for (int k = 1; k <= 3; ++k) {
        EXPECT_TRUE(std::isnan(printed_u(k, 3, k))) << "0/0 at its own node, where it should be 1";
        EXPECT_FALSE(std::isfinite(printed_u(k, 3, 0.5)));
        EXPECT_FALSE(std::isfinite(printed_v(k, 3, 0.5)));
    }
    GordonNetwork plane{{}, {0, 1, 2}, {}, {0, 1, 2, 3}};  // is reproduced by the right ones
    for (double v : plane.v_nodes) plane.u_curves.push_back(reparametrized(make_line({0, v, 0}, {3, v, 0}), 0, 3));
    for (double u : plane.u_nodes) plane.v_curves.push_back(reparametrized(make_line({u, 0, 0}, {u, 2, 0}), 0, 2));
    const Patch patch = make_gordon(plane);
    for (double u : {0.0, 0.5, 1.0, 2.3, 3.0}) EXPECT_LE(distance(patch.point(u, 1.7), {u, 1.7, 0}), kRounding);
}

TEST(Errata, GordonCurvesMustMeetAtTheirParameters) {
    // After (6.21): every pair has one common point, but the curve a[1] reaches it at another parameter.
    Lines l(6);
    const Curve right = l.curves.a[1];
    const auto slower = [&](double v) { return right(v + v * (2 - v) / 4); };
    const auto printed = [&](double u, double v) {  // (6.22), r(i,j) the common points
        Point x;
        for (int j = 0; j <= 2; ++j) x += lagrange(j, 2, v) * l.curves.b[j](u);
        for (int i = 0; i <= 3; ++i) {
            x += lagrange(i, 3, u) * (i == 1 ? slower(v) : l.curves.a[i](v));
            for (int j = 0; j <= 2; ++j) x = x - lagrange(i, 3, u) * lagrange(j, 2, v) * l.curves.a[i](j);
        }
        return x;
    };
    EXPECT_GE(largest([&](double t) { return printed(3 * t, 1) - l.curves.b[1](3 * t); }), 0.1) << "a curve it crosses is missed";
    EXPECT_NO_THROW(make_gordon(l.gordon()));
    l.curves.a[1] = reparametrized(segment(right, 0, 1.5), 0, 2);
    EXPECT_THROW(make_gordon(l.gordon()), IncompatibleError);
}

TEST(Errata, BlendsOfGeneralisedGordonMustSumToOne) {
    // alpha_0 = L_0 + w (w-1) (w-2) / 2 is 1 at 0 and 0 at 1 and 2, which is all that is asked.
    const auto bump = [](double w) { return w * (w - 1) * (w - 2) / 2; };
    const auto alpha = [&](int k, double w) { return lagrange(k, 2, w) + (k == 0 ? bump(w) : 0); };
    Random r(7);
    const auto p = random_net(r, 3, 3);
    const Patch source = make_bezier_patch(p);
    const auto surface = [&](const Point& shift, double u, double v) {
        Point x;
        for (int k = 0; k <= 2; ++k) x += alpha(k, v) * (source.point(u / 2, k / 2.0) + shift) + alpha(k, u) * (source.point(k / 2.0, v / 2) + shift);
        for (int i = 0; i <= 2; ++i)
            for (int j = 0; j <= 2; ++j) x = x - alpha(i, u) * alpha(j, v) * (source.point(i / 2.0, j / 2.0) + shift);
        return x;
    };
    EXPECT_LE(distance(surface({}, 1, 0.5), source.point(0.5, 0.25)), kRounding) << "it interpolates";
    EXPECT_NEAR(distance(surface(kShift, 0.5, 0.5), surface({}, 0.5, 0.5) + kShift), 100 * bump(0.5) * bump(0.5), 1e-10);  // 3.5

    GordonNetwork net{{}, {0, 0.5, 1}, {}, {0, 0.5, 1}}, moved = net;
    for (double t : net.u_nodes) {
        net.u_curves.push_back(make_isocurve(source, Along::u, t)), net.v_curves.push_back(make_isocurve(source, Along::v, t));
        for (auto [from, to] : {std::pair{&net.u_curves, &moved.u_curves}, {&net.v_curves, &moved.v_curves}})
            to->push_back(transformed(from->back(), Transform::translate(kShift)));
    }
    for (auto blend : {GordonBlend::lagrange, GordonBlend::hermite})
        EXPECT_LE(distance(make_gordon(moved, blend).point(0.25, 0.25), make_gordon(net, blend).point(0.25, 0.25) + kShift), 1e-12);
}

TEST(Errata, GordonIsAsSmoothAsItsCurves) {
    // "C-infinity" by Lagrange's coefficients: not through curves that are C1 only.
    const std::vector<Point> slopes{{1, 0, 1}, {1, 0, -2}, {1, 0, 1}};
    GordonNetwork net{{}, {0, 1}, {}, {0, 1, 2}};
    for (double v : net.v_nodes) net.u_curves.push_back(make_hermite({{0, v, 0}, {1, v, 0}, {2, v, 0}}, slopes));
    for (double u : net.u_nodes) net.v_curves.push_back(make_line({u, 0, 0}, {u, 1, 0}));
    const Patch patch = make_gordon(net);
    ASSERT_EQ(patch.breaks_u(), std::vector<double>{1});
    const double before = std::nextafter(1.0, 0.0);
    EXPECT_NEAR(length(second(patch, 2, 0, before, 0.5) - second(patch, 2, 0, 1, 0.5)), 12, 1e-10);  // the jump of the curves
    // z of a segment: slopes 1 and -2, ends at height 0; z'' at its end is 2 * 1 + 4 * (-2) = -6, and 6 on the other side
    EXPECT_NEAR(second(patch, 2, 0, before, 0.5).z, -6, 1e-10);
}

// ---- the lecture: patches over a network ----------------------------------------------------------------------------
/// (6.24) over the network, with the indices in doubt as arguments.
struct Patches624 {
    const Network& net;
    bool tangents = false;  // r_u(i,j), r_v(i,j) of the corner matrix by the curves and not by (6.25)

    using Eval = std::function<Point(const Curve&)>;
    /// (6.25) along a family of curves.
    static Point difference(const std::vector<Curve>& c, int k, const Eval& at) {
        const int last = int(c.size()) - 1;
        if (k == 0) return 2.0 * at(c[1]) - 2.0 * at(c[0]) - difference(c, 1, at);
        if (k == last) return 2.0 * at(c[last]) - 2.0 * at(c[last - 1]) - difference(c, last - 1, at);
        return 0.5 * (at(c[k + 1]) - at(c[k - 1]));
    }
    Point ru(int i, double v) const { return difference(net.a, i, [v](const Curve& c) { return c(v); }); }
    Point rv(double u, int j) const { return difference(net.b, j, [u](const Curve& c) { return c(u); }); }
    Point ruv(int i, int j) const {
        return 0.5 * difference(net.a, i, [j](const Curve& c) { return c.derivative(j); }) +
               0.5 * difference(net.b, j, [i](const Curve& c) { return c.derivative(i); });
    }
    struct Indices {
        int i, j;
        std::optional<int> i_1, I, second;  // of r_u(i_1,v), r_u(I,j), r_u(i+1, second)
    };
    Point operator()(const Indices& k, double t, double w) const {
        const int i = k.i, j = k.j;
        const double u = i + t, v = j + w;
        const auto node_u = [&](int a, int b) { return tangents ? net.b[b].derivative(a) : ru(a, b); };
        const auto node_v = [&](int a, int b) { return tangents ? net.a[a].derivative(b) : rv(a, b); };
        const Weights h = hermite(t), g = hermite(w);
        const double alpha[] = {h[0], h[3], h[1], h[2]}, beta[] = {g[0], g[3], g[1], g[2]};
        const Point rows[] = {net.a[i](v), net.a[i + 1](v), ru(i, v), ru(k.i_1.value_or(i + 1), v)},
                    columns[] = {net.b[j](u), net.b[j + 1](u), rv(u, j), rv(u, j + 1)},
                    M[4][4] = {{net.a[i](j), net.a[i](j + 1), node_v(i, j), node_v(i, j + 1)},
                               {net.a[i + 1](j), net.a[i + 1](j + 1), node_v(i + 1, j), node_v(i + 1, j + 1)},
                               {node_u(k.I.value_or(i), j), node_u(i, j + 1), ruv(i, j), ruv(i, j + 1)},
                               {node_u(i + 1, k.second.value_or(j)), node_u(i + 1, j + 1), ruv(i + 1, j), ruv(i + 1, j + 1)}};
        Point x;
        for (int p = 0; p < 4; ++p) {
            x += alpha[p] * rows[p] + beta[p] * columns[p];
            for (int q = 0; q < 4; ++q) x = x - alpha[p] * beta[q] * M[p][q];
        }
        return x;
    }
    /// How far the curve v = j + side is missed in the cell.
    double gap(const Indices& k, int side) const {
        return largest([&](double t) { return (*this)(k, t, side) - net.b[k.j + side](k.i + t); });
    }
};

TEST(Errata, IndicesOfTheNetworkOfPatches) {
    const Lines l(8);
    const Patches624 formula{l.curves};
    EXPECT_GE(formula.gap({1, 0, 1, {}, {}}, 0), 0.02) << "r_u(i_1,v) read as r_u(1,v) in the cell i = 1, not i+1 = 2";
    EXPECT_GE(formula.gap({1, 0, {}, 0, {}}, 0), 0.02) << "r_u(I,j) read with I = 0 in the cell i = 1";
    EXPECT_GE(formula.gap({0, 1, {}, {}, 0}, 0), 0.02) << "r_u(i+1,i) in the cell (0,1), not r_u(i+1,j)";
    const Patch patch = make_network(l.curves);
    for (int i = 0; i < Lines::m; ++i)
        for (int j = 0; j < Lines::n; ++j) {
            for (int side : {0, 1}) EXPECT_LE(formula.gap({i, j, {}, {}, {}}, side), kRounding);
            for (double t : kParameters)
                EXPECT_LE(largest([&](double w) { return formula({i, j, {}, {}, {}}, t, w) - patch.point(i + t, j + w); }), kRounding);
        }
    // t in [0,1) and i = [u] leave out u = m, where r(m+1,v) would be needed: i = min([u], m-1).
    EXPECT_LE(largest([&](double t) { return patch.point(Lines::m, Lines::n * t) - l.curves.a[Lines::m](Lines::n * t); }), kRounding);
}

TEST(Errata, CornersOfANetworkTakeTheDifferences) {
    const Lines l(9);
    EXPECT_GE((Patches624{l.curves, true}.gap({1, 0, {}, {}, {}}, 0)), 0.02) << "tangents of the curves as r_u(i,j), r_v(i,j)";
    EXPECT_LE((Patches624{l.curves, false}.gap({1, 0, {}, {}, {}}, 0)), kRounding);
}

TEST(Errata, DifferencesAcrossVRunOverJ) {
    // (6.25) prints r_v(u,j) = (r(u,i+1) - r(u,j-1)) / 2. On the plane (u,v,0): (i - j + 2) / 2, 1 only where i = j.
    Network plane;
    for (int i = 0; i <= 2; ++i) plane.a.push_back(reparametrized(make_line({double(i), 0, 0}, {double(i), 2, 0}), 0, 2));
    for (int j = 0; j <= 2; ++j) plane.b.push_back(reparametrized(make_line({0, double(j), 0}, {2, double(j), 0}), 0, 2));
    const auto printed = [&](int i, int j, double u) { return 0.5 * (plane.b[i + 1](u) - plane.b[j - 1](u)); };
    EXPECT_LE(distance(printed(0, 1, 0.3), {0, 0.5, 0}), kRounding) << "half of the right slope";
    const Patch patch = make_network(plane);
    for (double u : {0.3, 1.0, 1.6}) {
        const PointFrame x = patch.frame(u, 1);
        EXPECT_LE(distance({x.x.coefficient(0, 1), x.y.coefficient(0, 1), x.z.coefficient(0, 1)}, {0, 1, 0}), kRounding);
    }
}

TEST(Errata, ThirdDerivativeAtTheBorderVanishesForTheHermitePartOnly) {
    // After (6.25): "the third derivatives of the surface vanish at the border". But the curves b_j are interpolated, third
    // derivatives and all. In a cell the surface is a polynomial in u of degree 4 at most here: x_uuu by differences of x_uu.
    const Lines l(10);
    const auto third = [](const Patch& p) {
        const auto slope = [&](double a, double b) { return (second(p, 2, 0, b, 0) - second(p, 2, 0, a, 0)) / (b - a); };
        return 2.0 * slope(0, 0.25) - slope(0, 0.5);  // x_uuu(0,0): exact up to degree 4
    };
    const Patch whole = make_network(l.curves, Twist::average), hermite_part = make_network(l.curves, Twist::average, Part::P1);
    EXPECT_GE(length(third(whole)), 0.1);
    Point taylor[4];
    l.curves.b[0].taylor(0.0, 3, taylor);
    EXPECT_LE(distance(third(whole), 6.0 * taylor[3]), 1e-10) << "that of the boundary curve";
    EXPECT_LE(length(third(hermite_part)), 1e-10);
}

TEST(Errata, TensorProductSurfaceComesFromNetworkOfPatches) {
    // After (6.26): "substituting into (6.22)", "differentiating (6.22)". Blends of (6.22) that are flat at the nodes give
    // x_uv = 0 there, whatever r_uv is; (6.24) gives r_uv.
    Random r(11);
    Grid<Point> x(3), xu(3), xv(3), xuv(3);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            x[i].push_back(r.point({double(i), double(j), 0}, 0.3));
            xu[i].push_back(r.vector()), xv[i].push_back(r.vector()), xuv[i].push_back(r.vector() + Point{0, 0, 2});
        }
    GordonNetwork net{{}, {0, 1, 2}, {}, {0, 1, 2}};
    for (int k = 0; k < 3; ++k) {
        net.u_curves.push_back(make_hermite({x[0][k], x[1][k], x[2][k]}, {xu[0][k], xu[1][k], xu[2][k]}));
        net.v_curves.push_back(make_hermite(x[k], xv[k]));
    }
    const Patch by_622 = make_gordon(net, GordonBlend::hermite), by_624 = make_tensor_hermite(x, xu, xv, xuv);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            EXPECT_LE(length(second(by_622, 1, 1, i, j)), 1e-12);
            EXPECT_GE(distance(second(by_622, 1, 1, i, j), xuv[i][j]), 1);
            EXPECT_LE(distance(second(by_624, 1, 1, i, j), xuv[i][j]), 1e-12);
        }
    for (double t : kParameters)  // without twists they are the same surface
        EXPECT_LE(distance(by_622.point(2 * t, 1.3), make_tensor_hermite(x, xu, xv).point(2 * t, 1.3)), kRounding);
}

// ---- Pavlovich 2017: slides -----------------------------------------------------------------------------------------
HermiteData incompatible(Random& r) {
    const auto p = random_net(r, 5, 5);
    std::array<std::vector<Point>, 4> f, g;
    for (int k = 0; k < 5; ++k) {
        const Point bend_f = k % 4 ? r.vector() : Point{}, bend_g = k % 4 ? r.vector() : Point{};
        f[0].push_back(p[0][k]), f[3].push_back(p[4][k]), g[0].push_back(p[k][0]), g[3].push_back(p[k][4]);
        f[1].push_back(4.0 * (p[1][k] - p[0][k]) + bend_f), f[2].push_back(4.0 * (p[4][k] - p[3][k]) - bend_f);
        g[1].push_back(4.0 * (p[k][1] - p[k][0]) + bend_g), g[2].push_back(4.0 * (p[k][4] - p[k][3]) - bend_g);
    }
    return {{make_bezier(f[0]), make_bezier(f[1]), make_bezier(f[2]), make_bezier(f[3])},
            {make_bezier(g[0]), make_bezier(g[1]), make_bezier(g[2]), make_bezier(g[3])}};
}

TEST(Errata, CornerTermAloneIsNotTheHermiteSurface) {
    // The slide shows h_cd only: h_c and h_d, the parts with the curves, are missing.
    Random r(12);
    const HermiteData d = incompatible(r);
    const Patch corner_term = make_coons_hermite(d, Twist::average, Part::P1P2), whole = make_coons_hermite(d, Twist::average);
    EXPECT_GE(largest([&](double t) { return corner_term.point(0, t) - d.f[0](t); }), 0.1);
    EXPECT_LE(largest([&](double t) { return whole.point(0, t) - d.f[0](t); }), kRounding);
}

TEST(Errata, GregoryTwistsAreRightAsPrintedAndWrongWhenSwapped) {
    Random r(13);
    const HermiteData d = incompatible(r);
    const auto formula = [&](bool swapped, double u, double v) {
        const auto a = [&](int i, int j) { return d.f[i ? 2 : 1].derivative(j); };  // d/dv x_u
        const auto b = [&](int i, int j) { return d.g[j ? 2 : 1].derivative(i); };  // d/du x_v
        const auto T = [&](double p, double q, int i, int j) {
            return swapped ? (p * b(i, j) + q * a(i, j)) / (p + q) : (p * a(i, j) + q * b(i, j)) / (p + q);
        };
        Side f, g;
        Grid<Point> M;
        for (int k = 0; k < 4; ++k) f[k] = d.f[k], g[k] = d.g[k];
        for (int i = 0; i < 4; ++i) M.push_back({d.f[i](0), d.f[i].derivative(0), d.f[i].derivative(1), d.f[i](1)});
        M[1][1] = T(u, v, 0, 0), M[1][2] = T(-u, v - 1, 0, 1);  // with the signs of the slide
        M[2][1] = T(1 - u, v, 1, 0), M[2][2] = T(u - 1, v - 1, 1, 1);
        for (int i : {0, 3}) M[i][1] = d.g[1](i / 3), M[i][2] = d.g[2](i / 3);
        return coons4(f, g, M, hermite(u), hermite(v), u, v);
    };
    const auto slope_gap = [&](bool swapped) {  // x_u(0,v) against the data
        const double h = 1e-7;
        return largest([&](double t) {
            const double v = 0.05 + 0.9 * t;
            return (formula(swapped, h, v) - formula(swapped, 0, v)) / h - d.f[1](v);
        });
    };
    EXPECT_LE(slope_gap(false), 1e-4);
    EXPECT_GE(slope_gap(true), 0.1);
    const Patch patch = make_coons_hermite(d, Twist::gregory);
    for (double u : {0.1, 0.5, 0.8})
        EXPECT_LE(largest([&](double t) { return formula(false, u, 0.1 + 0.8 * t) - patch.point(u, 0.1 + 0.8 * t); }), kRounding);
}

TEST(Errata, GordonCornerSumRunsOverJ) {
    // The slide prints g_12 as a double sum over i and i, with v_j and L_j inside: for every fixed j it is (m+1) L_j(v) times
    // the curve through the points of the line v = v_j. With m = n, so that the indices exist.
    Random r(14);
    const Patch source = make_bezier_patch(random_net(r, 5, 5));
    const auto g = [&](double u, double v) { return source.point(u / 2, v / 2); };
    for (int j = 0; j <= 2; ++j) {
        const auto printed = [&](double u, double v) {
            Point x;
            for (int i = 0; i <= 2; ++i) {
                x += lagrange(i, 2, u) * g(i, v) + lagrange(i, 2, v) * g(u, i);
                x = x - 3.0 * lagrange(i, 2, u) * lagrange(j, 2, v) * g(i, j);
            }
            return x;
        };
        EXPECT_GE(largest([&](double t) { return printed(2 * t, 1) - g(2 * t, 1); }), 0.3) << j;
    }
    GordonNetwork net{{}, {0, 0.5, 1}, {}, {0, 0.5, 1}};
    for (double t : net.u_nodes)
        net.u_curves.push_back(make_isocurve(source, Along::u, t)), net.v_curves.push_back(make_isocurve(source, Along::v, t));
    const Patch patch = make_gordon(net);
    EXPECT_LE(largest([&](double t) { return patch.point(t, 0.5) - g(2 * t, 1); }), kRounding);
}

}  // namespace
}  // namespace isoparm::tests
