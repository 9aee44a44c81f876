// refine_sample.cpp -- what a program that samples would report about a mesh.
#include <tbb/parallel_for.h>

#include <algorithm>

#include "mesh.h"
#include "tessellation/refine.h"

namespace isoparm {
namespace {

constexpr std::size_t kChunk = 1024;

/// The largest of f over chunks of [0, n), where f(first, last) is called in parallel.
template <class F> double largest_of_chunks(std::size_t n, F f) {
    std::vector<double> largest((n + kChunk - 1) / kChunk, 0.0);
    tbb::parallel_for(std::size_t(0), largest.size(), [&](std::size_t k) { largest[k] = f(k * kChunk, std::min(n, (k + 1) * kChunk)); });
    return largest.empty() ? 0 : *std::max_element(largest.begin(), largest.end());
}

struct Samples {
    std::vector<double> u, v;
    std::vector<std::uint32_t> of;

    void add(const Vec2& p, std::uint32_t i) { u.push_back(p.x), v.push_back(p.y), of.push_back(i); }
    std::vector<Point> on(const Patch& patch) const {
        std::vector<Point> x(u.size());
        patch.points(u.size(), u.data(), v.data(), x.data());
        return x;
    }
};

/// Of the strip above the base of a triangle of a fan; of an edge, which in a fan ends where the strips' sides do.
Vec2 middle_of_strip(const PatchMesh& mesh, const PatchTriangle& t) {
    Vec2 sum;
    for (const auto c : t.corner) sum.x += mesh.uv[c].x, sum.y += mesh.uv[c].y;
    for (const PoleFan& f : mesh.fans)
        if (const int k = f.apex(mesh, t); k >= 0) {
            const Vec2& a = mesh.uv[t.corner[std::size_t(k)]];
            return f.along_u ? Vec2{0.5 * (sum.x - a.x), sum.y / 3} : Vec2{sum.x / 3, 0.5 * (sum.y - a.y)};
        }
    return {sum.x / 3, sum.y / 3};
}
Vec2 middle_of_side(const PatchMesh& mesh, const Vec2& a, const Vec2& b) {
    for (const PoleFan& f : mesh.fans)
        if (f.on(a) != f.on(b)) {
            const Vec2 &base = f.on(a) ? b : a;
            return f.along_u ? Vec2{base.x, 0.5 * a.y + 0.5 * b.y} : Vec2{0.5 * a.x + 0.5 * b.x, base.y};
        }
    return {0.5 * a.x + 0.5 * b.x, 0.5 * a.y + 0.5 * b.y};
}

}  // namespace

double Refinement::sampled_error() const {
    double worst = 0;
    for (std::size_t m = 0; m < patches_.size(); ++m) {
        const PatchMesh& mesh = patches_[m];
        const Patch& patch = surface_[m].patch;
        const auto at = [&](std::uint32_t corner) -> const Point& { return positions_[mesh.vertex[corner]]; };
        const auto to_triangle = [&](const Point& p, const PatchTriangle& t) { return distance_to_triangle(p, at(t.corner[0]), at(t.corner[1]), at(t.corner[2])); };
        const bool geometric = measure_ == Measure::geometric;
        worst = std::max(worst, largest_of_chunks(mesh.triangles.size(), [&](std::size_t first, std::size_t last) {
            Samples samples;
            for (std::size_t i = first; i < last; ++i) {
                const PatchTriangle& t = mesh.triangles[i];
                const Vec2 &a = mesh.uv[t.corner[0]], &b = mesh.uv[t.corner[1]], &c = mesh.uv[t.corner[2]];
                if (!mesh.left_out(t)) samples.add(mesh.in_fan(t) ? middle_of_strip(mesh, t) : Vec2{(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3}, std::uint32_t(i));
            }
            double most = 0;
            const std::vector<Point> exact = samples.on(patch);
            for (std::size_t i = 0; i < exact.size(); ++i) {
                const PatchTriangle& t = mesh.triangles[samples.of[i]];
                const double apart = distance(exact[i], (at(t.corner[0]) + at(t.corner[1]) + at(t.corner[2])) / 3.0);
                if (apart > most) most = std::max(most, geometric ? to_triangle(exact[i], t) : apart);  // the nearest point is not farther
            }
            return most;
        }));
        worst = std::max(worst, largest_of_chunks(mesh.edges.size(), [&](std::size_t first, std::size_t last) {
            Samples samples;
            for (std::size_t i = first; i < last; ++i) {
                const PatchEdge& e = mesh.edges[i];
                const Vec2 &a = mesh.uv[e.a], &b = mesh.uv[e.b];
                if (e.child == kNone && mesh.vertex[e.a] != mesh.vertex[e.b]) samples.add(middle_of_side(mesh, a, b), std::uint32_t(i));
            }
            double most = 0;
            const std::vector<Point> exact = samples.on(patch);
            for (std::size_t i = 0; i < exact.size(); ++i) {
                const PatchEdge& e = mesh.edges[samples.of[i]];
                double least = distance(exact[i], 0.5 * at(e.a) + 0.5 * at(e.b));
                if (geometric)
                    for (const auto t : e.side)
                        if (least > most && t != kNone && !mesh.left_out(mesh.triangles[t])) least = std::min(least, to_triangle(exact[i], mesh.triangles[t]));
                most = std::max(most, least);
            }
            return most;
        }));
    }
    return worst;
}

}  // namespace isoparm
