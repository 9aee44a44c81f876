#include "joints/edge_cells.h"

#include <algorithm>
#include <cmath>

#include "exact_parts.h"

namespace isoparm {
namespace {

/// The cell of x between lines; on a line, the one that `side` points into.
std::size_t cell_beside(const std::vector<double>& lines, double x, double side) {
    std::size_t i = 0;
    while (i + 2 < lines.size() && (lines[i + 1] < x || (lines[i + 1] == x && side > 0))) ++i;
    return i;
}

/// One of the parts [k, k+1] x [l, l+1] / 2^level.
struct Part {
    int level = 0;
    double k = 0, l = 0;
    double scale() const { return std::ldexp(1.0, -level); }
    Rect rect() const { return {k * scale(), (k + 1) * scale(), l * scale(), (l + 1) * scale()}; }
    std::vector<Polynomial> form(const Patch& patch) const {
        return patch.exact_cell(dyadic_number(level, static_cast<std::size_t>(k)), dyadic_number(level, static_cast<std::size_t>(l)));
    }
};
/// The part at a point of the domain's boundary, between the corners of parts.
Part part_at(const Vec2& p, int level) {
    const double n = std::ldexp(1.0, level);
    return {level, std::min(std::floor(p.x * n), n - 1), std::min(std::floor(p.y * n), n - 1)};
}

bool holds(const Rect& r, const Vec2& p) { return p.x >= r.u0 && p.x <= r.u1 && p.y >= r.v0 && p.y <= r.v1; }

void find_cuts(const Patch& patch, int k, int level, double at, EdgeCuts& cuts) {
    const double size = std::ldexp(1.0, -level);
    const auto form = part_at(patch.edge_point(k, (at + 0.5) * size), level).form(patch);
    if (form.empty()) {
        if (at == 0) cuts.starts = true;
        if ((at + 1) * size == 1) cuts.ends = true;
    }
    if (!has_dyadic_parts(form)) return;
    find_cuts(patch, k, level + 1, 2 * at, cuts);
    cuts.inner.push_back((2 * at + 1) * (size / 2));
    find_cuts(patch, k, level + 1, 2 * at + 1, cuts);
}

std::vector<std::vector<Polynomial>> triangle_forms(const Patch& patch, int edge) {
    std::vector<std::vector<Polynomial>> list;
    for (auto form = patch.exact_cell(std::size_t(edge + 1), 0); has_line_form(form); form = patch.exact_cell(std::size_t(edge + 1), list.size())) list.push_back(std::move(form));
    return list;
}

}  // namespace

int edge_of_triangle(const Vec2& p, const Vec2& q) {
    if (p.x == 0 && q.x == 0) return 0;
    if (p.y == 0 && q.y == 0) return 1;
    return p.x + p.y == 1 && q.x + q.y == 1 ? 2 : -1;
}

CellForm form_beside(const Patch& patch, const Vec2& from, const Vec2& to, const Vec2& side) {
    const auto u = patch.lines_u(), v = patch.lines_v();
    const Vec2 middle{0.5 * from.x + 0.5 * to.x, 0.5 * from.y + 0.5 * to.y};
    const std::size_t i = cell_beside(u, middle.x, side.x), j = cell_beside(v, middle.y, side.y);
    CellForm found{{u[i], u[i + 1], v[j], v[j + 1]}, patch.exact_cell(i, j)};
    if (has_edge_forms(found.form)) {
        const Rect& c = found.cell;
        const int edge = from.x == to.x && from.x == c.u0 ? 3 : from.x == to.x && from.x == c.u1 ? 1 : from.y == to.y && from.y == c.v0 ? 0 : from.y == to.y && from.y == c.v1 ? 2 : -1;
        found.form = edge < 0 ? std::vector<Polynomial>{} : patch.exact_cell(i + std::size_t(edge + 1) * (u.size() - 1), j);
    }
    if (patch.domain() == Domain::triangle && !has_dyadic_parts(found.form) && found.form.size() != 3)
        if (const int edge = edge_of_triangle(from, to); edge >= 0) {
            const double t = edge == 0 ? 1 - middle.y : edge == 1 ? middle.x : middle.y;
            for (auto& beside : triangle_forms(patch, edge))
                if (part_of_edge(beside).contains(t)) {
                    found.form = std::move(beside);
                    break;
                }
        }
    if (!has_dyadic_parts(found.form)) return found;
    // Most lines are a side of a part.
    const double size = std::max(std::fabs(to.x - from.x), std::fabs(to.y - from.y));
    if (const int level = size > 0x1p-60 ? -std::ilogb(size) : 0; level > 1) {
        const Part part = part_at(middle, level);
        CellForm direct{part.rect(), part.form(patch)};
        if (direct.form.size() >= 3 && holds(part.rect(), from) && holds(part.rect(), to)) return direct;
    }
    for (int level = 1; has_dyadic_parts(found.form); ++level) {
        const Part part = part_at(middle, level);
        if (!holds(part.rect(), from) || !holds(part.rect(), to)) return {patch.rect(), {}};
        found = {part.rect(), part.form(patch)};
    }
    if (found.form.empty()) found.cell = patch.rect();
    return found;
}

std::vector<double> form_breaks(const Patch& patch, int edge) {
    std::vector<double> breaks = patch.edge_breaks(edge);
    if (patch.domain() == Domain::triangle && !has_dyadic_parts(patch.exact_cell(0, 0)))
        for (const auto& form : triangle_forms(patch, edge))
            if (part_of_edge(form).lo > 0) breaks.push_back(part_of_edge(form).lo);
    return breaks;
}

EdgeCuts dyadic_cuts(const Patch& patch, int k) {
    EdgeCuts cuts;
    if (has_dyadic_parts(patch.exact_cell(0, 0))) find_cuts(patch, k, 0, 0, cuts);
    return cuts;
}

}  // namespace isoparm
