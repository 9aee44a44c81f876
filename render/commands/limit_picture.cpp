#include "commands/limit_picture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "image/image.h"
#include "picture/heat_map.h"
#include "provenance.h"

namespace isoparm {
namespace {

/// A grid of triangles over one patch, and how far the composite is from it at their middles.
struct Piece {
    MeshPart part;
    std::vector<Point> positions;
    std::vector<double> off;
};
Piece piece_of(const std::string& name, const LimitFaces& faces, int n) {
    const Patch& patch = faces.patches.at(name);
    const bool triangle = patch.domain() == Domain::triangle;
    const auto cell = faces.cell({0, name, 0, 0}, 0);
    std::optional<Patch> composite;
    if (cell) composite = (triangle ? triangle_methods() : quad_methods()).back().on(*cell);
    Piece piece;
    std::vector<std::vector<std::uint32_t>> at(n + 1);
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= (triangle ? n - i : n); ++j) {
            at[i].push_back(static_cast<std::uint32_t>(piece.positions.size()));
            piece.part.uv.push_back({double(i) / n, double(j) / n});
            piece.part.vertex.push_back(at[i].back());
            piece.positions.push_back(patch.point(double(i) / n, double(j) / n));
        }
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        piece.part.triangles.push_back({a, b, c});
        const auto& uv = piece.part.uv;
        const double u = (uv[a].x + uv[b].x + uv[c].x) / 3, v = (uv[a].y + uv[b].y + uv[c].y) / 3;
        piece.off.push_back(composite ? distance(composite->point(u, v), (*cell)(u, v).p) : 0);
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < (triangle ? n - i : n); ++j) {
            add(at[i][j], at[i + 1][j], at[i][j + 1]);
            if (!triangle || i + j < n - 1) add(at[i + 1][j], at[i + 1][j + 1], at[i][j + 1]);
        }
    return piece;
}

}  // namespace

void write_limit_picture(const std::string& path, const LimitResult& result) {
    if (!result.irregular.faces) return;
    const LimitFaces& faces = *result.irregular.faces;
    std::vector<std::string> names;
    for (const auto& [name, patch] : faces.patches) names.push_back(name);
    const int n = std::clamp(static_cast<int>(std::sqrt(2e5 / double(names.size()))), 4, 24);  // some 400 000 triangles
    std::vector<Piece> pieces(names.size());
    tbb::parallel_for(std::size_t(0), names.size(), [&](std::size_t k) { pieces[k] = piece_of(names[k], faces, n); });
    Mesh mesh;
    TriangleNumbers numbers;
    double top = 0;
    for (Piece& p : pieces) {
        for (auto& v : p.part.vertex) v += static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), p.positions.begin(), p.positions.end());
        for (const double off : p.off) top = std::max(top, off);
        numbers.push_back(std::move(p.off));
        mesh.parts.push_back(std::move(p.part));
    }
    const bool rounding = top <= result.regular.tolerance;
    char title[160];
    std::snprintf(title, sizeof title, "%s: composite off the limit surface by at most %.3g", std::filesystem::path(result.path).stem().string().c_str(), top);
    const HeatMap map{mesh, numbers, rounding ? std::max(result.regular.tolerance, 1e-300) : top, title, rounding ? "deviation / tolerance of rounding" : "deviation / largest"};
    CameraSettings camera;
    write_image(path, draw_heat_map(map, camera, 1024, 768), {{"Software", "isoparm " + program_version()}, {"Title", title}});
}

}  // namespace isoparm
