#include "grid_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace isoparm {

Leaves grid_leaves(const Patch& patch, std::uint32_t n) {
    Leaves leaves(patch, n);
    std::vector<Leaf> list;
    for (const Leaf& cell : leaves.list) {
        const auto [i0, j0] = cell.corner[0];
        for (std::uint32_t i = i0; i < i0 + n; ++i)
            for (std::uint32_t j = j0; j < (cell.sides == 3 ? n - i : j0 + n); ++j) {
                if (cell.sides == 4)
                    list.push_back({{LatticePoint{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}, 4});
                else
                    list.push_back({{LatticePoint{i, j}, {i + 1, j}, {i, j + 1}, {i, j}}, 3});
                if (cell.sides == 3 && i + j + 1 < n) list.push_back({{LatticePoint{i + 1, j}, {i + 1, j + 1}, {i, j + 1}, {i + 1, j}}, 3});
            }
    }
    leaves.list = std::move(list);
    return leaves;
}

GridMesh grid_mesh(const Composite& surface, std::uint32_t n, double join) {
    std::vector<Leaves> leaves;
    for (const Member& m : surface) leaves.push_back(grid_leaves(m.patch, n));
    GridMesh r{mesh_of(surface, find_topology(surface, join), leaves).mesh, {}};
    r.sampled_error.resize(r.mesh.parts.size());
    tbb::parallel_for(std::size_t(0), r.mesh.parts.size(), [&](std::size_t k) {
        const MeshPart& part = r.mesh.parts[k];
        const Patch& patch = surface[part.member].patch;
        for (const auto& [a, b, c] : part.triangles) {
            const auto middle = [](const auto& x, const auto& y, const auto& z) { return (x + y + z) / 3; };
            const double u = middle(part.uv[a].x, part.uv[b].x, part.uv[c].x), v = middle(part.uv[a].y, part.uv[b].y, part.uv[c].y);
            const Point flat = (r.mesh.positions[part.vertex[a]] + r.mesh.positions[part.vertex[b]] + r.mesh.positions[part.vertex[c]]) / 3.0;
            r.sampled_error[k] = std::max(r.sampled_error[k], distance(patch.point(u, v), flat));
        }
    });
    return r;
}

}  // namespace isoparm
