// tightness.cpp -- what is proved about triangles, over what is true of them: 32 x 32 cells of a patch, two triangles each.
#include <algorithm>
#include <cmath>
#include <memory>

#include "bounds/bound_cell.h"
#include "cases.h"

namespace isoparm::bench {
namespace {

struct Piece {
    CornerData data;
    double parametric = 0, normal = 0;  // the largest at samples
};

std::vector<Piece> pieces_of(const Patch& patch) {
    constexpr int cells = 32, samples = 24;
    const Rect r = patch.rect();
    const bool triangle = patch.domain() == Domain::triangle;
    const auto at = [&](int i, int j) { return Vec2{r.u0 + (r.u1 - r.u0) * i / cells, r.v0 + (r.v1 - r.v0) * j / cells}; };
    std::vector<Piece> all;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < (triangle ? cells - i : cells); ++j)
            for (int half = 0; half < (triangle && i + j + 1 == cells ? 1 : 2); ++half) {
                Piece p;
                p.data.uv = half == 0 ? std::array<Vec2, 3>{at(i, j), at(i + 1, j), at(i, j + 1)} : std::array<Vec2, 3>{at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
                for (int k = 0; k < 3; ++k) p.data.points[k] = patch.point(p.data.uv[k].x, p.data.uv[k].y);
                const auto& x = p.data.points;
                const Point n = normalized(cross(x[1] - x[0], x[2] - x[0]));
                for (int a = 0; a <= samples; ++a)
                    for (int b = 0; a + b <= samples; ++b) {
                        const double l0 = double(a) / samples, l1 = double(b) / samples, l2 = 1 - l0 - l1;
                        const auto& uv = p.data.uv;
                        const Point d = patch.point(l0 * uv[0].x + l1 * uv[1].x + l2 * uv[2].x, l0 * uv[0].y + l1 * uv[1].y + l2 * uv[2].y) - (l0 * x[0] + l1 * x[1] + l2 * x[2]);
                        p.parametric = std::max(p.parametric, length(d));
                        if (finite(n)) p.normal = std::max(p.normal, std::fabs(dot(n, d)));
                    }
                if (p.parametric > 0) all.push_back(p);
            }
    return all;
}

double quantile(std::vector<double> x, double q) {
    if (x.empty()) return 0;
    std::sort(x.begin(), x.end());
    return x[std::size_t(q * double(x.size() - 1))];
}

Work bound_all(const Patch& patch, const std::vector<Piece>& pieces) {
    std::vector<double> parametric, normal;
    const BoundCell cell(patch, {{patch.lines_u()[0], patch.lines_u()[1]}, {patch.lines_v()[0], patch.lines_v()[1]}});  // these patches have no breaks
    for (const Piece& p : pieces) {
        const auto [u0, u1] = std::minmax({p.data.uv[0].x, p.data.uv[1].x, p.data.uv[2].x});
        const auto [v0, v1] = std::minmax({p.data.uv[0].y, p.data.uv[1].y, p.data.uv[2].y});
        const SecondDerivatives box = cell.model_of(patch, {{u0, u1}, {v0, v1}});
        const TriangleBound b = box.bounded ? bound_triangle(box, p.data, Measure::geometric) : bound_triangle(patch, p.data.uv, p.data.points);
        parametric.push_back(b.parametric / p.parametric);
        if (b.quiet && p.normal > 1e-9 * p.parametric) normal.push_back(b.normal / p.normal);
    }
    return {double(pieces.size()),
            {{"|S-L| median", quantile(parametric, 0.5)}, {"95 %", quantile(parametric, 0.95)}, {"normal median", quantile(normal, 0.5)}, {"95 %", quantile(normal, 0.95)},
             {"quiet", double(normal.size()) / double(pieces.size())}}};
}

}  // namespace

std::vector<Case> tightness_cases() {
    std::vector<Case> cases;
    for (const auto& [scene, title] : {std::pair{"coons", "Coons, cubic edges"}, {"teapot", "bicubic, of the teapot"}, {"sphere", "rational octant"}, {"side_vertex", "side-vertex triangle"}}) {
        const Patch patch = patches_of(scene).front().patch;
        const auto pieces = std::make_shared<std::vector<Piece>>();
        Case c{"tightness: bound over truth, 32 x 32 cells", title, "triangles", [patch, pieces] { return bound_all(patch, *pieces); }};
        c.prepare = [patch, pieces] { *pieces = pieces_of(patch); };
        c.repetitions = 3;
        cases.push_back(std::move(c));
    }
    return cases;
}

}  // namespace isoparm::bench
