#include "subdivision/limit_subcells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "subdivision/limit_cell.h"
#include "subdivision/limit_vertices.h"

namespace isoparm {
namespace {

constexpr int kSamples = 5;  // bicubic surfaces that agree at 4 x 4 points are equal
constexpr double kInfinite = 10;

/// The level at which nothing semi-sharp is left at a vertex, for each vertex; at least 2: then not all cells of a face are at its corners.
std::vector<int> levels(const Cage& cage) {
    std::vector<int> level(cage.positions.size(), 2);
    const auto raise = [&](int v, double sharpness) {
        if (sharpness < kInfinite) level[v] = std::max(level[v], static_cast<int>(std::ceil(sharpness)));
    };
    for (const auto& c : cage.creases) raise(c.a, c.sharpness), raise(c.b, c.sharpness);
    for (const auto& c : cage.corners) raise(c.vertex, c.sharpness);
    return level;
}

/// Compares the cells of that level of one patch.
void compare(const Patch& patch, int level, SubcellReport& report) {
    const LimitFunction limit = limit_function(patch);
    const LimitCell whole(Domain::quad, limit, 0, 1);
    const int cells = 1 << level;
    const double h = 1.0 / cells;
    std::vector<int> places{0, 1, cells / 2, cells - 1};
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (const int i : places)
        for (const int j : places) {
            const double s = i * h, t = j * h;
            const LimitCell cell = whole.part({s, t}, {s + h, t}, {s, t + h});
            if (!cell.complete()) continue;
            const auto coons = quad_methods().back().on(cell);
            if (!coons) continue;
            ++report.cells;
            for (int a = 0; a < kSamples; ++a)
                for (int b = 0; b < kSamples; ++b) {
                    const double x = double(a) / (kSamples - 1), y = double(b) / (kSamples - 1), off = distance(coons->point(x, y), cell(x, y).p);
                    if (!report.deviation || !(off <= *report.deviation)) report.deviation = off;
                }
        }
}

}  // namespace

SubcellReport measure_subcells(const LimitSurface& limit, const std::map<std::string, Patch>& patches) {
    SubcellReport all;
    all.compared.assign(limit.faces(), 0);
    if (limit.scheme() == Scheme::loop) return all;
    const Cage& cage = limit.cage();
    const std::vector<int> level = levels(cage);
    std::vector<SubcellReport> faces(limit.faces());
    tbb::parallel_for(0, limit.faces(), [&](int f) {
        if (limit.kind(f) != LimitFace::irregular) return;
        const auto& corners = cage.faces[f];
        int& deepest = faces[f].deepest;
        for (const int v : corners) deepest = std::max(deepest, limit.scheme() == Scheme::bilinear ? 2 : level[v]);
        if (const auto whole = patches.find(patch_name(f)); whole != patches.end()) return compare(whole->second, deepest, faces[f]);
        for (int k = 0; k < static_cast<int>(corners.size()); ++k)
            if (const auto part = patches.find(patch_name(f, k)); part != patches.end()) compare(part->second, deepest, faces[f]);
    });
    for (int f = 0; f < limit.faces(); ++f) {
        const SubcellReport& r = faces[f];
        if (r.cells == 0) continue;
        ++all.faces, all.cells += r.cells, all.deepest = std::max(all.deepest, r.deepest), all.compared[f] = 1;
        if (!all.deviation || !(*r.deviation <= *all.deviation)) all.deviation = r.deviation;
    }
    return all;
}

}  // namespace isoparm
