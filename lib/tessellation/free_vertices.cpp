#include "tessellation/free_vertices.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "certificate.h"
#include "error.h"

namespace isoparm {
namespace {

/// How far the surface lies over the triangle, along its normal, seen at samples: the most, and the least.
struct Range {
    double low = 0, high = 0;
};

/// Vertices on their way from the surface.
class Centring {
public:
    Centring(const Composite& surface, const Certificate& c, Mesh& mesh) : surface_(surface), c_(c), mesh_(mesh), start_(mesh.positions), normal_(start_.size()), offset_(start_.size(), 0.0) {
        for (std::size_t m = 0; m < c.patches.size(); ++m)
            for (const CertifiedTriangle& t : c.patches[m].triangles) {
                const auto v = vertices(m, t);
                const Point n = normal_of(m, t);
                for (const auto i : v) normal_[i] += n;
            }
        for (Point& n : normal_)
            if (const double size = length(n); size > 0) n = n / size;
    }

    /// Every vertex moves until the largest and the least heights over the triangles around it balance, half the way at a time.
    void balance(int rounds) {
        for (int round = 0; round < rounds; ++round) {
            std::vector<Range> around(start_.size());
            for (std::size_t m = 0; m < c_.patches.size(); ++m) {
                const std::vector<Range> ranges = ranges_of(m);
                for (std::size_t i = 0; i < ranges.size(); ++i)
                    for (const auto v : vertices(m, c_.patches[m].triangles[i])) around[v].low = std::min(around[v].low, ranges[i].low), around[v].high = std::max(around[v].high, ranges[i].high);
            }
            for (std::size_t v = 0; v < start_.size(); ++v) {
                offset_[v] += 0.5 * 0.5 * (around[v].low + around[v].high);
                mesh_.positions[v] = start_[v] + offset_[v] * normal_[v];
            }
        }
    }

private:
    std::array<std::uint32_t, 3> vertices(std::size_t m, const CertifiedTriangle& t) const {
        const auto& v = c_.patches[m].vertex;
        return {v[t.corner[0]], v[t.corner[1]], v[t.corner[2]]};
    }
    /// Twice the area long, towards the mesh's outward side.
    Point normal_of(std::size_t m, const CertifiedTriangle& t) const {
        const auto v = vertices(m, t);
        const Point n = cross(mesh_.positions[v[1]] - mesh_.positions[v[0]], mesh_.positions[v[2]] - mesh_.positions[v[0]]);
        return mesh_.parts[m].flipped ? -n : n;
    }
    std::vector<Range> ranges_of(std::size_t m) const {
        const CertifiedPatch& p = c_.patches[m];
        std::vector<Range> ranges(p.triangles.size());
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, ranges.size(), 64), [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const CertifiedTriangle& t = p.triangles[i];
                const auto v = vertices(m, t);
                const Point n = normal_of(m, t);
                const double size = length(n);
                if (!(size > 0)) continue;
                each_sample(p, t, [&](const Vec2& q, const std::array<double, 3>& l) {
                    const Point x = l[0] * mesh_.positions[v[0]] + l[1] * mesh_.positions[v[1]] + l[2] * mesh_.positions[v[2]];
                    const double height = dot(n, surface_[m].patch.point(q.x, q.y) - x) / size;
                    ranges[i].low = std::min(ranges[i].low, height), ranges[i].high = std::max(ranges[i].high, height);
                });
            }
        });
        return ranges;
    }

    const Composite& surface_;
    const Certificate& c_;
    Mesh& mesh_;
    const std::vector<Point> start_;
    std::vector<Point> normal_;
    std::vector<double> offset_;
};

constexpr std::size_t kPieces = 500;  // of a triangle, to prove it: of ten thousand, hardly one needs fifty

/// Moves the vertices of a mesh and proves the tolerance; false where that cannot be.
bool centre(const Composite& surface, double tolerance, bool slide, Tessellation& t) {
    t.tolerance = t.certified_error = tolerance;
    for (MeshPart& part : t.mesh.parts) part.bounds.assign(part.triangles.size() + part.left_out.size(), 0.0);
    const Certificate on_surface = make_certificate(surface, t, slide);
    Centring(surface, on_surface, t.mesh).balance(12);
    const Certificate c = make_certificate(surface, t, slide);
    t.sampled_error = sampled_distance(surface, c);
    if (t.sampled_error > tolerance || !check_certificate(surface, c, kPieces).proved()) return false;
    t.certified_error = 0;
    for (std::size_t m = 0; m < c.patches.size(); ++m) {
        MeshPart& part = t.mesh.parts[m];
        part.certified_error = 0;
        for (std::size_t i = 0; i < part.bounds.size(); ++i) part.bounds[i] = c.patches[m].triangles[i].bound, part.certified_error = std::max(part.certified_error, part.bounds[i]);
        t.surfaces[m].certified_error = part.certified_error;
        t.certified_error = std::max(t.certified_error, part.certified_error);
    }
    return true;
}

}  // namespace

Tessellation tessellate_free(const Composite& surface, const TessellationOptions& options) {
    if (options.normal_deviation > 0) throw_input("a limit of the normal deviation needs vertices on the surface");
    const auto start = std::chrono::steady_clock::now();
    const bool slide = options.measure == Measure::geometric;
    Tessellation result = tessellate(surface, options);  // what it needs, or cannot, is found first
    TessellationOptions how = options;
    how.study = false, how.progress = {};
    const auto attempt = [&](double coarser, Quality quality) {
        how.tolerance = coarser * options.tolerance, how.quality = quality;
        Tessellation t = tessellate(surface, how);
        if (!centre(surface, options.tolerance, slide, t)) return false;
        if (t.mesh.triangle_count() < result.mesh.triangle_count()) result = std::move(t);
        return true;
    };
    constexpr int steps = 6;
    double low = 1, high = 4;  // the largest factor that will do lies between them, about
    for (int i = 0; i < steps; ++i) {
        if (options.progress) options.progress(double(i) / (steps + 1));
        const double factor = std::sqrt(low * high);
        (attempt(factor, Quality::fast) ? low : high) = factor;
    }
    if (options.quality == Quality::optimal)
        for (const double factor : {1.15 * low, low, 0.87 * low})
            if (attempt(factor, Quality::optimal)) break;
    result.normal_deviation = 0, result.normals_unproved = 0;
    result.seconds_tessellate = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (std::size_t m = 0; options.study && m < surface.size(); ++m) result.surfaces[m].optimal_triangles = optimal_triangles(surface[m].patch, options.tolerance);
    return result;
}

}  // namespace isoparm
