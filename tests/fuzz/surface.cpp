// Any bytes as control points of a surface, huge, tiny and not finite ones too: an isoparm::Error, or a surface whose points lie in their
// enclosures and whose mesh, where there is one, is finite and no farther from it than is certified.
#include <tbb/global_control.h>

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

/// Two enclosures of the same points, the points themselves, and a triangle's proved distance against what its middle shows.
void check_enclosures(const Patch& patch) {
    const Box box{{0.25, 0.5}, {0.125, 0.375}};
    const auto over = patch.enclose_points(box);
    for (const auto& [u, v] : {std::pair{0.25, 0.125}, {0.5, 0.375}, {0.3125, 0.25}}) {
        if (!finite(patch.point(u, v))) continue;  // beyond the largest double
        const auto exact = patch.enclose_point(u, v);
        for (int k = 0; k < 3; ++k)  // two sets that both hold the exact point
            if (exact[k].hi < over[k].lo || exact[k].lo > over[k].hi) std::abort();
        (void)evaluate(patch, u, v);
    }
}
/// At least how far S(uv) is from x, by an enclosure.
double apart(const Patch& patch, const Vec2& uv, const Point& x) {
    const auto s = patch.enclose_point(uv.x, uv.y);
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += std::pow(std::max({0.0, s[k].lo - x[k], x[k] - s[k].hi}), 2);
    return std::sqrt(sum);
}
/// The mesh is finite, and no middle of a triangle or edge is farther from the surface than is certified.
void check_mesh(const Patch& patch, bool study) {
    TessellationOptions options;
    options.measure = Measure::parametric;
    const Rect r = patch.rect();
    const auto all = patch.enclose_points({{r.u0, r.u1}, {r.v0, r.v1}});  // at a fraction of what bounding_box() takes
    options.tolerance = 0.1 * length(Point{all[0].hi - all[0].lo, all[1].hi - all[1].lo, all[2].hi - all[2].lo});
    options.max_triangles = 40;
    options.study = study;
    if (!(options.tolerance > 0) || !std::isfinite(options.tolerance)) return;
    const Tessellation t = tessellate({{"s", patch}}, options);
    if (!(t.certified_error <= options.tolerance) || t.sampled_error > t.certified_error) std::abort();
    for (const Point& p : t.mesh.positions)
        if (!finite(p)) std::abort();
    const MeshPart& part = t.mesh.parts.front();
    for (const auto& c : part.triangles)
        for (const auto& [i, j, k] : {std::array{1, 1, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}}) {
            const double n = i + j + k;
            const Vec2 &a = part.uv[c[0]], &b = part.uv[c[1]], &d = part.uv[c[2]];
            const Vec2 uv{(i * a.x + j * b.x + k * d.x) / n, (i * a.y + j * b.y + k * d.y) / n};
            const auto at = [&](int m) { return t.mesh.positions[part.vertex[c[std::size_t(m)]]]; };
            const Point x = (1 / n) * (i * at(0) + j * at(1) + k * at(2));
            if (apart(patch, uv, x) > t.certified_error + 1e-9 * options.tolerance) std::abort();  // uv and x are rounded
        }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    Bytes in{data, size};
    try {
        const Patch patch = surface(in);
        check_enclosures(patch);
        check_mesh(patch, in.byte() % 16 == 1);  // the study takes longer than all else
    } catch (const Error&) {
    }
    return 0;
}
