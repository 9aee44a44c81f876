#include "rays/sight.h"

#include <algorithm>
#include <cmath>

namespace isoparm {

Sight::Sight(const TracedScene& scene, const Camera& camera)
    : scene_(scene), camera_(camera), least_(4 * scene.certified_error + 1e-4 * scene.embree->radius()) {}

bool Sight::in_surface(const Hit& hit, const Ray& ray, const Point& p, double pixel) const {
    const Thing& thing = scene_.things[hit.geometry];
    if (!thing.patch) return false;
    const Point n = normal_at(thing, hit);
    const double off = std::fabs(dot(n, p - (ray.origin + hit.distance * ray.direction)));
    return off <= (2 * thing.error + 1e-6 * scene_.embree->radius() + 0.3 * pixel) * length(n);
}

Sight Sight::on(std::size_t object) const {
    Sight s = *this;
    s.over_ = scene_.later[object];
    return s;
}

double Sight::ball_about(const Point& p) const {
    double radius = 0;
    for (const Solid& s : scene_.solids)
        if (s.points.front() == s.points.back() && distance(s.points.front(), p) <= s.radius) radius = std::max(radius, s.radius);
    return radius;
}

double Sight::of(const Point& p, double clear) const {
    const double depth = camera_.depth(p);
    if (!(depth > 0)) return 0;
    if (scene_.things.empty()) return 1;
    const Vec2 at = camera_.project(p);
    const Ray ray = camera_.ray(at.x, at.y);
    // A pixel beside the point counts as the point: a surface that is seen almost edge on does not hide its own lines.
    const double pixel = camera_.pixel_size(depth);
    const double end = dot(p - ray.origin, ray.direction) - std::max({clear, least_, 1.5 * pixel});
    std::vector<Hit> hits;
    scene_.embree->layers(ray, hits);
    double seen = 1;
    for (const Hit& h : hits)
        if (in_surface(h, ray, p, pixel) ? h.geometry >= over_ && scene_.things[h.geometry].shares_plane : h.distance < end) seen *= 1 - scene_.things[h.geometry].opacity;
    return seen;
}

}  // namespace isoparm
