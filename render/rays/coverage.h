// coverage.h -- where in a picture rays of the camera may meet something: the rays of all other pixels need not be traced.
#pragma once
#include <atomic>
#include <cstdint>
#include <vector>

#include "picture/camera.h"
#include "rays/traced_scene.h"

namespace isoparm {

/// Blocks of 4 x 4 pixels of the camera's picture. Immutable; safe to use from every thread.
class Coverage {
public:
    static constexpr int block = 4;

    /// Everything drawn is projected, grown by the filter, by what rounding may move a ray, and by what Embree's tubes may differ from round ones.
    Coverage(const TracedScene& scene, const Camera& camera);

    /// False: no ray through the filter about a pixel of the block that holds (x,y) meets anything of the scene.
    bool may_meet(int x, int y) const {
        if (x < 0 || y < 0 || x >= across_ * block || y >= down_ * block) return true;
        return seen_[static_cast<std::size_t>(y / block) * across_ + x / block].load(std::memory_order_relaxed);
    }

private:
    /// Marks where the convex hull of balls about the points may be seen. Safe from several threads.
    void mark(const Point* points, int n, double radius);
    void mark(double x0, double y0, double x1, double y1);

    const Camera& camera_;
    int across_, down_;
    std::vector<std::atomic<bool>> seen_;
};

}  // namespace isoparm
