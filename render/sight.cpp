#include "sight.h"

#include <algorithm>
#include <cmath>

namespace isoparm {

Sight::Sight(const TracedScene& scene, const Camera& camera)
    : scene_(scene), camera_(camera), least_(4 * scene.certified_error + 1e-4 * scene.embree->radius()) {}

double Sight::of(const Point& p, double clear) const {
    const double depth = camera_.depth(p);
    if (!(depth > 0)) return 0;
    if (scene_.things.empty()) return 1;
    const Vec2 at = camera_.project(p);
    const Ray ray = camera_.ray(at.x, at.y);
    // A pixel beside the point counts as the point: a surface that is seen almost edge on does not hide its own lines.
    const double end = dot(p - ray.origin, ray.direction) - std::max({clear, least_, 1.5 * camera_.pixel_size(depth)});
    std::vector<Hit> hits;
    scene_.embree->layers(ray, hits);
    double seen = 1;
    for (const Hit& h : hits)
        if (h.distance < end) seen *= 1 - scene_.things[h.geometry].opacity;
    return seen;
}

}  // namespace isoparm
