#include "drawing/label_anchors.h"

#include <algorithm>
#include <cmath>

#include "drawing/drawn.h"
#include "drawing/label_places.h"

namespace isoparm {
namespace {

using Kind = SceneObject::Kind;

bool seen(const Anchor& a) { return a.seen >= 0.5 && std::isfinite(a.at.x + a.at.y); }

/// The middle of what is drawn: labels stand rather on the outside.
Vec2 middle_of(const Scene& scene, const Camera& camera, const std::vector<SceneObject>& objects) {
    double left = INFINITY, top = INFINITY, right = -INFINITY, bottom = -INFINITY;
    for (const Point& p : drawn_points(scene, objects)) {
        if (!(camera.depth(p) > 0)) continue;
        const Vec2 at = camera.project(p);
        left = std::min(left, at.x), right = std::max(right, at.x);
        top = std::min(top, at.y), bottom = std::max(bottom, at.y);
    }
    return left <= right ? Vec2{0.5 * (left + right), 0.5 * (top + bottom)} : Vec2{0.5 * camera.width, 0.5 * camera.height};
}

}  // namespace

bool inside(const Camera& camera, const Vec2& p) { return p.x >= 0 && p.y >= 0 && p.x <= camera.width && p.y <= camera.height; }

LabelAnchors::LabelAnchors(const Scene& scene, const Camera& camera, const Sight& sight, double pixel, double letter, const std::vector<SceneObject>& objects)
    : scene_(scene), camera_(camera), sight_(sight), pixel_(pixel), letter_(letter), size_(bounding_box(scene).diagonal()), middle_(middle_of(scene, camera, objects)) {
    if (!(size_ > 0)) size_ = 1;
    for (const SceneObject& o : objects)
        if (o.kind == Kind::point && !(o.line.width > 0)) balls_.emplace_back(o.point, radius_of(o, size_));
}

double LabelAnchors::radius_of_point(const SceneObject& o) const {
    if (o.line.width > 0) return 0.5 * o.line.width * pixel_ * camera_.pixel_size(camera_.depth(o.point));
    return radius_of(o, size_);
}

Anchor LabelAnchors::at(const Point& p, double radius, const Sight& sight) const {
    if (!(camera_.depth(p) > 0)) return {{NAN, NAN}, 0, {}, 0};
    for (const auto& [centre, other] : balls_)
        if (distance(centre, p) <= 1e-6 * size_) radius = std::max(radius, other);
    const Vec2 at = camera_.project(p);
    return {at, sight.of(p, 1.5 * radius), {at.x - middle_.x, at.y - middle_.y}, radius / camera_.pixel_size(camera_.depth(p))};
}

std::vector<Anchor> LabelAnchors::of(const SceneObject& o, const Sight& sight) const {
    switch (o.kind) {
        case Kind::surface:
            return of_surface(o, sight);
        case Kind::curve:
            return of_curve(o);
        case Kind::net:
            return {at(o.net.points[o.net.points.size() / 2], kNetBall * radius_of(o, size_))};
        case Kind::point:
            return {at(o.point, radius_of_point(o))};
        case Kind::arrow:
            return {beyond(o.arrow)};
        case Kind::axes:
            break;
    }
    return {};
}

std::vector<Anchor> LabelAnchors::of_surface(const SceneObject& o, const Sight& sight) const {
    const Surface& s = surface_of(scene_, o);
    const Patch& patch = s.patches[s.patches.size() / 2].patch;
    std::vector<Anchor> anchors;
    for (const Vec2& uv : o.label.at_uv ? std::vector<Vec2>{*o.label.at_uv} : middle_places(patch)) anchors.push_back(at(patch.point(uv.x, uv.y), 0, sight));
    if (o.label.at_uv || std::any_of(anchors.begin(), anchors.end(), seen)) return anchors;
    const std::vector<Anchor> others = in_sight(s.patches, sight);
    return others.empty() ? anchors : others;
}

/// What is seen of a surface whose middle is hidden: places with as much of it around them as there is.
std::vector<Anchor> LabelAnchors::in_sight(const Composite& patches, const Sight& sight) const {
    constexpr std::size_t kLookedAt = 600, kKept = 5;
    constexpr double kAround = 2.5;  // letters
    std::vector<Anchor> all;
    for (const Point& p : places_all_over(patches, kLookedAt))
        if (const Anchor a = at(p, 0, sight); std::isfinite(a.at.x + a.at.y) && inside(camera_, a.at)) all.push_back(a);
    std::vector<std::pair<double, Anchor>> found;  // the lower, the better
    for (const Anchor& a : all) {
        if (!seen(a)) continue;
        double cost = 0;
        for (const Anchor& b : all) cost -= std::max(0.0, 1 - std::hypot(a.at.x - b.at.x, a.at.y - b.at.y) / (kAround * letter_)) * (seen(b) ? 1 : -2);
        found.push_back({cost, a});
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Anchor> best;
    for (std::size_t k = 0; k < std::min(kKept, found.size()); ++k) best.push_back(found[k].second);
    return best;
}

std::vector<Anchor> LabelAnchors::of_curve(const SceneObject& o) const {
    const Curve& c = curve_of(scene_, o);
    const double radius = o.line.width > 0 ? 0 : radius_of(o, size_);
    std::vector<double> places;
    if (o.label.at) places = {*o.label.at};
    else
        for (const double t : {0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9}) places.push_back(c.begin() + t * (c.end() - c.begin()));
    std::vector<Anchor> anchors;
    for (const double t : places) {
        Anchor a = at(c(t), radius);
        if (o.line.width > 0) a.gap += 0.5 * o.line.width * pixel_;
        anchors.push_back(a);
    }
    return anchors;
}

/// The tip of an arrow, whose label stands rather ahead of it.
Anchor LabelAnchors::beyond(const Arrow& arrow) const {
    Anchor a = at(arrow.tip, 0);
    if (!(camera_.depth(arrow.tail) > 0)) return a;
    const Vec2 tail = camera_.project(arrow.tail), along{a.at.x - tail.x, a.at.y - tail.y};
    if (std::hypot(along.x, along.y) > 1) a.away = along;
    return a;
}

}  // namespace isoparm
