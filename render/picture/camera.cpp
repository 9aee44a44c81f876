#include "picture/camera.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "error.h"

namespace isoparm {
namespace {

constexpr double kMargin = 0.06, kMostMargin = 0.35;       // of the picture, on each side of what is fitted
const Point kThreeQuarter = normalized({1.2, -2.1, 1.2});  // from the middle of the scene to the eye

Bounds box_of(const std::vector<Point>& points) {
    Bounds b{points.front(), points.front()};
    for (const Point& p : points) b = united(b, {p, p});
    return b;
}

/// An `up` that is not along the view direction.
Point usable_up(const Point& up, const Point& forward) {
    for (const Point& u : {up, Point{0, 0, 1}, Point{0, 1, 0}, Point{1, 0, 0}})
        if (length(u) > 0 && length(cross(forward, u)) > 1e-6 * length(u)) return u;
    return up;
}

void look(Camera& c, const Point& toward, const Point& up) {
    c.forward = normalized(toward);
    c.right = normalized(cross(c.forward, usable_up(up, c.forward)));
    c.up = cross(c.right, c.forward);
}

/// Range of a coordinate over the points.
struct Span {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    void add(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
    }
    double middle() const { return 0.5 * (low + high); }
    double extent() const { return high - low; }
};

/// The part of the picture's width and height that is not margin.
Vec2 inner_part(const Camera& c, const Vec2& room) {
    const auto part = [](double pixels, int size) { return 1 - 2 * std::min(kMostMargin, kMargin + pixels / size); };
    return {part(room.x, c.width), part(room.y, c.height)};
}

/// Zooms so that everything is inside, and moves sideways so that it is in the middle.
void fit_orthographic(Camera& c, const std::vector<Point>& drawn, const Vec2& inner) {
    const double aspect = static_cast<double>(c.width) / c.height;
    Span x, y;
    for (const Point& p : drawn) {
        x.add(dot(p - c.eye, c.right));
        y.add(dot(p - c.eye, c.up));
    }
    c.eye += x.middle() * c.right + y.middle() * c.up;
    c.half_height = 0.5 * std::max(y.extent() / inner.y, x.extent() / (aspect * inner.x));
}

/// Moves the eye to the nearest place from which everything is just inside the four planes of the view. A point at
/// (x,y,z) from the eye is inside when |x| <= a z and |y| <= b z: bounds that are linear in where the eye is.
void fit_perspective(Camera& c, const std::vector<Point>& drawn, const Vec2& inner) {
    const double aspect = static_cast<double>(c.width) / c.height;
    const double b = c.half_height * inner.y, a = c.half_height * aspect * inner.x;
    Span left, right, low, high;
    for (const Point& p : drawn) {
        const double x = dot(p - c.eye, c.right), y = dot(p - c.eye, c.up), z = c.depth(p);
        left.add(x - a * z);
        right.add(x + a * z);
        low.add(y - b * z);
        high.add(y + b * z);
    }
    const double z = std::min((right.low - left.high) / (2 * a), (high.low - low.high) / (2 * b));
    c.eye += 0.5 * (right.low + left.high) * c.right + 0.5 * (high.low + low.high) * c.up + z * c.forward;
}

}  // namespace

Ray Camera::ray(double x, double y) const {
    const double scale = 2 * half_height / height;
    const Point aside = (scale * (x - shift.x - 0.5 * width)) * right - (scale * (y - shift.y - 0.5 * height)) * up;
    if (orthographic) return {eye + aside, forward};
    return {eye, normalized(forward + aside)};
}

Vec2 Camera::project(const Point& p) const {
    const double pixel = pixel_size(depth(p));
    return {0.5 * width + shift.x + dot(p - eye, right) / pixel, 0.5 * height + shift.y - dot(p - eye, up) / pixel};
}

Camera zoomed(Camera c, double x, double y, double width, int across, int down) {
    const double scale = across / width;
    c.shift = {(0.5 * c.width + c.shift.x - x) * scale - 0.5 * across, (0.5 * c.height + c.shift.y - y) * scale - 0.5 * down};
    c.half_height *= down / (scale * c.height);
    c.width = across;
    c.height = down;
    return c;
}

Camera make_camera(const CameraSettings& settings, const std::vector<Point>& drawn, int width, int height, const Vec2& room) {
    const Bounds box = drawn.empty() ? Bounds{{-1, -1, -1}, {1, 1, 1}} : box_of(drawn);
    const Point middle = 0.5 * (box.low + box.high);
    const double size = box.diagonal() > 0 ? box.diagonal() : 1;
    const Point target = settings.target.value_or(middle);

    Camera c;
    c.width = width;
    c.height = height;
    c.orthographic = settings.orthographic.has_value();
    c.eye = settings.eye.value_or(target + 2 * size * kThreeQuarter);
    if (!(distance(c.eye, target) > 0) || !finite(c.eye) || !finite(target))
        throw_input("the camera's eye and target coincide; it cannot tell where to look");
    look(c, target - c.eye, settings.up.value_or(Point{0, 0, 1}));

    if (c.orthographic) {
        c.half_height = 0.5 * *settings.orthographic;
        if (!(c.half_height >= 0))
            throw_input("the camera's orthographic height is " + to_text(2 * c.half_height) +
                        ", expected 0 (fitted) or more");
    } else {
        if (!(settings.fov > 0 && settings.fov < 180))
            throw_input("the camera's field of view is " + to_text(settings.fov) +
                        " degrees, expected more than 0 and less than 180");
        c.half_height = std::tan(settings.fov * std::numbers::pi / 360);
    }
    if (!drawn.empty()) {
        const Vec2 inner = inner_part(c, room);
        const bool fit = settings.fit || !settings.eye;
        if (c.orthographic && (fit || c.half_height == 0)) {
            const double asked = c.half_height;
            fit_orthographic(c, drawn, inner);
            if (asked > 0 && !settings.fit) c.half_height = asked;
        } else if (fit) {
            fit_perspective(c, drawn, inner);
            if (box.diagonal() == 0) c.eye += -2 * size * c.forward;  // a single point: from some distance
        }
    }
    if (!(c.half_height > 0)) c.half_height = 1;
    // All points of an orthographic view count, also those behind where the eye happens to be.
    if (c.orthographic) {
        double nearest = 0;
        for (const Point& p : drawn) nearest = std::min(nearest, c.depth(p));
        c.eye += (nearest - size) * c.forward;
    }
    return c;
}

CameraSettings settings_of(const Camera& c, const Point& middle) {
    const double depth = c.depth(middle), away = distance(c.eye, middle);
    CameraSettings s;
    s.eye = c.eye;
    s.target = c.eye + (depth > 0 ? depth : away > 0 ? away : 1) * c.forward;
    s.up = c.up;
    if (c.orthographic) s.orthographic = 2 * c.half_height;
    else s.fov = 2 * std::atan(c.half_height) * 180 / std::numbers::pi;
    return s;
}

double finest_pixel(const Camera& camera, const Bounds& box) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int corner = 0; corner < 8; ++corner)
        nearest =
            std::min(nearest, camera.depth({corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                            corner & 4 ? box.high.z : box.low.z}));
    const double size = camera.pixel_size(std::max(nearest, 1e-3 * box.diagonal()));  // the eye may be inside the box
    // Toward the corners of a perspective picture, moving along the view moves the projection as well: by the secant of the angle to the axis in all.
    const double pixel = 2 * camera.half_height / camera.height;
    const double x = pixel * (0.5 * camera.width + std::fabs(camera.shift.x)), y = pixel * (0.5 * camera.height + std::fabs(camera.shift.y));
    return camera.orthographic ? size : size / std::sqrt(1 + x * x + y * y);
}

}  // namespace isoparm
