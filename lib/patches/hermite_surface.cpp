#include "patches/hermite_surface.h"

#include "patches/compatibility.h"

namespace isoparm {

HermiteSurface hermite_surface(const HermiteNetwork& network, Twist twist, bool tangents_agree, Part part) {
    const auto &f = network.f, &g = network.g;
    const std::size_t m = f.size() / 2 - 1, n = g.size() / 2 - 1;
    const double size = std::max(size_of({&f[0], &f[2 * m]}), size_of({&g[0], &g[2 * n]}));
    const double tangents = size + length(f[1](0)) + length(f.back()(0)) + length(g[1](0)) + length(g.back()(0));
    const auto require = [&](const char* what, std::size_t i, std::size_t j, std::size_t k, bool derive_f, std::size_t l, bool derive_g, double scale) {
        const std::string u = std::to_string(i), v = std::to_string(j);
        const std::string condition = std::string(what) + " at (" + u + "," + v + "): " + network.name('f', k) + (derive_f ? "'(" : "(") + v + ") = " +
                                      network.name('g', l) + (derive_g ? "'(" : "(") + u + ")";
        require_equal(condition, derive_f ? f[k].derivative(double(j)) : f[k](double(j)), derive_g ? g[l].derivative(double(i)) : g[l](double(i)), scale);
    };

    // The corner data are the cross derivatives, not the tangents of the curves: only so are the curves interpolated.
    Grid<Point> corner(f.size(), std::vector<Point>(g.size())), jump(m + 1, std::vector<Point>(n + 1));
    bool jumps = false;
    for (std::size_t i = 0; i <= m; ++i)
        for (std::size_t j = 0; j <= n; ++j) {
            const std::size_t value_u = 2 * i, der_u = 2 * i + 1, value_v = 2 * j, der_v = 2 * j + 1;
            require("position", i, j, value_u, false, value_v, false, size);
            if (tangents_agree) {
                require("tangent along u", i, j, der_u, false, value_v, true, tangents);
                require("tangent along v", i, j, value_u, true, der_v, false, tangents);
            }
            const Point a = f[der_u].derivative(double(j)), b = g[der_v].derivative(double(i));
            if (twist == Twist::compatible) require("twist", i, j, der_u, true, der_v, true, tangents + length(a));
            corner[value_u][value_v] = f[value_u](double(j));
            corner[der_u][value_v] = f[der_u](double(j));
            corner[value_u][der_v] = g[der_v](double(i));
            corner[der_u][der_v] = twist == Twist::average ? 0.5 * (a + b) : twist == Twist::zero ? Point{} : b;
            if (twist == Twist::gregory) jump[i][j] = a - b, jumps = jumps || !(a == b);
        }
    if (!jumps) jump.clear();
    return {{HermiteBasis(m), HermiteBasis(n), f, g, std::move(corner), part, {0, double(m), 0, double(n)}}, std::move(jump)};
}

HermiteSurface on_edges(HermiteSurface s, bool of_f, double* slack) {
    if (slack) *slack = 0;
    for (std::size_t i = 0; i < s.jump.size() && !of_f; ++i)
        for (std::size_t j = 0; j < s.jump[i].size(); ++j) {
            Point& twist = s.sum.corner[2 * i + 1][2 * j + 1];
            const Point sum = twist + s.jump[i][j];
            // Half a unit in the last place of each of the three numbers; Hermite polynomials of slopes are below 1.
            if (slack) *slack += 0x1p-52 * (length(sum) + 0x1p-1000);
            twist = sum;
        }
    s.jump.clear();
    return s;
}

}  // namespace isoparm
