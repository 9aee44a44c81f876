#include "tessellation/patch_builder.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

/// How far along the outer chain a point is.
struct Along {
    Vec2 from, way;
    double of(const Vec2& p) const { return ((p.x - from.x) * way.x + (p.y - from.y) * way.y) / (way.x * way.x + way.y * way.y); }
};
Along along(const std::vector<Vec2>& uv, const Chain& outer) {
    const Vec2 &from = uv[outer.front()], &to = uv[outer.back()];
    return {from, {to.x - from.x, to.y - from.y}};
}

Chain backwards(const Chain& c) { return Chain(c.rbegin(), c.rend()); }

}  // namespace

void PatchBuilder::strip(const Chain& outer, const Chain& inner, const Bends& bends) {
    in_step(steps(outer, inner, bends));
}
void PatchBuilder::ragged_strip(const Chain& outer, const Chain& inner, const Bends& bends) {
    const std::vector<Corners> triangles = steps(outer, inner, bends);
    if (std::all_of(triangles.begin(), triangles.end(), [&](const Corners& t) { return left(t[0], t[1], t[2]); })) return in_step(triangles);
    for (const Corners& t : monotone(outer, inner)) triangle(t[0], t[1], t[2]);
}

void PatchBuilder::in_step(const std::vector<Corners>& triangles) {
    // Corners are one of the outer chain, the next of either chain, one of the inner chain.
    std::uint32_t shared = kNone;  // with the triangle before
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto [a, b, c] = triangles[i];
        const bool last = i + 1 == triangles.size(), on_outer = last || triangles[i + 1][0] == b;
        // Only the edges along the chains, the first and the last one can be known to others.
        const auto find = [&](std::uint32_t p, std::uint32_t q, bool within) { return within && !last ? edge_within(p, q) : edge(p, q); };
        std::uint32_t ab, bc, ca;
        if (mirrored_) {
            ca = shared != kNone ? shared : edge(a, c), bc = find(c, b, on_outer), ab = find(b, a, !on_outer);
            add({a, c, b}, {ca, bc, ab});
        } else {
            ab = find(a, b, !on_outer), bc = find(b, c, on_outer), ca = shared != kNone ? shared : edge(c, a);
            add({a, b, c}, {ab, bc, ca});
        }
        shared = on_outer ? bc : ab;
    }
}

bool PatchBuilder::left(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Vec2 &p = mesh_.uv[a], &q = mesh_.uv[b], &r = mesh_.uv[c];
    const double x = (q.x - p.x) * (r.y - p.y), y = (q.y - p.y) * (r.x - p.x);
    return (mirrored_ ? y - x : x - y) > 0x1p-50 * (std::fabs(x) + std::fabs(y));
}
std::vector<PatchBuilder::Corners> PatchBuilder::steps(const Chain& outer, const Chain& inner, const Bends& bends) const {
    const auto& uv = mesh_.uv;
    const Along way = along(mesh_.uv, outer);
    const auto reached = [&](const Chain& c, std::size_t i) { return way.of({0.5 * uv[c[i]].x + 0.5 * uv[c[i + 1]].x, 0.5 * uv[c[i]].y + 0.5 * uv[c[i + 1]].y}); };
    std::vector<Corners> triangles;
    triangles.reserve(outer.size() + inner.size());
    std::size_t i = 0, j = 0;
    while (i + 1 < outer.size() || j + 1 < inner.size()) {
        bool on_outer = j + 1 == inner.size();
        if (!on_outer && i + 1 < outer.size()) {
            // By the middles of the next pieces; where those are about level, along the diagonal that bends less.
            const double lead = reached(outer, i) - reached(inner, j), level = 0.3 / double(std::max(outer.size(), inner.size()));
            on_outer = std::abs(lead) < level ? !bends.less(uv[outer[i]], uv[inner[j + 1]], uv[outer[i + 1]], uv[inner[j]]) : lead < 0;
        }
        if (on_outer) triangles.push_back({outer[i], outer[i + 1], inner[j]}), ++i;
        else triangles.push_back({outer[i], inner[j + 1], inner[j]}), ++j;
    }
    return triangles;
}
std::vector<PatchBuilder::Corners> PatchBuilder::monotone(const Chain& outer, const Chain& inner) const {
    struct Corner {
        std::uint32_t corner;
        bool inner;
    };
    std::vector<Corner> order;
    const Along way = along(mesh_.uv, outer);
    const auto at = [&](std::uint32_t c) { return way.of(mesh_.uv[c]); };
    for (std::size_t i = 0, j = 0; i < outer.size() || j < inner.size();) {
        const bool next_inner = i == outer.size() || (j < inner.size() && i > 0 && (i + 1 == outer.size() || at(inner[j]) < at(outer[i])));
        order.push_back(next_inner ? Corner{inner[j++], true} : Corner{outer[i++], false});
    }
    std::vector<Corners> triangles;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (left(a, b, c)) triangles.push_back({a, b, c});
        else triangles.push_back({a, c, b});
    };
    std::vector<Corner> open{order[0], order[1]};
    for (std::size_t k = 2; k < order.size(); ++k) {
        const Corner& here = order[k];
        if (k + 1 == order.size() || here.inner != open.back().inner) {
            for (std::size_t i = 0; i + 1 < open.size(); ++i) add(here.corner, open[i].corner, open[i + 1].corner);
            open = {open.back(), here};
            continue;
        }
        Corner last = open.back();
        open.pop_back();
        const auto inside = [&] { return here.inner ? left(here.corner, last.corner, open.back().corner) : left(open.back().corner, last.corner, here.corner); };
        while (!open.empty() && inside()) {
            add(here.corner, last.corner, open.back().corner);
            last = open.back();
            open.pop_back();
        }
        open.push_back(last), open.push_back(here);
    }
    return triangles;
}

