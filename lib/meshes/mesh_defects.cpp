#include "meshes/mesh_defects.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "meshes/triangle_tree.h"

namespace isoparm {
namespace {

class UnionFind {
public:
    explicit UnionFind(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void unite(std::uint32_t i, std::uint32_t j) {
        i = root(i), j = root(j);
        parent_[std::max(i, j)] = std::min(i, j);
    }

private:
    std::vector<std::uint32_t> parent_;
};

/// Side k of a triangle, from corner k to the next.
struct Side {
    std::uint32_t low, high, triangle;
    std::uint8_t k;
    bool backward;  // runs from high to low
    bool operator<(const Side& o) const { return low != o.low ? low < o.low : high != o.high ? high < o.high : triangle != o.triangle ? triangle < o.triangle : k < o.k; }
    bool same(const Side& o) const { return low == o.low && high == o.high; }
    std::uint32_t corner(bool at_high) const { return 3 * triangle + (backward != at_high ? (k + 1) % 3 : k); }
};

bool names_twice(const std::array<std::uint32_t, 3>& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }
double area(const std::array<Point, 3>& x) { return 0.5 * length(cross(x[1] - x[0], x[2] - x[0])); }

std::size_t count_duplicates(const TriangleMesh& mesh) {
    std::vector<std::array<std::uint32_t, 3>> sorted = mesh.triangles;
    for (auto& t : sorted) std::sort(t.begin(), t.end());
    std::sort(sorted.begin(), sorted.end());
    std::size_t n = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i) n += sorted[i] == sorted[i - 1];
    return n;
}

/// Edges, pieces, and fans around vertices.
void find_edges(const TriangleMesh& mesh, MeshDefects& d) {
    std::vector<Side> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& v = mesh.triangles[t];
        if (names_twice(v)) continue;
        for (std::uint8_t k = 0; k < 3; ++k) {
            const std::uint32_t a = v[k], b = v[(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), t, k, a > b});
        }
    }
    std::sort(sides.begin(), sides.end());
    UnionFind pieces(mesh.triangles.size()), fans(3 * mesh.triangles.size());
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t j = i + 1;
        for (; j < sides.size() && sides[j].same(sides[i]); ++j) {
            pieces.unite(sides[i].triangle, sides[j].triangle);
            for (const bool high : {false, true}) fans.unite(sides[i].corner(high), sides[j].corner(high));
        }
        if (j - i == 1) d.open_edges.push_back({sides[i].low, sides[i].high});
        if (j - i == 2) d.inconsistent_edges += sides[i].backward == sides[i + 1].backward;
        if (j - i > 2) ++d.non_manifold_edges;
        i = j;
    }
    constexpr std::uint32_t unseen = UINT32_MAX, many = UINT32_MAX - 1;
    std::vector<std::uint32_t> fan(mesh.points.size(), unseen);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (names_twice(mesh.triangles[t])) continue;
        d.components += pieces.root(t) == t;
        for (std::uint32_t k = 0; k < 3; ++k) {
            std::uint32_t& f = fan[mesh.triangles[t][k]];
            const std::uint32_t root = fans.root(3 * t + k);
            if (f == unseen) f = root;
            else if (f != root && f != many) f = many, ++d.non_manifold_vertices;
        }
    }
}

void number_loops(std::size_t points, MeshDefects& d) {
    UnionFind pieces(points);
    for (const auto& [a, b] : d.open_edges) pieces.unite(a, b);
    std::vector<std::uint32_t> number(points, UINT32_MAX);
    for (const auto& e : d.open_edges) {
        std::uint32_t& n = number[pieces.root(e[0])];
        if (n == UINT32_MAX) n = static_cast<std::uint32_t>(d.boundary_loops++);
        d.loop.push_back(n);
    }
}

/// One more segment, as a triangle with two equal corners.
void add_segment(TriangleMesh& segments, const Point& a, const Point& b) {
    const auto n = static_cast<std::uint32_t>(segments.points.size());
    segments.points.push_back(a), segments.points.push_back(b);
    segments.triangles.push_back({n, n + 1, n + 1});
}

