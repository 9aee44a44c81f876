#include "patches/network.h"

#include <algorithm>
#include <cmath>

#include "curves/modify.h"
#include "patch_model.h"
#include "patches/compatibility.h"
#include "patches/hermite_patch.h"

namespace isoparm {
namespace {

struct NetworkPatch {
    static constexpr Domain domain = Domain::quad;
    int m, n;
    std::vector<HermitePatch> cells;  // cell (i,j) = cells[i * n + j], over [i,i+1] x [j,j+1]
    std::vector<double> lines_u, lines_v;  // the borders of the cells, and breaks of the curves inside them
    std::vector<double> inner_u = inner(m), inner_v = inner(n);

    static std::vector<double> inner(int count) {
        std::vector<double> list;
        for (int k = 1; k < count; ++k) list.push_back(k);
        return list;
    }
    static std::vector<double> with_breaks(int count, const std::vector<Curve>& curves) {
        std::vector<double> list = inner(count);
        for (const Break& b : breaks_of(curves))
            if (std::abs(b.t - std::round(b.t)) > break_rounding * count) list.push_back(b.t);
        std::sort(list.begin(), list.end());
        return list;
    }
    Rect rect() const { return {0, double(m), 0, double(n)}; }
    std::vector<double> breaks_u() const { return lines_u; }
    std::vector<double> breaks_v() const { return lines_v; }

    template <class U, class V> auto operator()(const U& u, const V& v) const {
        const std::size_t i = cell_of(inner_u, u), j = cell_of(inner_v, v);
        return cells[i * n + j](u - double(i), v - double(j));
    }
};

/// Cross derivatives of a family of curves r(0,.), ..., r(m,.) by the differences (6.25).
std::vector<Curve> cross_derivatives(const std::vector<Curve>& r) {
    const std::size_t m = r.size() - 1;
    if (m == 1) return {linear_combination({-1, 1}, r), linear_combination({-1, 1}, r)};
    std::vector<Curve> d;
    d.push_back(linear_combination({-1.5, 2, -0.5}, {r[0], r[1], r[2]}));  // 2 r1 - 2 r0 - (r2 - r0)/2
    for (std::size_t i = 1; i < m; ++i) d.push_back(linear_combination({-0.5, 0.5}, {r[i - 1], r[i + 1]}));
    d.push_back(linear_combination({0.5, -2, 1.5}, {r[m - 2], r[m - 1], r[m]}));  // 2 rm - 2 r(m-1) - (rm - r(m-2))/2
    return d;
}

}  // namespace

Patch make_network(const Network& network, Twist twist, Part) {
    const std::size_t m = network.a.size() - 1, n = network.b.size() - 1;
    if (network.a.size() < 2 || network.b.size() < 2)
        throw_input("found " + std::to_string(network.a.size()) + " curves a and " + std::to_string(network.b.size()) + " curves b, expected at least two of each");
    std::vector<Curve> a, b;
    for (const auto& c : network.a) a.push_back(reparametrized(c, 0, double(n)));
    for (const auto& c : network.b) b.push_back(reparametrized(c, 0, double(m)));
    const double size = std::max(size_of({&a.front(), &a.back()}), size_of({&b.front(), &b.back()}));
    for (std::size_t i = 0; i <= m; ++i)
        for (std::size_t j = 0; j <= n; ++j)
            require_equal("a[" + std::to_string(i) + "](" + std::to_string(j) + ") = b[" + std::to_string(j) + "](" + std::to_string(i) + ")", a[i](double(j)),
                          b[j](double(i)), size);

    const auto A = cross_derivatives(a), B = cross_derivatives(b);
    NetworkPatch patch{int(m), int(n), {}, NetworkPatch::with_breaks(int(m), b), NetworkPatch::with_breaks(int(n), a)};
    for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            const auto along_v = [&](const Curve& c) { return segment(c, double(j), double(j + 1)); };
            const auto along_u = [&](const Curve& c) { return segment(c, double(i), double(i + 1)); };
            const std::array<Curve, 4> f{along_v(a[i]), along_v(A[i]), along_v(A[i + 1]), along_v(a[i + 1])};
            const std::array<Curve, 4> g{along_u(b[j]), along_u(B[j]), along_u(B[j + 1]), along_u(b[j + 1])};
            // The corner data are the differences, not the tangents of the curves: only so are the curves interpolated.
            std::array<std::array<Point, 4>, 4> M;
            std::array<std::array<Point, 2>, 2> jump{};
            for (int p = 0; p < 2; ++p)
                for (int q = 0; q < 2; ++q) {
                    const int value_u = p == 0 ? 0 : 3, der_u = p == 0 ? 1 : 2, value_v = q == 0 ? 0 : 3, der_v = q == 0 ? 1 : 2;
                    const Point twist_a = f[der_u].derivative(q), twist_b = g[der_v].derivative(p);
                    if (twist == Twist::compatible)
                        require_equal("twist at (" + std::to_string(i + p) + "," + std::to_string(j + q) + ")", twist_a, twist_b, size + length(twist_a));
                    M[value_u][value_v] = f[value_u](q);
                    M[der_u][value_v] = f[der_u](q);
                    M[value_u][der_v] = g[der_v](p);
                    M[der_u][der_v] = twist == Twist::average ? 0.5 * (twist_a + twist_b) : twist == Twist::zero ? Point{} : twist_b;
                    if (twist == Twist::gregory) jump[p][q] = twist_a - twist_b;
                }
            patch.cells.push_back({{HermiteBasis{}, f, g, M, Part::sum}, jump});
        }
    return make_patch(std::move(patch));
}

}  // namespace isoparm
