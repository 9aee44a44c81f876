#include "rays/shared_planes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "drawing/drawn.h"

namespace isoparm {
namespace {

constexpr int kSteps = 6;          // samples along each parameter, less one
constexpr double kFlat = 1e-6;     // of the scene's size: so far from a plane is in it, for rays in float32
constexpr double kOverlap = 1e-4;  // of the scene's size: neighbours share less

/// Where x · normal = height.
struct Flat {
    Point normal;
    double height = 0;
    std::vector<Point> points;
    Bounds box;
};

std::vector<Point> samples(const Patch& patch, int steps) {
    std::vector<Point> points;
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; j <= (patch.domain() == Domain::quad ? steps : steps - i); ++j) {
            const Rect r = patch.rect();
            points.push_back(patch.point(r.u0 + (r.u1 - r.u0) * i / steps, r.v0 + (r.v1 - r.v0) * j / steps));
        }
    return points;
}

std::optional<Flat> flat(std::vector<Point> points, double size) {
    const Point a = points.front();
    const auto farthest = [&](auto far) { return *std::max_element(points.begin(), points.end(), [&](const Point& p, const Point& q) { return far(p) < far(q); }); };
    const Point b = farthest([&](const Point& p) { return length(p - a); }), c = farthest([&](const Point& p) { return length(cross(b - a, p - a)); });
    const Point n = cross(b - a, c - a);
    if (!(length(n) > 0)) return {};
    Flat f{normalized(n), 0, {}, {a, a}};
    f.height = dot(f.normal, a);
    for (const Point& p : points) {
        if (!(std::fabs(dot(f.normal, p) - f.height) <= kFlat * size)) return {};
        f.box = united(f.box, {p, p});
    }
    f.points = std::move(points);
    return f;
}
/// Few patches are flat, and few samples tell most of them from those.
std::optional<Flat> flat(const Patch& patch, double size) {
    if (!flat(samples(patch, 2), size)) return {};
    return flat(samples(patch, kSteps), size);
}

bool meet(const Bounds& a, const Bounds& b, double within) {
    for (int i = 0; i < 3; ++i)
        if (a.low[i] > b.high[i] + within || b.low[i] > a.high[i] + within) return false;
    return true;
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

std::vector<std::vector<EmbreeScene::Plane>> shared_planes(const Scene& scene, const std::vector<SceneObject>& objects, double size) {
    std::vector<std::vector<EmbreeScene::Plane>> planes(objects.size());
    const auto surface = [](const SceneObject& o) { return o.kind == SceneObject::Kind::surface && o.opacity > 0; };
    if (std::count_if(objects.begin(), objects.end(), surface) < 2) return planes;
    std::vector<std::vector<std::pair<std::size_t, Flat>>> flats(objects.size());  // by object: patch, and what it is
    const auto share = [&](std::size_t object, std::size_t patch, const Flat& f) {
        planes[object].resize(surface_of(scene, objects[object]).patches.size());
        planes[object][patch] = {f.normal, 4 * kFlat * size};  // each is in its own plane, one in the other's, and a ray in float32 is off
    };
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (!surface(objects[i])) continue;
        const Composite& patches = surface_of(scene, objects[i]).patches;
        for (std::size_t p = 0; p < patches.size(); ++p)
            if (auto f = flat(patches[p].patch, size)) flats[i].emplace_back(p, std::move(*f));
        for (std::size_t k = 0; k < i; ++k)
            for (const auto& [p, f] : flats[i])
                for (const auto& [q, g] : flats[k])
                    if (meet(f.box, g.box, 2 * kFlat * size) && in_plane_of(f, g, size) && may_overlap(f, g, size)) share(i, p, f), share(k, q, g);
    }
    return planes;
}

}  // namespace isoparm
