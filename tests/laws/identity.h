// identity.h -- comparison of two patches and random data, shared by the tests of identities. Header only, test code.
#pragma once
#include <gtest/gtest.h>

#include "curves/bezier.h"
#include "curves/hermite.h"
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/network.h"
#include "samples.h"

namespace isoparm::tests {

inline constexpr double kTolerance = 1e-12;
inline constexpr int kSeeds = 4;

/// Largest difference of positions, in units of the size.
inline double difference(const Patch& a, const Patch& b) {
    Random r(99);
    double worst = 0;
    for (int n = 0; n < 80; ++n) {
        Vec2 p = random_parameter(r, a);
        if (n % 4 == 0) p = a.edge_point(n % 3, r.number());
        worst = std::max(worst, distance(a.point(p.x, p.y), b.point(p.x, p.y)));
    }
    return worst / size_of_sample(a);
}
/// Positions, first and second derivatives.
inline void expect_same(const Patch& a, const Patch& b) {
    EXPECT_LE(difference(a, b), kTolerance);
    Random r(98);
    const double size = size_of_sample(a);
    for (int n = 0; n < 30; ++n) {
        const Vec2 p = random_parameter(r, a, 1e-3);
        const PointJet x = a.jet(p.x, p.y), y = b.jet(p.x, p.y);
        for (int axis = 0; axis < 3; ++axis)
            for (int k = 0; k < x.x.size; ++k)
                EXPECT_NEAR(x[axis].c[k], y[axis].c[k], 10 * kTolerance * (size + std::abs(y[axis].c[k])))
                    << "coefficient " << k << " at " << p.x << ", " << p.y;
    }
}
template <class F> void each_seed(F law) {
    for (int seed = 1; seed <= kSeeds; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random r(seed);
        law(r);
    }
}
inline CoonsCurves frame(Random& r) {
    const Frame e = random_frame(r);
    return {e.c0, e.c1, e.d0, e.d1};
}
/// Boundary and cross derivatives of a Bezier patch.
inline HermiteData hermite_data(const Grid<Point>& p) {
    const std::size_t m = p.size() - 1, n = p[0].size() - 1;
    std::array<std::vector<Point>, 4> f, g;
    for (std::size_t j = 0; j <= n; ++j) {
        f[0].push_back(p[0][j]), f[1].push_back(double(m) * (p[1][j] - p[0][j]));
        f[2].push_back(double(m) * (p[m][j] - p[m - 1][j])), f[3].push_back(p[m][j]);
    }
    for (std::size_t i = 0; i <= m; ++i) {
        g[0].push_back(p[i][0]), g[1].push_back(double(n) * (p[i][1] - p[i][0]));
        g[2].push_back(double(n) * (p[i][n] - p[i][n - 1])), g[3].push_back(p[i][n]);
    }
    return {{make_bezier(f[0]), make_bezier(f[1]), make_bezier(f[2]), make_bezier(f[3])},
            {make_bezier(g[0]), make_bezier(g[1]), make_bezier(g[2]), make_bezier(g[3])}};
}
/// Random data at the nodes (i,j) of [0,m] x [0,n].
struct Nodes {
    Grid<Point> x, u, v, uv;
    Nodes(Random& r, int m, int n) : x(m + 1), u(m + 1), v(m + 1), uv(m + 1) {
        for (int i = 0; i <= m; ++i)
            for (int j = 0; j <= n; ++j) {
                x[i].push_back(r.point({double(i), double(j), 0}, 0.3));
                u[i].push_back(r.vector()), v[i].push_back(r.vector()), uv[i].push_back(r.vector());
            }
    }
    static std::vector<Point> column(const Grid<Point>& g, std::size_t j) {
        std::vector<Point> list;
        for (const auto& row : g) list.push_back(row[j]);
        return list;
    }
    Network network() const {
        Network net;
        for (std::size_t i = 0; i < x.size(); ++i) net.a.push_back(make_hermite(x[i], v[i]));
        for (std::size_t j = 0; j < x[0].size(); ++j) net.b.push_back(make_hermite(column(x, j), column(u, j)));
        return net;
    }
    CrossDerivatives cross() const {
        CrossDerivatives c;
        for (std::size_t i = 0; i < x.size(); ++i) c.A.push_back(make_hermite(u[i], uv[i]));
        for (std::size_t j = 0; j < x[0].size(); ++j) c.B.push_back(make_hermite(column(v, j), column(uv, j)));
        return c;
    }
};

}  // namespace isoparm::tests
