// Any bytes as control points of a surface, huge, tiny and not finite ones too: an isoparm::Error, or a surface whose points lie in their
// enclosures and whose mesh, where there is one, is finite and no farther from it than is certified.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "curves/bezier.h"
#include "error.h"
#include "patches/bezier_triangle.h"
#include "patches/coons.h"
#include "patches/ruled.h"
#include "patches/tensor_bezier.h"
#include "tessellate.h"

namespace {

using namespace isoparm;

struct Bytes {
    const std::uint8_t* at;
    std::size_t left;
    int byte() { return left > 0 ? (--left, *at++) : 0; }
    double number() {
        static const double kOdd[] = {0, -0.0, 1e-320, 1e-300, 1e-160, 1e-30, 1e30, 1e69, 1e71, 1e150, 1e154, 1e300, 1e308, std::numeric_limits<double>::infinity(), std::nan(""), 1 + 1e-15};
        const int b = byte();
        return b < 16 ? kOdd[b] : (b - 136) / 16.0;
    }
    Point point() {
        const double x = number(), y = number();
        return {x, y, number()};
    }
    double weight() { return byte() < 8 ? number() : 1; }
};

std::vector<Point> curve(Bytes& in, const Point& first, const Point& last) {
    std::vector<Point> p{first};
    for (int n = in.byte() % 3; n > 0; --n) p.push_back(in.point());
    p.push_back(last);
    return p;
}
Patch surface(Bytes& in) {
    const int kind = in.byte() % 4;
    if (kind == 0) {
        Grid<Point> points(std::size_t(in.byte() % 4 + 1));
        Grid<double> weights(points.size());
        const int columns = in.byte() % 4 + 1;
        const bool rational = in.byte() % 2;
        for (std::size_t i = 0; i < points.size(); ++i)
            for (int j = 0; j < columns; ++j) points[i].push_back(in.point()), weights[i].push_back(in.weight());
        return make_bezier_patch(points, rational ? weights : Grid<double>{});
    }
    if (kind == 1) {
        const int degree = in.byte() % 4;
        std::vector<Point> points;
        for (int k = 0; k < (degree + 1) * (degree + 2) / 2; ++k) points.push_back(in.point());
        return make_bezier_triangle(degree, points);
    }
    const Point a = in.point(), b = in.point(), c = in.point(), d = in.point();
    const Curve c0 = make_bezier(curve(in, a, b)), c1 = make_bezier(curve(in, c, d));
    if (kind == 2) return make_ruled(c0, c1);
    return make_coons({c0, c1, make_bezier(curve(in, a, c)), make_bezier(curve(in, b, d))});
}

void check(const Patch& patch) {
    const Box box{{0.25, 0.5}, {0.125, 0.375}};
    const auto over = patch.enclose_points(box);
    for (const auto& [u, v] : {std::pair{0.25, 0.125}, {0.5, 0.375}, {0.3125, 0.25}}) {
        if (!finite(patch.point(u, v))) continue;  // beyond the largest double
        const auto exact = patch.enclose_point(u, v);
        for (int k = 0; k < 3; ++k)  // two sets that both hold the exact point
            if (exact[k].hi < over[k].lo || exact[k].lo > over[k].hi) std::abort();
        (void)evaluate(patch, u, v);
    }
    TessellationOptions options;
    options.measure = Measure::parametric;
    options.tolerance = 0.1 * bounding_box({{"s", patch}}).diagonal();
    options.max_triangles = 100;
    if (!(options.tolerance > 0) || !std::isfinite(options.tolerance)) return;
    const Tessellation t = tessellate({{"s", patch}}, options);
    for (const Point& p : t.mesh.positions)
        if (!finite(p)) std::abort();
    if (!(t.certified_error <= options.tolerance) || t.sampled_error > t.certified_error) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes in{data, size};
    try {
        check(surface(in));
    } catch (const Error&) {
    }
    return 0;
}
