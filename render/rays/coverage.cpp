#include "rays/coverage.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "light/sampler.h"

namespace isoparm {

Coverage::Coverage(const TracedScene& scene, const Camera& camera)
    : camera_(camera), across_((camera.width + block - 1) / block), down_((camera.height + block - 1) / block), seen_(static_cast<std::size_t>(across_) * down_) {
    if (!scene.patches.empty()) {  // their leaves are not told apart
        mark(0, 0, camera.width, camera.height);
        return;
    }
    // Rays and vertices are rounded to float32 relative to the middle of the scene, by 2e-7 of its radius in all.
    const double clear = 4e-6 * scene.embree->radius();
    tbb::parallel_for(std::size_t(0), scene.things.size(), [&](std::size_t k) {
        const Thing& thing = scene.things[k];
        if (!thing.part) return;
        for (std::uint32_t i = 0; i < thing.part->triangles.size(); ++i) mark(corners_of(thing, i).data(), 3, clear);
        if (!thing.quads) return;
        for (const auto& quad : thing.quads->quads()) {
            const auto vertex = [&](int i) { return thing.quads->vertices()[quad[i]]; };
            const Point corners[] = {vertex(0), vertex(1), vertex(2), vertex(3)};
            mark(corners, 4, clear);
        }
    });
    for (const Solid& s : scene.solids) mark(s.points.data(), static_cast<int>(s.points.size()), 1.01 * s.radius + clear);
}

void Coverage::mark(const Point* points, int n, double radius) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr double kAside = PixelFilter::radius + 0.01;
    double x0 = kInfinity, y0 = kInfinity, x1 = -kInfinity, y1 = -kInfinity;
    const auto size = [](const Point& p) { return std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z); };
    for (int i = 0; i < n; ++i) {
        const double depth = camera_.depth(points[i]), r = radius + 1e-15 * (size(points[i]) + size(camera_.eye));  // far eyes cost digits
        // Not told apart: what is beside the eye, or nearly, and what has no place.
        if (!std::isfinite(depth) || (!camera_.orthographic && !(depth > 1.001 * r))) return mark(0, 0, camera_.width, camera_.height);
        const Vec2 at = camera_.project(points[i]);
        // A point of the ball is at x' = x + dx, z' = z + dz, with |dx|, |dz| <= r: |x'/z' - x/z| <= r (1 + |x/z|) / (z - r).
        const double pixel = camera_.pixel_size(depth - (camera_.orthographic ? 0 : r)), tangent = camera_.orthographic ? 0 : camera_.pixel_size(1);
        const double grown_x = r * (1 + tangent * std::fabs(at.x - 0.5 * camera_.width - camera_.shift.x)) / pixel;
        const double grown_y = r * (1 + tangent * std::fabs(at.y - 0.5 * camera_.height - camera_.shift.y)) / pixel;
        x0 = std::min(x0, at.x - grown_x), x1 = std::max(x1, at.x + grown_x);
        y0 = std::min(y0, at.y - grown_y), y1 = std::max(y1, at.y + grown_y);
    }
    // The middles of pixels whose filters reach it.
    mark(x0 - kAside - 0.5, y0 - kAside - 0.5, x1 + kAside + 0.5, y1 + kAside + 0.5);
}

void Coverage::mark(double x0, double y0, double x1, double y1) {
    const auto of = [](double x, int blocks) { return static_cast<int>(std::clamp(std::floor(x / block), -1.0, double(blocks))); };
    const int left = std::max(0, of(x0, across_)), right = std::min(across_ - 1, of(x1, across_));
    const int top = std::max(0, of(y0, down_)), bottom = std::min(down_ - 1, of(y1, down_));
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x)
            if (auto& one = seen_[static_cast<std::size_t>(y) * across_ + x]; !one.load(std::memory_order_relaxed)) one.store(true, std::memory_order_relaxed);
}

}  // namespace isoparm
