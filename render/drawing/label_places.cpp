#include "drawing/label_places.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace isoparm {

std::vector<Vec2> middle_places(const Patch& patch) {
    if (patch.domain() == Domain::triangle) return {{1.0 / 3, 1.0 / 3}, {0.5, 0.25}, {0.25, 0.5}, {0.25, 0.25}};
    const Rect r = patch.rect();
    std::vector<Vec2> at;
    for (const auto& [x, y] : {std::array{0.5, 0.5}, {0.3, 0.5}, {0.7, 0.5}, {0.5, 0.3}, {0.5, 0.7}}) at.push_back({r.u0 + x * (r.u1 - r.u0), r.v0 + y * (r.v1 - r.v0)});
    return at;
}

std::vector<Point> places_all_over(const Composite& patches, std::size_t most) {
    const int n = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(most) / static_cast<double>(std::max<std::size_t>(1, patches.size())))));
    std::vector<Point> places;
    for (const Member& m : patches) {
        const Rect r = m.patch.rect();
        const bool triangle = m.patch.domain() == Domain::triangle;
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < (triangle ? n - i : n); ++k) {
                const double x = (i + (triangle ? 1.0 / 3 : 0.5)) / n, y = (k + (triangle ? 1.0 / 3 : 0.5)) / n;
                places.push_back(m.patch.point(r.u0 + x * (r.u1 - r.u0), r.v0 + y * (r.v1 - r.v0)));
            }
    }
    return places;
}

}  // namespace isoparm
