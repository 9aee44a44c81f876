#include "drawing/isolines.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

/// One family: `count` lines over [low, high]; the parameter x changes by `aside` a pixel to the side and up.
double family(int count, double low, double high, double x, const Vec2& aside, double width) {
    if (count <= 0 || !(high > low)) return 0;
    const double step = isoline_step(count, low, high), from = count == 1 ? 0.5 * (low + high) : low;
    const double nearest = from + std::clamp(std::round((x - from) / step), 0.0, std::max(0.0, count - 1.0)) * step;
    if (std::fabs(x - nearest) > 0.501 * width * (std::fabs(aside.x) + std::fabs(aside.y))) return 0;  // most are, and roots take time
    const double a_pixel = std::hypot(aside.x, aside.y);
    if (!std::isfinite(a_pixel) || a_pixel == 0 || std::fabs(x - nearest) > 0.5 * width * a_pixel) return 0;
    return isoline_fade(a_pixel, step, width);
}

}  // namespace

double isoline_step(int count, double low, double high) { return count <= 1 ? high - low : (high - low) / (count - 1); }

std::vector<double> isoline_places(int count, double low, double high) {
    if (count == 1) return {0.5 * (low + high)};
    std::vector<double> places;
    for (int i = 0; i < count; ++i) places.push_back(i + 1 == count ? high : low + i * isoline_step(count, low, high));
    return places;
}

double isoline_fade(double a_pixel, double step, double width) {
    const double crowded = width * a_pixel / step;  // part of the surface that lines cover here
    return std::clamp((0.9 - crowded) / 0.5, 0.0, 1.0);
}

namespace {

/// By how much u and v change a pixel to the side and up: (u, u), (v, v).
std::array<Vec2, 2> parameters_aside(const PatchPlace& place, const Camera& camera, const Point& position, const Point& direction) {
    const Point n = cross(place.du, place.dv);
    const double nn = dot(n, n), facing = dot(n, direction);
    if (!(nn > 0) || facing == 0) return {{{INFINITY, INFINITY}, {INFINITY, INFINITY}}};
    // One pixel to the side, back onto the tangent plane along the ray, then into parameters.
    const double pixel = camera.pixel_size(camera.depth(position));
    const auto parameters = [&](const Point& aside) {
        const Point d = pixel * (aside - (dot(n, aside) / facing) * direction);
        return Vec2{dot(cross(d, place.dv), n) / nn, dot(cross(place.du, d), n) / nn};
    };
    const Vec2 x = parameters(camera.right), y = parameters(camera.up);
    return {{{x.x, y.x}, {x.y, y.y}}};
}

}  // namespace

std::array<double, 3> parameters_a_pixel(const PatchPlace& place, const Camera& camera, const Point& position, const Point& direction) {
    const auto [u, v] = parameters_aside(place, camera, position, direction);
    return {std::hypot(u.x, u.y), std::hypot(v.x, v.y), std::hypot(u.x + v.x, u.y + v.y)};
}

double isoline_cover(const Isolines& lines, const PatchPlace& place, const Camera& camera, const Point& position,
                     const Point& direction) {
    if ((lines.u <= 0 && lines.v <= 0) || !(lines.opacity > 0) || !(lines.width > 0)) return 0;
    const auto [u, v] = parameters_aside(place, camera, position, direction);
    const Rect& r = place.rect;
    double cover = std::max(family(lines.u, r.u0, r.u1, place.u, u, lines.width),
                            family(lines.v, r.v0, r.v1, place.v, v, lines.width));
    if (place.domain == Domain::triangle)
        cover = std::max(cover, family(std::max(lines.u, lines.v), 0, 1, 1 - place.u - place.v, {u.x + v.x, u.y + v.y}, lines.width));
    return lines.opacity * cover;
}

}  // namespace isoparm
