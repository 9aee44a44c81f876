#include "isolines.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

/// One family: `count` lines over [low, high], ends included; the parameter x changes by dx, dy a pixel.
double family(int count, double low, double high, double x, double dx, double dy, double width) {
    if (count <= 0 || !(high > low)) return 0;
    const double step = count == 1 ? high - low : (high - low) / (count - 1);
    const double from = count == 1 ? 0.5 * (low + high) : low;
    const double gradient = std::hypot(dx, dy);
    if (!std::isfinite(gradient) || gradient == 0) return 0;
    const double nearest = from + std::clamp(std::round((x - from) / step), 0.0, std::max(0.0, count - 1.0)) * step;
    if (std::fabs(x - nearest) > 0.5 * width * gradient) return 0;
    const double crowded = width * gradient / step;  // part of the surface that lines cover here
    return std::clamp((0.9 - crowded) / 0.5, 0.0, 1.0);
}

}  // namespace

double isoline_cover(const Isolines& lines, const PatchPlace& place, const Camera& camera, const Point& position,
                     const Point& direction) {
    if ((lines.u <= 0 && lines.v <= 0) || !(lines.opacity > 0) || !(lines.width > 0)) return 0;
    const Point n = cross(place.du, place.dv);
    const double nn = dot(n, n), facing = dot(n, direction);
    if (!(nn > 0) || facing == 0) return 0;
    // One pixel to the side, back onto the tangent plane along the ray, then into parameters.
    const double pixel = camera.pixel_size(camera.depth(position));
    const auto parameters = [&](const Point& aside) {
        const Point d = pixel * (aside - (dot(n, aside) / facing) * direction);
        return Vec2{dot(cross(d, place.dv), n) / nn, dot(cross(place.du, d), n) / nn};
    };
    const Vec2 x = parameters(camera.right), y = parameters(camera.up);
    const Rect& r = place.rect;
    double cover = std::max(family(lines.u, r.u0, r.u1, place.u, x.x, y.x, lines.width),
                            family(lines.v, r.v0, r.v1, place.v, x.y, y.y, lines.width));
    if (place.domain == Domain::triangle)
        cover = std::max(cover, family(std::max(lines.u, lines.v), 0, 1, 1 - place.u - place.v, -x.x - x.y, -y.x - y.y,
                                       lines.width));
    return lines.opacity * cover;
}

}  // namespace isoparm
