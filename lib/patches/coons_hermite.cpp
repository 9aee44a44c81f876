#include "patches/coons_hermite.h"

#include "patch_model.h"
#include "patches/compatibility.h"
#include "patches/hermite_patch.h"

namespace isoparm {
namespace {

struct Corner {
    int i, j;          // which corner, 0 or 1 along u and v
    double u, v;
    int value_u, der_u, value_v, der_v;  // rows and columns of the corner's data in f, g and M
};

constexpr Corner kCorners[4] = {{0, 0, 0, 0, 0, 1, 0, 1}, {0, 1, 0, 1, 0, 1, 3, 2}, {1, 0, 1, 0, 3, 2, 0, 1}, {1, 1, 1, 1, 3, 2, 3, 2}};

}  // namespace

Patch make_coons_hermite(const HermiteData& data, Twist twist, Part part) {
    auto f = data.f, g = data.g;
    for (auto* list : {&f, &g})
        for (auto& c : *list) c = reparametrized(c, 0, 1);
    const double size = size_of({&f[0], &f[3], &g[0], &g[3]});
    const double tangents = size + length(f[1](0)) + length(f[2](0)) + length(g[1](0)) + length(g[2](0));
    std::array<std::array<Point, 4>, 4> m;
    std::array<std::array<Point, 2>, 2> jump{};
    for (const auto& c : kCorners) {
        const std::string at = "(" + std::to_string(c.i) + "," + std::to_string(c.j) + ")";
        const Curve &fv = f[c.value_u], &fd = f[c.der_u], &gv = g[c.value_v], &gd = g[c.der_v];
        require_equal("position at " + at + ": f(v) = g(u)", fv(c.v), gv(c.u), size);
        require_equal("tangent along u at " + at + ": x_u of f = derivative of g", fd(c.v), gv.derivative(c.u), tangents);
        require_equal("tangent along v at " + at + ": x_v of g = derivative of f", gd(c.u), fv.derivative(c.v), tangents);
        const Point a = fd.derivative(c.v), b = gd.derivative(c.u);
        if (twist == Twist::compatible) require_equal("twist at " + at + ": d/dv x_u = d/du x_v", a, b, tangents + length(a));
        m[c.value_u][c.value_v] = gv(c.u);
        m[c.der_u][c.value_v] = gv.derivative(c.u);
        m[c.value_u][c.der_v] = gd(c.u);
        m[c.der_u][c.der_v] = twist == Twist::average ? 0.5 * (a + b) : twist == Twist::zero ? Point{} : b;
        if (twist == Twist::gregory) jump[c.i][c.j] = a - b;
    }
    return make_patch(HermitePatch{{HermiteBasis{}, f, g, m, part}, jump});
}

}  // namespace isoparm
