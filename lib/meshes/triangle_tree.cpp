#include "meshes/triangle_tree.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scalar/interval.h"

namespace isoparm {
namespace {

Point nearest_of_segment(const Point& p, const Point& a, const Point& b) {
    const Point e = b - a;
    const double ee = dot(e, e), t = ee > 0 ? std::clamp(dot(p - a, e) / ee, 0.0, 1.0) : 0;
    return a + t * e;
}

/// By its sides alone: for triangles too thin to have a normal.
Point nearest_of_sides(const Point& p, const std::array<Point, 3>& t) {
    Point best = nearest_of_segment(p, t[0], t[1]);
    for (const Point& x : {nearest_of_segment(p, t[1], t[2]), nearest_of_segment(p, t[2], t[0])})
        if (distance(p, x) < distance(p, best)) best = x;
    return best;
}

}  // namespace

Point nearest_of_triangle(const Point& p, const std::array<Point, 3>& t) {
    // Ericson, Real-Time Collision Detection (2005), 5.1.5: which corner, side or inside is nearest, by signs.
    const auto& [a, b, c] = t;
    const Point ab = b - a, ac = c - a, ap = p - a, n = cross(ab, ac);
    const double nn = dot(n, n);
    if (!(nn > 1e-16 * dot(ab, ab) * dot(ac, ac))) return nearest_of_sides(p, t);  // too thin for the signs below
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const Point bp = p - b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return nearest_of_segment(p, a, b);
    const Point cp = p - c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return nearest_of_segment(p, a, c);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return nearest_of_segment(p, b, c);
    // By n, not by va, vb and vc: in thin triangles these are differences of numbers that are almost equal.
    const double s = std::clamp(dot(cross(ap, ac), n) / nn, 0.0, 1.0), r = std::clamp(dot(cross(ab, ap), n) / nn, 0.0, 1 - s);
    return a + s * ab + r * ac;
}

TriangleTree::TriangleTree(const TriangleMesh& mesh) : number_(mesh.triangles.size()), slot_(mesh.triangles.size()) {
    const std::size_t n = mesh.triangles.size(), leaves = (n + kLeaf - 1) / kLeaf;
    std::iota(number_.begin(), number_.end(), 0u);
    corners_.resize(n);
    std::vector<Point> centres(n);
    for (std::size_t t = 0; t < n; ++t) {
        corners_[t] = mesh.corners(t);
        const auto& [a, b, c] = corners_[t];
        centres[t] = {std::min({a.x, b.x, c.x}) + std::max({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}) + std::max({a.y, b.y, c.y}), std::min({a.z, b.z, c.z}) + std::max({a.z, b.z, c.z})};
        for (const Point& x : corners_[t]) size_ = std::max({size_, std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)});
    }
    nodes_.resize(2 * leaves - 1);
    build(centres, 0, 0, n);
    std::vector<std::array<Point, 3>> in_order(n);
    for (std::size_t s = 0; s < n; ++s) in_order[s] = corners_[number_[s]], slot_[number_[s]] = static_cast<std::uint32_t>(s);
    corners_ = std::move(in_order);
}

/// The left half gets half of the leaves, all full, so that every node knows its place beforehand.
void TriangleTree::build(const std::vector<Point>& centres, std::size_t at, std::size_t begin, std::size_t end) {
    Node& node = nodes_[at];
    if (end - begin <= kLeaf) {
        node.first = static_cast<std::uint32_t>(begin), node.count = static_cast<std::uint32_t>(end - begin);
        node.low = node.high = corners_[number_[begin]][0];
        for (std::size_t s = begin; s < end; ++s)
            for (const Point& x : corners_[number_[s]])
                for (int axis = 0; axis < 3; ++axis) node.low[axis] = std::min(node.low[axis], x[axis]), node.high[axis] = std::max(node.high[axis], x[axis]);
        return;
    }
    Point low = centres[number_[begin]], high = low;
    for (std::size_t s = begin; s < end; ++s)
        for (int axis = 0; axis < 3; ++axis) low[axis] = std::min(low[axis], centres[number_[s]][axis]), high[axis] = std::max(high[axis], centres[number_[s]][axis]);
    const Point wide = high - low;
    const int axis = wide.x >= wide.y && wide.x >= wide.z ? 0 : wide.y >= wide.z ? 1 : 2;
    const std::size_t leaves = (end - begin + kLeaf - 1) / kLeaf, left = leaves / 2, middle = begin + left * kLeaf;
    const auto slot = [&](std::size_t s) { return number_.begin() + static_cast<std::ptrdiff_t>(s); };
    std::nth_element(slot(begin), slot(middle), slot(end), [&](std::uint32_t a, std::uint32_t b) {
        return centres[a][axis] < centres[b][axis] || (centres[a][axis] == centres[b][axis] && a < b);
    });
    node.first = static_cast<std::uint32_t>(at + 2 * left);
    const auto below = [&] { build(centres, at + 1, begin, middle); };
    const auto above = [&] { build(centres, node.first, middle, end); };
    if (end - begin > 10'000) tbb::parallel_invoke(below, above);
    else below(), above();
    const Node &l = nodes_[at + 1], &r = nodes_[node.first];
    for (int k = 0; k < 3; ++k) node.low[k] = std::min(l.low[k], r.low[k]), node.high[k] = std::max(l.high[k], r.high[k]);
}

TriangleTree::Nearest TriangleTree::nearest(const Point& p, std::uint32_t hint) const {
    Nearest best;
    double square = std::numeric_limits<double>::infinity();
    const auto look = [&](std::uint32_t slot) {
        const Point x = nearest_of_triangle(p, corners_[slot]);
        const Point d = p - x;
        if (const double s = dot(d, d); s < square) square = s, best.triangle = number_[slot], best.point = x;
    };
    if (hint != none) look(slot_[hint]);
    visit(p, [&] { return square; }, look);
    best.distance = std::sqrt(square);
    return best;
}

double TriangleTree::distance_down(const Point& p) const {
    const double coordinate = std::max({size_, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    double least = std::numeric_limits<double>::infinity();
    visit(p, [&] { return least * least; }, [&](std::uint32_t slot) {
        // g.(p - x) >= min over the corners c of g.(p - c) for every x of the triangle, so |p - x| >= that / |g|. With g = p - (the
        // nearest point) little is lost. Rounding: three differences and products, each off by a few u of |g| times a coordinate.
        const auto behind = [&](const Point& g) {
            const double size = length(g);
            double most = std::numeric_limits<double>::infinity();
            for (const Point& c : corners_[slot]) most = std::min(most, dot(g, p - c));
            return size > 1e-140 ? std::max(0.0, most / size * (1 - 1e-14) - 64 * 0x1p-53 * coordinate) : 0;
        };
        least = std::min(least, behind(p - nearest_of_triangle(p, corners_[slot])));
    });
    return least * (1 - 1e-14);  // boxes that were passed over are no nearer
}

bool TriangleTree::any_within(const Point& p, double distance) const {
    bool found = false;
    visit(p, [&] { return found ? -1.0 : distance * distance; }, [&](std::uint32_t slot) {
        const Point d = p - nearest_of_triangle(p, corners_[slot]);
        found = found || dot(d, d) <= distance * distance;
    });
    return found;
}

}  // namespace isoparm
