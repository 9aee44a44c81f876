#include "meshes/mesh_error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <unordered_set>

namespace isoparm {
namespace {

constexpr std::uint32_t kNobody = UINT32_MAX;
constexpr double kInfinity = TriangleBound::none;

template <class F> void for_each_index(std::size_t n, F f) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 64), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) f(i);
    });
}

/// A triangle or one that is left out, counter-clockwise in the domain.
std::array<std::uint32_t, 3> corners_of(const MeshPart& part, std::size_t i) {
    if (i >= part.triangles.size()) return part.left_out[i - part.triangles.size()];
    const auto& t = part.triangles[i];
    return part.flipped ? std::array<std::uint32_t, 3>{t[0], t[2], t[1]} : t;
}
/// The edge of corners_of() that the mesh's triangle has as edge k.
int edge_of(const MeshPart& part, int k) { return part.flipped ? 2 - k : k; }

/// At least the distance of each vertex from the exact patch at its parameters.
std::vector<double> slacks(const Patch& patch, const Mesh& mesh, const MeshPart& part) {
    std::vector<double> slack(part.uv.size());
    for_each_index(slack.size(), [&](std::size_t i) {
        slack[i] = slack_of(patch, part.uv[i], mesh.positions[part.vertex[i]]);
    });
    return slack;
}

std::uint64_t segment(std::uint32_t a, std::uint32_t b) { return (std::uint64_t(std::min(a, b)) << 32) | std::max(a, b); }