void find_junctions(const TriangleMesh& mesh, double within, MeshDefects& d) {
    if (d.open_edges.empty()) return;
    TriangleMesh edges;
    for (const auto& [a, b] : d.open_edges) add_segment(edges, mesh.points[a], mesh.points[b]);
    const TriangleTree tree(edges);
    std::vector<std::uint32_t> ends;
    for (const auto& [a, b] : d.open_edges) ends.push_back(a), ends.push_back(b);
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (const std::uint32_t v : ends) {
        const Point& p = mesh.points[v];
        std::size_t first = d.open_edges.size();  // of the edges that it lies inside of
        tree.each_near(p, within, [&](std::uint32_t e) {
            const Point &a = mesh.points[d.open_edges[e][0]], &b = mesh.points[d.open_edges[e][1]];
            const Point along = b - a;
            const double l = dot(along, along), t = l > 0 ? dot(p - a, along) / l : 0;
            if (t > 0 && t < 1 && distance(p, a + t * along) <= within && distance(p, a) > within && distance(p, b) > within) first = std::min<std::size_t>(first, e);
        });
        if (first < d.open_edges.size()) d.t_junctions.push_back({v, d.open_edges[first]});
    }
}

}  // namespace

MeshDefects find_defects(const TriangleMesh& mesh, double junction_distance) {
    MeshDefects d;
    std::vector<char> used(mesh.points.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const auto v : mesh.triangles[t]) used[v] = 1;
        d.degenerate_triangles += names_twice(mesh.triangles[t]) || !(area(mesh.corners(t)) > 0);
    }
    d.unused_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), 0));
    d.duplicate_triangles = count_duplicates(mesh);
    TriangleMesh points{mesh.points, {}};
    d.equal_vertices = weld_equal_points(points);
    find_edges(mesh, d);
    number_loops(mesh.points.size(), d);
    find_junctions(mesh, junction_distance, d);
    return d;
}

std::size_t count_holes(const TriangleMesh& mesh, const MeshDefects& defects, const std::vector<std::array<Point, 2>>& border, double distance) {
    if (border.empty()) return defects.boundary_loops;
    TriangleMesh lines;
    for (const auto& [a, b] : border) add_segment(lines, a, b);
    const TriangleTree tree(lines);
    std::vector<char> hole(defects.boundary_loops, 0);
    for (std::size_t e = 0; e < defects.open_edges.size(); ++e) {
        const Point &a = mesh.points[defects.open_edges[e][0]], &b = mesh.points[defects.open_edges[e][1]];
        const Point middle = 0.5 * (a + b);  // of a chord, beside its arc
        if (!tree.any_within(a, distance) || !tree.any_within(b, distance) || !tree.any_within(middle, std::max(distance, 0.25 * isoparm::distance(a, b)))) hole[defects.loop[e]] = 1;
    }
    return static_cast<std::size_t>(std::count(hole.begin(), hole.end(), 1));
}

TriangleShapes measure_shapes(const TriangleMesh& mesh) {
    TriangleShapes s;
    std::vector<double> angles, aspects;
    s.least_angle = 180;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto x = mesh.corners(t);
        const double a = area(x), l[3] = {distance(x[0], x[1]), distance(x[1], x[2]), distance(x[2], x[0])};
        if (!(a > 0)) continue;
        const double longest = std::max({l[0], l[1], l[2]}), shortest = std::min({l[0], l[1], l[2]}), middle = l[0] + l[1] + l[2] - longest - shortest;
        // The least angle is opposite the shortest side: sin = 2 area / product of the others.
        const double angle = std::asin(std::min(1.0, 2 * a / (longest * middle))) * 180 / std::numbers::pi;
        angles.push_back(angle);
        aspects.push_back(longest * (longest + middle + shortest) / (4 * std::numbers::sqrt3 * a));
        if (angle < s.least_angle) s.least_angle = angle, s.thinnest = t;
    }
    if (angles.empty()) return {};
    std::sort(angles.begin(), angles.end());
    std::sort(aspects.begin(), aspects.end());
    const auto quantile = [](const std::vector<double>& x, double percent) { return x[static_cast<std::size_t>(percent / 100 * double(x.size() - 1))]; };
    s.angle_1 = quantile(angles, 1), s.angle_5 = quantile(angles, 5), s.angle_50 = quantile(angles, 50);
    s.aspect_50 = quantile(aspects, 50), s.aspect_95 = quantile(aspects, 95), s.aspect_99 = quantile(aspects, 99), s.most_aspect = aspects.back();
    return s;
}

}  // namespace isoparm
