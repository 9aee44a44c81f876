// errata_network_test.cpp -- docs/errata.md, Gordon surfaces and patches over a network, lecture 6: printed formulas that fail
// beside the corrected ones. Numbers of equations are those of the lecture.
#include "errata.h"

#include <optional>

#include "curves/hermite.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "error.h"
#include "patches/tensor_hermite.h"

namespace isoparm::tests {
namespace {

// ---- Gordon surfaces -----------------------------------------------------------------------------------
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
        for (int k = 0; k <= 2; ++k) {
            x += alpha(k, v) * (source.point(u / 2, k / 2.0) + shift);
            x += alpha(k, u) * (source.point(k / 2.0, v / 2) + shift);
        }
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

// ---- patches over a network ----------------------------------------------------------------------------
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

}  // namespace
}  // namespace isoparm::tests
