#include "lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "local_frame.h"

namespace isoparm {
namespace {

using Kind = Light::Kind;
constexpr double kPi = std::numbers::pi, kFar = std::numeric_limits<double>::infinity();

/// 1 - cos of half the width of a cone, given its sine; no digits are lost for narrow ones.
double height_of_cap(double sine) { return sine * sine / (1 + std::sqrt(std::max(0.0, 1 - sine * sine))); }

/// Even over the cone about `axis` whose cap has that height.
Point in_cone(const Point& axis, double height, const Vec2& s) {
    const double z = 1 - s.x * height, r = std::sqrt(s.x * height * (2 - s.x * height)), phi = 2 * kPi * s.y;
    return normalized(LocalFrame(axis).to_world({r * std::cos(phi), r * std::sin(phi), z}));
}

double height_of(const Light& l, const Point& from) {
    return height_of_cap(l.kind == Kind::directional ? std::sin(l.radius) : std::min(1.0, l.radius / distance(l.at, from)));
}
bool outside(const Light& l, const Point& from) { return distance(l.at, from) > l.radius; }

}  // namespace

Lights::Lights(const std::vector<Light>& lights, const Camera& camera) : studio_(camera) {
    for (const Light& l : lights) {
        if (l.kind == Kind::studio || l.kind == Kind::environment) skies_.push_back(l);
        if (l.kind == Kind::studio) {
            Light key = l;
            key.kind = Kind::directional;
            key.direction = studio_.key;
            key.radius = std::atan(Studio::key_radius);
            key.power = kPi * product(l.power, Studio::key_light);
            sampled_.push_back(key);
        } else if (l.kind != Kind::environment) {
            sampled_.push_back(l);
        }
    }
}

Lights::Sample Lights::sample(const Point& from, double pick, const Vec2& s) const {
    if (sampled_.empty()) return {};
    const std::size_t n = sampled_.size(), i = std::min(n - 1, static_cast<std::size_t>(pick * double(n)));
    Sample r = sample(sampled_[i], from, s);
    r.radiance = double(n) * r.radiance;
    r.density /= double(n);
    return r;
}

Lights::Sample Lights::sample(const Light& l, const Point& from, const Vec2& s) const {
    Sample r;
    r.distance = kFar;
    if (l.kind == Kind::directional && l.radius == 0) {
        r.direction = l.direction;
        r.radiance = l.power;
        return r;
    }
    if (l.kind == Kind::rectangle) {
        const Point to = l.at + s.x * l.edges[0] + s.y * l.edges[1] - from;
        if (!(length(to) > 0)) return {};
        r.direction = normalized(to);
    } else {
        if (l.kind == Kind::sphere && !outside(l, from)) return {};
        r.direction = in_cone(l.kind == Kind::sphere ? normalized(l.at - from) : l.direction, height_of(l, from), s);
    }
    const Meeting m = meet(l, from, r.direction);
    r.distance = m.distance;
    r.density = m.distance > 0 ? density(l, from, r.direction, m.distance) : 0;
    if (!(r.density > 0)) return {};
    r.radiance = m.radiance / r.density;
    return r;
}

Lights::Meeting Lights::meet(const Light& l, const Point& from, const Point& d) const {
    switch (l.kind) {
        case Kind::studio:
            return {product(l.power, studio_.sky(d)), kFar};
        case Kind::environment:
            return {l.power, kFar};
        case Kind::directional: {
            if (l.radius == 0 || !(length(d - l.direction) <= 2 * std::sin(0.5 * l.radius) * (1 + 1e-9))) return {};
            const double sine = std::sin(l.radius);
            return {l.power / (kPi * sine * sine), kFar};
        }
        case Kind::sphere: {
            const Point to = l.at - from;
            const double along = dot(to, d);
            const Point off = to - along * d;
            const double rest = l.radius * l.radius * (1 + 1e-9) - dot(off, off);
            if (rest < 0) return {};
            const double half = std::sqrt(rest), t = along - half > 0 ? along - half : along + half;
            return t > 0 ? Meeting{l.power, t} : Meeting{};
        }
        case Kind::rectangle: {
            const Point n = cross(l.edges[0], l.edges[1]);
            const double facing = -dot(n, d);
            if (!(facing > 0)) return {};
            const double t = dot(n, from - l.at) / facing;
            if (!(t > 0)) return {};
            const Point in = from + t * d - l.at;
            const double nn = dot(n, n), u = dot(cross(in, l.edges[1]), n) / nn, v = dot(cross(l.edges[0], in), n) / nn;
            constexpr double slack = 1e-9;
            return u >= -slack && u <= 1 + slack && v >= -slack && v <= 1 + slack ? Meeting{l.power, t} : Meeting{};
        }
    }
    return {};
}

double Lights::density(const Light& l, const Point& from, const Point& d, double distance) const {
    if (l.kind == Kind::rectangle) {
        const double facing = -dot(cross(l.edges[0], l.edges[1]), d);  // the cosine, times the area
        return facing > 0 ? distance * distance / facing : 0;
    }
    if (l.kind == Kind::sphere && !outside(l, from)) return 0;
    return 1 / (2 * kPi * height_of(l, from));
}

Lights::Color Lights::met(const Ray& ray, double end, double chosen) const {
    Color sum;
    for (const Light& l : sampled_) {
        const Meeting m = meet(l, ray.origin, ray.direction);
        if (!(m.distance > 0) || (std::isfinite(end) && m.distance >= end)) continue;
        const double other = chosen > 0 ? density(l, ray.origin, ray.direction, m.distance) / double(sampled_.size()) : 0;
        sum += (chosen > 0 ? chosen * chosen / (chosen * chosen + other * other) : 1) * m.radiance;
    }
    return sum;
}

Lights::Color Lights::sky(const Point& direction) const {
    Color sum;
    for (const Light& l : skies_) sum += meet(l, {}, direction).radiance;
    return sum;
}

}  // namespace isoparm
