#include "mesh.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace isoparm {

double distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
    const auto to_segment = [&p](const Point& x, const Point& y) {
        const Point e = y - x;
        const double ee = dot(e, e), t = ee > 0 ? std::clamp(dot(p - x, e) / ee, 0.0, 1.0) : 0;
        return distance(p, x + t * e);
    };
    const Point n = cross(b - a, c - a);
    const double nn = dot(n, n);
    // Inside all three planes through the sides, the foot of the perpendicular is nearest.
    const auto inside = [&](const Point& x, const Point& y) { return dot(cross(n, y - x), p - x) >= 0; };
    if (nn > 0 && inside(a, b) && inside(b, c) && inside(c, a)) return std::fabs(dot(n, p - a)) / std::sqrt(nn);
    return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

MeshTopology analyse(const Mesh& mesh, const std::vector<std::array<std::uint32_t, 2>>& open_edges) {
    MeshTopology result;
    // Edges by their smaller vertex: each bucket holds the larger ones, once for every triangle.
    const auto each_edge = [&](auto f) {
        for (const auto& part : mesh.parts)
            for (const auto& t : part.triangles) {
                const std::uint32_t v[3] = {part.vertex[t[0]], part.vertex[t[1]], part.vertex[t[2]]};
                if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
                for (int k = 0; k < 3; ++k) f(std::min(v[k], v[(k + 1) % 3]), std::max(v[k], v[(k + 1) % 3]));
            }
    };
    std::vector<std::uint32_t> start(mesh.positions.size() + 1, 0);
    std::size_t halves = 0;
    each_edge([&](std::uint32_t low, std::uint32_t) { ++start[low + 1], ++halves; });
    result.degenerate_triangles = mesh.triangle_count() - halves / 3;
    for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    std::vector<std::uint32_t> larger(halves), next(start.begin(), start.end() - 1);
    each_edge([&](std::uint32_t low, std::uint32_t high) { larger[next[low]++] = high; });
    std::vector<std::array<std::uint32_t, 2>> open = open_edges;
    for (auto& e : open) e = {std::min(e[0], e[1]), std::max(e[0], e[1])};
    std::sort(open.begin(), open.end());
    // Loops of boundary edges: connected pieces of the graph they form.
    std::unordered_map<std::uint32_t, std::uint32_t> parent;
    const auto root = [&](std::uint32_t v) {
        parent.try_emplace(v, v);
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (std::uint32_t low = 0; low + 1 < start.size(); ++low) {
        const auto begin = larger.begin() + start[low], end = larger.begin() + start[low + 1];
        std::sort(begin, end);
        for (auto it = begin; it != end;) {
            const auto last = std::upper_bound(it, end, *it);
            const std::array<std::uint32_t, 2> edge{low, *it};
            const auto triangles = last - it;
            it = last;
            if (triangles > 2) ++result.non_manifold_edges;
            if (triangles != 1) continue;
            ++result.boundary_edges;
            if (!std::binary_search(open.begin(), open.end(), edge)) ++result.t_junctions;
            parent[root(edge[0])] = root(edge[1]);
        }
    }
    for (const auto& [v, p] : parent) result.boundary_loops += v == p;
    return result;
}

}  // namespace isoparm
