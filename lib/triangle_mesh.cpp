#include "triangle_mesh.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace isoparm {

std::size_t weld_equal_points(TriangleMesh& mesh) {
    const auto key = [&](std::uint32_t i) { return std::tie(mesh.points[i].x, mesh.points[i].y, mesh.points[i].z); };
    std::vector<std::uint32_t> order(mesh.points.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b) || (key(a) == key(b) && a < b); });
    std::vector<std::uint32_t> first(mesh.points.size());
    for (std::size_t k = 0; k < order.size(); ++k) first[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? first[order[k - 1]] : order[k];

    std::vector<std::uint32_t> number(mesh.points.size());
    std::size_t kept = 0;
    for (std::uint32_t i = 0; i < mesh.points.size(); ++i) {
        if (first[i] != i) continue;
        number[i] = static_cast<std::uint32_t>(kept);
        mesh.points[kept++] = mesh.points[i];
    }
    const std::size_t dropped = mesh.points.size() - kept;
    mesh.points.resize(kept);
    for (auto& t : mesh.triangles)
        for (auto& v : t) v = number[first[v]];
    return dropped;
}

TriangleMesh triangles_of(const Mesh& mesh) {
    TriangleMesh result{mesh.positions, {}};
    for (const MeshPart& part : mesh.parts)
        for (const auto& t : part.triangles) result.triangles.push_back({part.vertex[t[0]], part.vertex[t[1]], part.vertex[t[2]]});
    return result;
}

}  // namespace isoparm
