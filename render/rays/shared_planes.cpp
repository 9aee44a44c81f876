#include "rays/shared_planes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "drawing/drawn.h"

namespace isoparm {
namespace {

constexpr int kSteps = 6;         // samples along each parameter, less one
constexpr double kFlat = 1e-6;  // of the scene's size: so far from a plane is in it, for rays in float32
constexpr double kOverlap = 1e-4;  // of the scene's size: neighbours share less

/// Where x · normal = height.
struct Flat {
    Point normal;
    double height = 0;
    std::vector<Point> points;
};

std::vector<Point> samples(const Surface& surface) {
    std::vector<Point> points;
    for (const Member& m : surface.patches)
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; j <= (m.patch.domain() == Domain::quad ? kSteps : kSteps - i); ++j) points.push_back(m.patch.point(double(i) / kSteps, double(j) / kSteps));
    return points;
}

std::optional<Flat> flat(std::vector<Point> points, double size) {
    if (points.empty()) return {};
    const Point a = points.front();
    const auto farthest = [&](auto far) { return *std::max_element(points.begin(), points.end(), [&](const Point& p, const Point& q) { return far(p) < far(q); }); };
    const Point b = farthest([&](const Point& p) { return length(p - a); }), c = farthest([&](const Point& p) { return length(cross(b - a, p - a)); });
    const Point n = cross(b - a, c - a);
    if (!(length(n) > 0)) return {};
    Flat f{normalized(n), 0, {}};
    f.height = dot(f.normal, a);
    for (const Point& p : points)
        if (!(std::fabs(dot(f.normal, p) - f.height) <= kFlat * size)) return {};
    f.points = std::move(points);
    return f;
}

bool in_plane_of(const Flat& f, const Flat& of, double size) {
    return std::all_of(f.points.begin(), f.points.end(), [&](const Point& p) { return std::fabs(dot(of.normal, p) - of.height) <= 2 * kFlat * size; });
}

/// The corners of the convex hull, counterclockwise, by Andrew's monotone chain (1979).
std::vector<Vec2> hull(std::vector<Vec2> points) {
    std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    const auto left = [](const Vec2& a, const Vec2& b, const Vec2& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0; };
    std::vector<Vec2> corners;
    for (int pass = 0; pass < 2; ++pass, std::reverse(points.begin(), points.end())) {
        const std::size_t from = corners.size();
        for (const Vec2& p : points) {
            while (corners.size() >= from + 2 && !left(corners[corners.size() - 2], corners.back(), p)) corners.pop_back();
            corners.push_back(p);
        }
        corners.pop_back();  // the other chain begins with it
    }
    return corners;
}

/// Is one of them beyond a side of the other, or shares so little?
bool apart(const std::vector<Vec2>& a, const std::vector<Vec2>& b, double little) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Vec2 &p = a[i], &q = a[(i + 1) % a.size()], out{q.y - p.y, p.x - q.x};
        const auto beyond = [&](const Vec2& x) { return out.x * (x.x - p.x) + out.y * (x.y - p.y) > -little * std::hypot(out.x, out.y); };
        if (std::all_of(b.begin(), b.end(), beyond)) return true;
    }
    return false;
}

/// As their convex hulls do, in the first one's plane.
bool may_overlap(const Flat& a, const Flat& b, double size) {
    const Point x = normalized(a.points.front() - a.points.back()), y = cross(a.normal, x);
    const auto in_plane = [&](const Flat& f) {
        std::vector<Vec2> points;
        for (const Point& p : f.points) points.push_back({dot(x, p), dot(y, p)});
        return hull(std::move(points));
    };
    const auto first = in_plane(a), second = in_plane(b);
    return !apart(first, second, kOverlap * size) && !apart(second, first, kOverlap * size);
}

}  // namespace

std::vector<char> shared_planes(const Scene& scene, const std::vector<SceneObject>& objects, double size) {
    std::vector<char> shared(objects.size(), 0);
    std::vector<std::optional<Flat>> flats(objects.size());
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (objects[i].kind != SceneObject::Kind::surface || !(objects[i].opacity > 0)) continue;
        flats[i] = flat(samples(surface_of(scene, objects[i])), size);
        for (std::size_t k = 0; k < i; ++k)
            if (flats[i] && flats[k] && in_plane_of(*flats[i], *flats[k], size) && may_overlap(*flats[i], *flats[k], size)) shared[i] = shared[k] = 1;
    }
    return shared;
}

}  // namespace isoparm
