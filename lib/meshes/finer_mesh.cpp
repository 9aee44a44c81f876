#include "meshes/finer_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

namespace isoparm {
namespace {

Vec2 middle(const MeshPart& part, std::size_t triangle) {
    const auto& t = part.triangles[triangle];
    const Vec2 &a = part.uv[t[0]], &b = part.uv[t[1]], &c = part.uv[t[2]];
    return {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3};
}

}  // namespace

FinerMesh::FinerMesh(const Composite& surface, double error, std::size_t max_triangles, const std::function<void(double)>& progress) {
    TessellationOptions options;
    options.tolerance = error;
    options.measure = Measure::geometric;
    options.max_triangles = max_triangles;
    options.study = false;
    options.progress = progress;
    Tessellation t = tessellate(surface, options);
    error_ = t.certified_error;
    mesh_ = triangles_of(t.mesh);
    parts_ = std::move(t.mesh.parts);
    std::size_t triangles = 0;
    for (const MeshPart& part : parts_) {
        first_.push_back(triangles);
        triangles += part.triangles.size();
    }
    tree_ = std::make_unique<const TriangleTree>(mesh_);
    middles_.resize(mesh_.triangles.size());
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        const MeshPart& part = parts_[p];
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, (part.triangles.size() + 255) / 256), [&](const auto& range) {
            double u[256], v[256];
            for (std::size_t block = range.begin(); block < range.end(); ++block) {
                const std::size_t begin = 256 * block, count = std::min<std::size_t>(256, part.triangles.size() - begin);
                for (std::size_t k = 0; k < count; ++k) {
                    const Vec2 uv = middle(part, begin + k);
                    u[k] = uv.x, v[k] = uv.y;
                }
                surface[part.member].patch.points(count, u, v, &middles_[first_[p] + begin]);
            }
        });
    }
}

const MeshPart& FinerMesh::part_of(std::size_t triangle, std::size_t& local) const {
    const std::size_t p = static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), triangle) - first_.begin()) - 1;
    local = triangle - first_[p];
    return parts_[p];
}

FinerMesh::Place FinerMesh::place(std::size_t i) const {
    if (i >= mesh_.points.size()) {
        std::size_t local = 0;
        const MeshPart& part = part_of(i - mesh_.points.size(), local);
        return {part.member, middle(part, local), part.flipped};
    }
    for (const MeshPart& part : parts_)
        for (std::size_t corner = 0; corner < part.vertex.size(); ++corner)
            if (part.vertex[corner] == i) return {part.member, part.uv[corner], part.flipped};
    throw std::logic_error("a vertex of the finer mesh belongs to no patch");
}

FinerMesh::Place FinerMesh::place_in(std::size_t triangle, const Point& p) const {
    std::size_t local = 0;
    const MeshPart& part = part_of(triangle, local);
    const auto& t = part.triangles[local];
    const auto [a, b, c] = mesh_.corners(triangle);
    const Point ab = b - a, ac = c - a, ap = p - a;
    const double e = dot(ab, ab), f = dot(ab, ac), g = dot(ac, ac), det = e * g - f * f;
    double s = 1.0 / 3, r = s;
    if (det > 0) {
        s = std::clamp((g * dot(ab, ap) - f * dot(ac, ap)) / det, 0.0, 1.0);
        r = std::clamp((e * dot(ac, ap) - f * dot(ab, ap)) / det, 0.0, 1 - s);
    }
    const Vec2 &x = part.uv[t[0]], &y = part.uv[t[1]], &z = part.uv[t[2]];
    return {part.member, {x.x + s * (y.x - x.x) + r * (z.x - x.x), x.y + s * (y.y - x.y) + r * (z.y - x.y)}, part.flipped};
}

std::vector<std::array<Point, 2>> FinerMesh::open_edges() const {
    std::vector<std::array<std::uint32_t, 2>> edges;
    edges.reserve(3 * mesh_.triangles.size());
    for (const auto& t : mesh_.triangles)
        for (int k = 0; k < 3; ++k) edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
    std::sort(edges.begin(), edges.end());
    std::vector<std::array<Point, 2>> open;
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t j = i + 1;
        while (j < edges.size() && edges[j] == edges[i]) ++j;
        if (j == i + 1) open.push_back({mesh_.points[edges[i][0]], mesh_.points[edges[i][1]]});
        i = j;
    }
    return open;
}

}  // namespace isoparm
