#include "light/studio.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

// Directions in the camera's frame (right, up, toward the viewer).
constexpr double kKeyFrom[3] = {-0.56, 0.60, 0.64}, kFillFrom[3] = {0.85, 0.10, 0.55};

Point in_frame(const Camera& c, const double (&d)[3]) { return normalized(d[0] * c.right + d[1] * c.up - d[2] * c.forward); }

}  // namespace

const Studio::Color Studio::key_light{0.70, 0.685, 0.66};
const Studio::Color Studio::sky_top{0.45, 0.47, 0.50}, Studio::sky_side{0.29, 0.295, 0.305}, Studio::sky_below{0.18, 0.17, 0.16}, Studio::fill_light{0.26, 0.26, 0.25};

Studio::Studio(const Camera& camera) : up(camera.up), key(in_frame(camera, kKeyFrom)), fill(in_frame(camera, kFillFrom)) {}

Studio::Color Studio::sky(const Point& d) const {
    const double height = dot(d, up), f = std::max(0.0, dot(d, fill));
    const double t = height * height * (3 - 2 * std::fabs(height));
    return (1 - t) * sky_side + t * (height > 0 ? sky_top : sky_below) + (f * f) * fill_light;
}

}  // namespace isoparm
