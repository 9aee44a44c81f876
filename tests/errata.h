// errata.h -- data and printed formulas that the tests of docs/errata.md share. Header only, test code.
#pragma once
#include <gtest/gtest.h>

#include <functional>

#include "curves/isocurve.h"
#include "patches/gordon.h"
#include "patches/network.h"
#include "patches/tensor_bezier.h"
#include "samples.h"

namespace isoparm::tests {

inline constexpr double kRounding = 1e-13;
inline const std::vector<double> kParameters{0, 0.2, 0.5, 0.7, 1};
inline const Point kShift{100, 0, 0};

using Weights = std::array<double, 4>;
/// Cubic Hermite polynomials: value, derivative at 0, derivative, value at 1.
inline Weights hermite(double t) {
    const double t2 = t * t, t3 = t2 * t;
    return {2 * t3 - 3 * t2 + 1, t3 - 2 * t2 + t, t3 - t2, 3 * t2 - 2 * t3};
}
inline double lagrange(int k, int last, double t) {
    double product = 1;
    for (int s = 0; s <= last; ++s)
        if (s != k) product *= (t - s) / (k - s);
    return product;
}
/// Largest length of f over the parameters.
inline double largest(const std::function<Point(double)>& f) {
    double worst = 0;
    for (double t : kParameters) worst = std::max(worst, length(f(t)));
    return worst;
}
inline Point second(const Patch& p, int i, int j, double u, double v) {
    const PointJet x = p.jet(u, v);
    return double(i == 2 || j == 2 ? 2 : 1) * Point{x.x.coefficient(i, j), x.y.coefficient(i, j), x.z.coefficient(i, j)};
}

/// Lines u = 0..m, v = 0..n of a random Bezier patch run over [0,m] x [0,n], with the cross derivatives of the patch.
struct Lines {
    static constexpr int m = 3, n = 2;
    Network curves;
    CrossDerivatives cross;

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
    }
    GordonNetwork gordon() const { return {curves.b, {0, 1, 2}, curves.a, {0, 1, 2, 3}}; }
};

}  // namespace isoparm::tests