/// Segments that are left out and are no edge of any triangle: nothing in the mesh is there for them.
std::unordered_set<std::uint64_t> lost_segments(const Mesh& mesh) {
    std::unordered_set<std::uint64_t> lost;
    for (const MeshPart& part : mesh.parts)
        for (const auto& t : part.left_out)
            for (int k = 0; k < 3; ++k) lost.insert(segment(part.vertex[t[k]], part.vertex[t[(k + 1) % 3]]));
    if (lost.empty()) return lost;
    for (const MeshPart& part : mesh.parts)
        for (const auto& t : part.triangles)
            for (int k = 0; k < 3; ++k) {
                const auto a = part.vertex[t[k]], b = part.vertex[t[(k + 1) % 3]];
                lost.erase(segment(a, b)), lost.erase(segment(a, a)), lost.erase(segment(b, b));
            }
    return lost;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> neighbours_in(const MeshPart& part) {
    // Half edges in buckets by their smaller corner.
    std::vector<std::uint32_t> start(part.uv.size() + 1, 0);
    const auto each = [&](auto f) {
        for (std::uint32_t i = 0; i < part.triangles.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                const auto [low, high] = std::minmax(part.triangles[i][k], part.triangles[i][(k + 1) % 3]);
                f(low, high, 3 * i + k);
            }
    };
    each([&](std::uint32_t low, std::uint32_t, std::uint32_t) { ++start[low + 1]; });
    for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    std::vector<std::array<std::uint32_t, 2>> halves(start.back());
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    std::vector<std::array<std::uint32_t, 3>> beside(part.triangles.size(), {kNobody, kNobody, kNobody});
    each([&](std::uint32_t low, std::uint32_t high, std::uint32_t half) {
        for (auto h = start[low]; h < next[low]; ++h)
            if (halves[h][0] == high) {
                const auto other = halves[h][1];
                const auto from = [&](std::uint32_t i) { return part.triangles[i / 3][i % 3]; };
                const bool free = beside[half / 3][half % 3] == kNobody && beside[other / 3][other % 3] == kNobody;
                if (!free || from(half) == from(other)) continue;  // no triangulation of a domain
                beside[half / 3][half % 3] = other / 3, beside[other / 3][other % 3] = half / 3;
            }
        halves[next[low]++] = {high, half};
    });
    return beside;
}

struct MeshProver::PartProof {
    std::vector<double> slack;  // by corner
    std::vector<TriangleBound> bounds;
    bool above = false;  // some triangle alone, when that ends it
};

MeshProver::MeshProver(const Composite& surface) : surface_(surface), cells_(surface.size()) {
    for (std::size_t m = 0; m < surface.size(); ++m) {
        const Patch& patch = surface[m].patch;
        Cells& c = cells_[m];
        c.us = patch.lines_u(), c.vs = patch.lines_v();
        for (std::size_t i = 0; i + 1 < c.us.size(); ++i)
            for (std::size_t j = 0; j + 1 < c.vs.size(); ++j)
                c.cells.push_back(std::make_unique<BoundCell>(patch, Box{{c.us[i], c.us[i + 1]}, {c.vs[j], c.vs[j + 1]}}));
    }
}

const BoundCell* MeshProver::Cells::around(const std::array<Vec2, 3>& p) const {
    const auto column = [](const std::vector<double>& lines, double a, double b, double c) {
        const auto [low, high] = std::minmax({a, b, c});
        std::size_t i = std::size_t(std::upper_bound(lines.begin(), lines.end() - 1, low) - lines.begin());
        if (i > 0) --i;
        return low >= lines[i] && high <= lines[i + 1] ? i : kNobody;
    };
    const std::size_t i = column(us, p[0].x, p[1].x, p[2].x), j = column(vs, p[0].y, p[1].y, p[2].y);
    return i == kNobody || j == kNobody ? nullptr : cells[i * (vs.size() - 1) + j].get();
}

MeshProver::PartProof MeshProver::bound(const Mesh& mesh, const MeshPart& part, double tolerance, bool only_below) const {
    const Patch& patch = surface_[part.member].patch;
    PartProof proof;
    proof.slack = slacks(patch, mesh, part);
    proof.bounds.resize(part.triangles.size() + part.left_out.size());
    std::atomic<bool> above{false};
    for_each_index(proof.bounds.size(), [&](std::size_t i) {
        if (only_below && above.load(std::memory_order_relaxed)) return;
        const auto c = corners_of(part, i);
        CornerData data;
        for (int k = 0; k < 3; ++k) {
            data.uv[k] = part.uv[c[k]], data.points[k] = mesh.positions[part.vertex[c[k]]];
            data.slack = std::max(data.slack, proof.slack[c[k]]);
        }
        const BoundCell* cell = cells_[part.member].around(data.uv);
        if (cell) proof.bounds[i] = BoundCell::bound(patch, cell, data, tolerance - data.slack, Measure::geometric, TriangleBound::unasked);
        if (!(rounding::up(proof.bounds[i].own(Measure::geometric) + data.slack) <= tolerance))
            above.store(true, std::memory_order_relaxed);
    });
    proof.above = above;
    return proof;
}

std::optional<MeshProof> MeshProver::operator()(const Mesh& mesh, double tolerance, bool only_below) const {
    MeshProof result;
    const auto lost = lost_segments(mesh);
    for (const MeshPart& part : mesh.parts) {
        const PartProof proof = bound(mesh, part, tolerance, only_below);
        if (only_below && proof.above) return {};
        const auto beside = neighbours_in(part);
        const std::size_t n = part.triangles.size();
        std::vector<double>& bounds = result.bound.emplace_back(proof.bounds.size());
        std::vector<std::uint32_t>& to_split = result.to_split.emplace_back(proof.bounds.size());
        std::vector<double> parametric(proof.bounds.size());
        const auto slack_of = [&](std::size_t i) {
            const auto c = corners_of(part, i);
            return std::max({proof.slack[c[0]], proof.slack[c[1]], proof.slack[c[2]]});
        };
        for_each_index(proof.bounds.size(), [&](std::size_t i) {
            const TriangleBound& own = proof.bounds[i];
            double slack = slack_of(i);
            std::uint32_t worst = std::uint32_t(i);
            std::array<Neighbour, 3> neighbours;
            parametric[i] = rounding::up(own.parametric + slack);
            const auto c = corners_of(part, i);
            for (int k = 0; i < n && own.quiet && k < 3; ++k) {
                const int edge = edge_of(part, k);
                const auto other = beside[i][k];
                if (other == kNobody ||
                    along_line(part.uv[c[edge]], part.uv[c[(edge + 1) % 3]], cells_[part.member].us, cells_[part.member].vs))
                    continue;
                const int back = int(std::find(beside[other].begin(), beside[other].end(), std::uint32_t(i)) - beside[other].begin());
                neighbours[edge] = {&proof.bounds[other], edge_of(part, back)};
                slack = std::max(slack, slack_of(other));
                if (proof.bounds[other].quiet && proof.bounds[other].normal > proof.bounds[worst].normal) worst = other;
            }
            bounds[i] = rounding::up(geometric_bound(own, neighbours) + slack);
            to_split[i] = worst;
            if (i < n || lost.empty()) return;
            const auto is_lost = [&](int k) { return lost.count(segment(part.vertex[c[k]], part.vertex[c[(k + 1) % 3]])) > 0; };
            if (is_lost(0) || is_lost(1) || is_lost(2)) bounds[i] = parametric[i] = kInfinity;
        });
        for (std::size_t i = 0; i < bounds.size(); ++i)
            result.geometric = std::max(result.geometric, bounds[i]), result.parametric = std::max(result.parametric, parametric[i]);
    }
    if (only_below && !(result.geometric <= tolerance)) return {};
    return result;
}

TriangleNumbers sampled_errors(const Composite& surface, const Mesh& mesh) {
    constexpr int n = 4;  // samples lie where the sides are cut into n parts
    TriangleNumbers result;
    for (const MeshPart& part : mesh.parts) {
        const Patch& patch = surface[part.member].patch;
        const auto beside = neighbours_in(part);
        std::vector<double>& most = result.emplace_back(part.triangles.size() + part.left_out.size(), 0.0);
        const auto to = [&](const Point& p, std::size_t t) {
            const auto at = [&](int k) -> const Point& { return mesh.positions[part.vertex[part.triangles[t][k]]]; };
            return distance_to_triangle(p, at(0), at(1), at(2));
        };
        for_each_index(part.triangles.size(), [&](std::size_t t) {
            const auto& c = part.triangles[t];
            double u[(n + 1) * (n + 2) / 2], v[(n + 1) * (n + 2) / 2];
            Point exact[(n + 1) * (n + 2) / 2];
            std::size_t count = 0;
            for (int i = 0; i <= n; ++i)
                for (int j = 0; i + j <= n; ++j) {
                    const double a = double(i) / n, b = double(j) / n, d = double(n - i - j) / n;
                    if (std::max({a, b, d}) == 1) continue;
                    u[count] = a * part.uv[c[0]].x + b * part.uv[c[1]].x + d * part.uv[c[2]].x;
                    v[count] = a * part.uv[c[0]].y + b * part.uv[c[1]].y + d * part.uv[c[2]].y;
                    if (patch.domain() == Domain::triangle) v[count] = std::min(v[count], 1 - u[count]);
                    ++count;
                }
            patch.points(count, u, v, exact);
            for (std::size_t i = 0; i < count; ++i) {
                double d = to(exact[i], t);
                for (const auto other : beside[t])
                    if (d > most[t] && other != kNobody) d = std::min(d, to(exact[i], other));
                most[t] = std::max(most[t], d);
            }
        });
    }
    return result;
}

}  // namespace isoparm
