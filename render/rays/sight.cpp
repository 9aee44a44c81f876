#include "rays/sight.h"

#include <algorithm>
#include <cmath>

#include "picture/palette.h"

namespace isoparm {
namespace {

/// The part that is lost of what is behind it: panes tint, bodies of glass bend.
double hidden_by(const Thing& thing) { return thing.pane ? thing.opacity * (1 - luminance(thing.front)) : thing.opacity; }

}  // namespace

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
    s.first_ = object > 0 ? scene_.later[object - 1] : 0, s.later_ = scene_.later[object];
    return s;
}

double Sight::ball_about(const Point& p) const {
    double radius = 0;
    for (const Solid& s : scene_.solids)
        if (s.points == std::array<Point, 4>{p, p, p, p}) radius = std::max(radius, s.radius);
    return radius;
}

double Sight::beside(const Point& p, const Vec2& at, double pixel) const {
    constexpr double kAside = 0.35, kAlong = 0.5;  // pixels: the corners of a square, and between them
    constexpr Vec2 kPlaces[] = {{kAlong, 0}, {kAside, kAside}, {0, kAlong}, {-kAside, kAside}, {-kAlong, 0}, {-kAside, -kAside}, {0, -kAlong}, {kAside, -kAside}};
    std::vector<Hit> hits;
    double most = 0;
    for (const Vec2& aside : kPlaces) {
        const Ray ray = camera_.ray(at.x + aside.x, at.y + aside.y);
        scene_.embree->layers(ray, hits);
        double seen = 1;
        const auto surface = std::find_if(hits.begin(), hits.end(), [&](const Hit& h) { return own(h) && in_surface(h, ray, p, pixel); });
        if (surface == hits.end()) continue;
        for (auto h = hits.begin(); h != surface; ++h) seen *= own(*h) ? 1 : 1 - hidden_by(scene_.things[h->geometry]);
        most = std::max(most, seen);
    }
    return most;
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
    bool covered = false;
    for (const Hit& h : hits) {
        if (in_surface(h, ray, p, pixel)) covered = covered || (h.geometry >= later_ && scene_.things[h.geometry].shares_plane);
        else if (h.distance < end) seen *= 1 - hidden_by(scene_.things[h.geometry]);
    }
    return covered ? std::min(seen, beside(p, at, pixel)) : seen;
}

}  // namespace isoparm
