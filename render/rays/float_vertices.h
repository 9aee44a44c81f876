// float_vertices.h -- vertices as Embree reads them: in float32, relative to the middle of the scene.
#pragma once
#include <algorithm>
#include <vector>

#include "scalar/vec.h"

namespace isoparm {

/// How far vertices reach about the centre, and how far rounding moved them.
struct FloatExtent {
    double radius = 0, rounding = 0;

    void add(const FloatExtent& other) { radius = std::max(radius, other.radius), rounding = std::max(rounding, other.rounding); }
    /// A ball about a vertex, stored.
    void store(const Point& p, double ball, const Point& centre, float* out) {
        const Point q = p - centre;
        for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(q[i]);
        rounding = std::max(rounding, (1 + 1e-9) * length(q - Point(out[0], out[1], out[2])) + 1e-16 * (length(p) + length(centre)));
        radius = std::max(radius, length(q) + ball);
    }
};

class FloatVertices {
public:
    FloatVertices(std::size_t n, const Point& centre) : centre_(centre), size_(n), numbers_(3 * n + 4) {}  // Embree may read 16 bytes at once
    std::size_t size() const { return size_; }
    const float* data() const { return numbers_.data(); }
    const FloatExtent& extent() const { return extent_; }
    void set(std::size_t i, const Point& p) { extent_.store(p, 0, centre_, &numbers_[3 * i]); }
    Point operator[](std::size_t i) const { return centre_ + Point(numbers_[3 * i], numbers_[3 * i + 1], numbers_[3 * i + 2]); }

private:
    Point centre_;
    std::size_t size_;
    std::vector<float> numbers_;
    FloatExtent extent_;
};

}  // namespace isoparm
