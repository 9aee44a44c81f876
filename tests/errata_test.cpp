// errata_test.cpp -- docs/errata.md, surfaces on a rectangle: the sphere, composite and generalised surfaces, the slides. Each
// test evaluates a formula of the sources as it is printed, shows which promise it breaks and by how much, and that the
// corrected formula, isoparm's own surface, keeps the promise.
#include "errata.h"

#include "curves/bezier.h"
#include "curves/line.h"
#include "error.h"
#include "patches/coons_hermite.h"
#include "patches/generalized_coons.h"

namespace isoparm::tests {
namespace {

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