void fill_cell(PatchBuilder& build, const Bends& bends, DiceGrid grid, const std::array<Chain, 4>& side) {
    // Rows run from side `first` to side `last`, the lowest is `low`, the uppermost `high`.
    const Chain &low = side[grid.columns ? 3 : 0], &high = side[grid.columns ? 1 : 2], &first = side[grid.columns ? 0 : 3], &last = side[grid.columns ? 2 : 1];
    build.mirror(grid.columns);
    if (grid.lines.size() == 2 && (first.size() > 2 || last.size() > 2)) {  // strips along the sides need something inside
        grid.lines.insert(grid.lines.begin() + 1, 0.5 * grid.lines[0] + 0.5 * grid.lines[1]);
        grid.rows.insert(grid.rows.begin() + 1, grid.rows[0].size() > grid.rows[1].size() ? grid.rows[0] : grid.rows[1]);
    }
    const bool fits_first = first.size() == grid.lines.size(), fits_last = last.size() == grid.lines.size(), fits = fits_first && fits_last;
    const std::size_t n = grid.lines.size() - 1;
    std::vector<Chain> rows{low};
    Chain starts, ends;  // of the rows inside
    for (std::size_t j = 1; j < n; ++j) {
        std::vector<double>& at = grid.rows[j];
        if (!fits && at.size() == 2) at.insert(at.begin() + 1, 0.5 * at[0] + 0.5 * at[1]);
        Chain row;
        if (fits_first) row.push_back(first[j]);
        for (std::size_t i = 1; i + 1 < at.size(); ++i) row.push_back(build.corner(grid.columns ? Vec2{grid.lines[j], at[i]} : Vec2{at[i], grid.lines[j]}));
        if (fits_last) row.push_back(last[j]);
        starts.push_back(row.front()), ends.push_back(row.back());
        rows.push_back(std::move(row));
    }
    rows.push_back(high);
    for (std::size_t j = 0; j < n; ++j) build.strip(rows[j], rows[j + 1], bends);
    if (!fits_first) build.ragged_strip(backwards(first), backwards(starts), bends);
    if (!fits_last) build.ragged_strip(last, ends, bends);
    build.mirror(false);
}

void fill_triangle(PatchBuilder& build, const Bends& bends, int n, const std::array<Chain, 3>& sides) {
    const bool fits = std::all_of(sides.begin(), sides.end(), [&](const Chain& c) { return c.size() == std::size_t(n) + 1; });
    if (!fits) n = std::max(n, 3);
    std::vector<Chain> at(std::size_t(n) + 1, Chain(std::size_t(n) + 1, kNone));
    for (int i = 1; i < n; ++i)
        for (int j = 1; i + j < n; ++j) at[i][j] = build.corner({double(i) / n, double(j) / n});
    if (fits)
        for (int i = 0; i <= n; ++i) at[i][0] = sides[0][i], at[n - i][i] = sides[1][i], at[0][n - i] = sides[2][i];
    const int margin = fits ? 0 : 1;
    for (int i = margin; i < n - margin; ++i)
        for (int j = margin; i + j < n - margin; ++j) {
            build.triangle(at[i][j], at[i + 1][j], at[i][j + 1]);
            if (i + j + 1 < n - margin) build.triangle(at[i + 1][j], at[i + 1][j + 1], at[i][j + 1]);
        }
    if (fits) return;
    std::array<Chain, 3> inner;
    for (int i = 1; i <= n - 2; ++i) inner[0].push_back(at[i][1]), inner[1].push_back(at[n - 1 - i][i]), inner[2].push_back(at[1][n - 1 - i]);
    for (int k = 0; k < 3; ++k) build.strip(sides[k], inner[k], bends);
}

}  // namespace isoparm
