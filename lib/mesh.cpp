#include "mesh.h"

#include <algorithm>
#include <map>
#include <unordered_map>

namespace isoparm {

MeshTopology analyse(const Mesh& mesh, const std::vector<std::array<std::uint32_t, 2>>& open_edges) {
    MeshTopology result;
    const auto key = [](std::uint32_t a, std::uint32_t b) { return (std::uint64_t(std::min(a, b)) << 32) | std::max(a, b); };
    std::unordered_map<std::uint64_t, int> count;
    for (const auto& part : mesh.parts)
        for (const auto& t : part.triangles) {
            const std::uint32_t v[3] = {part.vertex[t[0]], part.vertex[t[1]], part.vertex[t[2]]};
            if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
                ++result.degenerate_triangles;
                continue;
            }
            for (int k = 0; k < 3; ++k) ++count[key(v[k], v[(k + 1) % 3])];
        }
    std::vector<std::uint64_t> open;
    for (const auto& e : open_edges) open.push_back(key(e[0], e[1]));
    std::sort(open.begin(), open.end());
    // Loops of boundary edges: connected pieces of the graph they form.
    std::unordered_map<std::uint32_t, std::uint32_t> parent;
    const auto root = [&](std::uint32_t v) {
        parent.try_emplace(v, v);
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const auto& [edge, triangles] : count) {
        if (triangles > 2) ++result.non_manifold_edges;
        if (triangles != 1) continue;
        ++result.boundary_edges;
        if (!std::binary_search(open.begin(), open.end(), edge)) ++result.t_junctions;
        parent[root(std::uint32_t(edge >> 32))] = root(std::uint32_t(edge));
    }
    for (const auto& [v, p] : parent) result.boundary_loops += v == p;
    return result;
}

}  // namespace isoparm
