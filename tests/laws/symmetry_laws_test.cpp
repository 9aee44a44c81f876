// symmetry_laws_test.cpp -- data run the other way round, or with its parameters exchanged, make the same surface.
#include <gtest/gtest.h>

#include "curves/bezier.h"
#include "curves/interpolate.h"
#include "curves/modify.h"
#include "patches/bezier_triangle.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/network.h"
#include "patches/side_vertex.h"
#include "patches/tensor_bezier.h"
#include "samples.h"

namespace isoparm::tests {
namespace {

/// x = a(s,t) and y = b(q) with q = map(s,t): the same positions and the same bounds of them.
void expect_same(const Patch& a, const Patch& b, Vec2 (*map)(const Rect&, Vec2)) {
    Random r(5);
    const double size = size_of_sample(a);
    for (int n = 0; n < 60; ++n) {
        Vec2 p = random_parameter(r, a);
        if (n % 3 == 0) p = a.edge_point(n % a.edges(), n % 2 ? r.number() : n % 4 / 2);
        const Vec2 q = map(a.rect(), p);
        EXPECT_LE(distance(a.point(p.x, p.y), b.point(q.x, q.y)), 1e-13 * size) << p.x << ", " << p.y;
        const auto e = evaluate(a, p.x, p.y), f = evaluate(b, q.x, q.y);
        ASSERT_EQ(bool(e.gaussian), bool(f.gaussian)) << p.x << ", " << p.y;
        EXPECT_NEAR(e.gaussian.value_or(0), f.gaussian.value_or(0), 1e-8 * (1 + std::abs(e.gaussian.value_or(0))));
    }
}
Vec2 flip_u(const Rect& r, Vec2 p) { return {r.u0 + r.u1 - p.x, p.y}; }
Vec2 flip_v(const Rect& r, Vec2 p) { return {p.x, r.v0 + r.v1 - p.y}; }
Vec2 exchange(const Rect&, Vec2 p) { return {p.y, p.x}; }
/// The triangle named B, C, A: its first two coordinates are the old v and w.
Vec2 turn(const Rect&, Vec2 p) { return {p.y, std::max(0.0, p.y > p.x ? (1 - p.y) - p.x : (1 - p.x) - p.y)}; }

template <class T> std::vector<T> backwards(std::vector<T> v) {
    std::reverse(v.begin(), v.end());
    return v;
}
template <class T> Grid<T> transposed(const Grid<T>& g) {
    Grid<T> t(g[0].size());
    for (const auto& row : g)
        for (std::size_t j = 0; j < row.size(); ++j) t[j].push_back(row[j]);
    return t;
}
std::vector<double> mirrored(std::vector<double> knots) {
    const double sum = knots.front() + knots.back();
    for (auto& k : knots) k = sum - k;
    return backwards(knots);
}

TEST(Symmetry, TensorBezierAndSpline) {
    Random r(1);
    const auto net = random_net(r, 5, 4);
    Grid<double> w(5, std::vector<double>(4));
    for (auto& row : w)
        for (auto& x : row) x = r.number(0.5, 2);
    for (const auto& weights : {Grid<double>{}, w}) {
        const auto flipped = weights.empty() ? weights : backwards(weights),
                   swapped = weights.empty() ? weights : transposed(weights);
        const Patch bezier = make_bezier_patch(net, weights);
        expect_same(bezier, make_bezier_patch(backwards(net), flipped), flip_u);
        expect_same(bezier, make_bezier_patch(transposed(net), swapped), exchange);
        const std::vector<double> ku{0, 0, 0, 0.25, 1, 1.5, 1.5, 1.5}, kv{0, 0.5, 0.75, 1, 2, 3, 3.5};
        const Patch spline = make_bspline_patch(2, 2, ku, kv, net, weights);
        expect_same(spline, make_bspline_patch(2, 2, mirrored(ku), kv, backwards(net), flipped), flip_u);
        expect_same(spline, make_bspline_patch(2, 2, kv, ku, transposed(net), swapped), exchange);
    }
}

TEST(Symmetry, Coons) {
    for (int seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const Frame e = random_frame(r);
        for (const auto& blend : {std::optional<Function>{}, std::optional<Function>{cubic_blend()}}) {
            const Patch patch = make_coons({e.c0, e.c1, e.d0, e.d1}, blend);
            expect_same(patch, make_coons({reversed(e.c0), reversed(e.c1), e.d1, e.d0}, blend), flip_u);
            expect_same(patch, make_coons({e.c1, e.c0, reversed(e.d0), reversed(e.d1)}, blend), flip_v);
            expect_same(patch, make_coons({e.d0, e.d1, e.c0, e.c1}, blend), exchange);
        }
    }
}

HermiteData twisted(Random& r) {
    const auto p = random_net(r, 5, 4);
    std::array<std::vector<Point>, 4> f, g;
    for (int j = 0; j < 4; ++j) {
        const Point bend = j % 3 ? r.vector() : Point{};
        f[0].push_back(p[0][j]), f[1].push_back(4.0 * (p[1][j] - p[0][j]) + bend),
            f[2].push_back(4.0 * (p[4][j] - p[3][j]) - bend), f[3].push_back(p[4][j]);
    }
    for (int i = 0; i < 5; ++i)
        g[0].push_back(p[i][0]), g[1].push_back(3.0 * (p[i][1] - p[i][0])), g[2].push_back(3.0 * (p[i][3] - p[i][2])),
            g[3].push_back(p[i][3]);
    return {{make_bezier(f[0]), make_bezier(f[1]), make_bezier(f[2]), make_bezier(f[3])},
            {make_bezier(g[0]), make_bezier(g[1]), make_bezier(g[2]), make_bezier(g[3])}};
}
Curve negative(const Curve& c) { return linear_combination({-1}, {c}); }

TEST(Symmetry, CoonsHermiteWithEveryTwist) {
    for (int seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const HermiteData d = twisted(r);
        const auto& [f, g] = d;
        for (auto twist : {Twist::gregory, Twist::average, Twist::zero}) {
            const Patch patch = make_coons_hermite(d, twist);
            expect_same(patch,
                        make_coons_hermite({{f[3], negative(f[2]), negative(f[1]), f[0]},
                                            {reversed(g[0]), reversed(g[1]), reversed(g[2]), reversed(g[3])}},
                                           twist),
                        flip_u);
            expect_same(patch,
                        make_coons_hermite({{reversed(f[0]), reversed(f[1]), reversed(f[2]), reversed(f[3])},
                                            {g[3], negative(g[2]), negative(g[1]), g[0]}},
                                           twist),
                        flip_v);
            expect_same(patch, make_coons_hermite({g, f}, twist), exchange);
        }
    }
}

TEST(Symmetry, NetworkOfCurves) {
    for (int seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        Network net;
        std::vector<std::vector<Point>> p(4);
        for (int i = 0; i <= 3; ++i)
            for (int j = 0; j <= 2; ++j) p[i].push_back(r.point({double(i), double(j), 0}, 0.3));
        for (int i = 0; i <= 3; ++i) net.a.push_back(make_interpolate(p[i], SplineEnds::natural));
        for (int j = 0; j <= 2; ++j)
            net.b.push_back(make_interpolate({p[0][j], p[1][j], p[2][j], p[3][j]}, SplineEnds::catmull_rom));
        for (auto twist : {Twist::average, Twist::zero, Twist::gregory}) {
            const Patch patch = make_network(net, twist);
            Network flipped{backwards(net.a), {}};
            for (const auto& c : net.b) flipped.b.push_back(reversed(c));
            const auto away_from_breaks = [](const Rect& rect, Vec2 q) { return flip_u(rect, q); };
            expect_same(patch, make_network({net.b, net.a}, twist), exchange);
            const Patch other = make_network(flipped, twist);
            for (int n = 0; n < 40; ++n) {
                const Vec2 q = random_parameter(r, patch), o = away_from_breaks(patch.rect(), q);
                EXPECT_LE(distance(patch.point(q.x, q.y), other.point(o.x, o.y)), 1e-13 * 4);
            }
        }
    }
}

TEST(Symmetry, SideVertex) {
    for (int seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        const auto e = random_triangle(r);
        for (auto form : {SideVertexForm::delta, SideVertexForm::seed})
            for (const auto& h : {Function::polynomial({0, 1}), Function::polynomial({0, 0, 1}),
                                  Function::polynomial({0, 0, 0, 2, -1}), cubic_blend()}) {
                const Patch patch = make_side_vertex(e, h, form);
                expect_same(patch, make_side_vertex({e[1], e[2], e[0]}, h, form), turn);
                expect_same(patch, make_side_vertex({reversed(e[1]), reversed(e[0]), reversed(e[2])}, h, form),
                            exchange);
            }
    }
}

TEST(Symmetry, BezierTriangle) {
    Random r(6);
    const int n = 4;
    // b[k][j] = b_(n-k-j, j, k)
    std::vector<std::vector<Point>> b(n + 1);
    std::vector<std::vector<double>> w(n + 1);
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n - k; ++j)
            b[k].push_back(r.point({2.0 * (n - k - j) / n, 2.0 * j / n, 0}, 0.3)), w[k].push_back(r.number(0.5, 2));
    const auto make = [&](auto index, bool rational) {
        std::vector<Point> points;
        std::vector<double> weights;
        for (int k = 0; k <= n; ++k)
            for (int j = 0; j <= n - k; ++j) {
                const auto [kk, jj] = index(n - k - j, j, k);
                points.push_back(b[kk][jj]), weights.push_back(w[kk][jj]);
            }
        return make_bezier_triangle(n, points, rational ? weights : std::vector<double>{});
    };
    for (bool rational : {false, true}) {
        const Patch patch = make([](int, int j, int k) { return std::pair{k, j}; }, rational);
        expect_same(patch,
                    make(
                        [](int i, int j, int k) {
                            return (void)k, std::pair{j, i};
                        },
                        rational),
                    turn);  // old (u,v,w) = new (w,u,v)
        expect_same(patch, make([](int i, int j, int k) { return (void)j, std::pair{k, i}; }, rational), exchange);
    }
}

}  // namespace
}  // namespace isoparm::tests
