#include "light/lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>


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

/// Over the radiance, of a disc of the sky with that sine of half its width, whose middle is at that cosine from the normal; partly below the horizon too
/// (Snyder, Area light sources for real-time graphics, 1996, as in Lagarde and de Rousiers, Moving Frostbite to PBR, 2014).
double irradiance_of_disc(double cosine, double sine_of_width) {
    const double s2 = std::min(1.0, sine_of_width * sine_of_width);
    if (cosine > 0 && cosine * cosine >= s2) return kPi * s2 * cosine;
    if (cosine * cosine >= s2) return 0;
    const double sine = std::sqrt(1 - cosine * cosine), x = std::sqrt(1 / s2 - 1), y = std::clamp(-x * cosine / sine, -1.0, 1.0), rest = sine * std::sqrt(1 - y * y);
    return std::max(0.0, (cosine * std::acos(y) - x * rest) * s2 + std::atan2(rest, x));
}

/// Likewise, of a rectangle whose corner is at `corner` from there: Lambert's formula for what of it is above the horizon.
double irradiance_of_rectangle(const Point& corner, const std::array<Point, 2>& edges, const Point& up) {
    const Point all[] = {corner, corner + edges[0], corner + edges[0] + edges[1], corner + edges[1]};
    std::vector<Point> above;
    for (int i = 0; i < 4; ++i) {
        const Point &a = all[i], &b = all[(i + 1) % 4];
        const double ha = dot(a, up), hb = dot(b, up);
        if (ha >= 0) above.push_back(a);
        if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) above.push_back(a + (ha / (ha - hb)) * (b - a));
    }
    double sum = 0;
    for (std::size_t i = 0; i < above.size(); ++i) {
        const Point &a = above[i], &b = above[(i + 1) % above.size()], n = cross(a, b);
        const double across = length(n);
        if (across > 0) sum += std::atan2(across, dot(a, b)) * dot(n, up) / across;
    }
    return 0.5 * std::fabs(sum);
}

}  // namespace

Point Lights::Lamp::to_image(const Point& d) const {
    const Point p = frame.to_local(d);
    return {std::cos(turn) * p.x + std::sin(turn) * p.y, std::cos(turn) * p.y - std::sin(turn) * p.x, p.z};
}
Point Lights::Lamp::from_image(const Point& p) const {
    return normalized(frame.to_world({std::cos(turn) * p.x - std::sin(turn) * p.y, std::sin(turn) * p.x + std::cos(turn) * p.y, p.z}));
}

Lights::Lights(const std::vector<Light>& lights, const Camera& camera, const EnvironmentImages& images) : studio_(camera) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Lamp l{lights[i], i < images.size() ? images[i] : nullptr, LocalFrame(lights[i].direction)};
        if (l.image) {
            sampled_.push_back(l);
            continue;
        }
        if (l.kind == Kind::studio || l.kind == Kind::environment) skies_.push_back(l);
        if (l.kind == Kind::studio) {
            Lamp key = l;
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

Lights::Sample Lights::sample(const Lamp& l, const Point& from, const Vec2& s) const {
    Sample r;
    r.distance = kFar;
    if (l.image) {
        const EnvironmentImage::Sample found = l.image->sample(s);
        if (!(found.density > 0)) return {};
        r.direction = l.from_image(found.direction);
        r.density = found.density;
        const Color radiance = l.image->radiance(found.direction);
        r.radiance = product(l.power, radiance) / r.density;
        r.sky = l.image->sky_part(radiance);
        return r;
    }
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

Lights::Meeting Lights::meet(const Lamp& l, const Point& from, const Point& d) const {
    switch (l.kind) {
        case Kind::studio:
            return {product(l.power, studio_.sky(d)), kFar};
        case Kind::environment:
            return {l.image ? product(l.power, l.image->radiance(l.to_image(d))) : l.power, kFar};
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

double Lights::density(const Lamp& l, const Point& from, const Point& d, double distance) const {
    if (l.image) return l.image->density(l.to_image(d));
    if (l.kind == Kind::rectangle) {
        const double facing = -dot(cross(l.edges[0], l.edges[1]), d);  // the cosine, times the area
        return facing > 0 ? distance * distance / facing : 0;
    }
    if (l.kind == Kind::sphere && !outside(l, from)) return 0;
    return 1 / (2 * kPi * height_of(l, from));
}

Lights::Color Lights::met(const Ray& ray, double end, double chosen, bool sky) const {
    Color sum;
    for (const Lamp& l : sampled_) {
        if (sky && !l.image) continue;
        Meeting m = meet(l, ray.origin, ray.direction);
        if (l.image) {
            const double part = l.image->sky_part(l.image->radiance(l.to_image(ray.direction)));
            m.radiance = (sky ? part : 1 - part) * m.radiance;
        }
        if (!(m.distance > 0) || (std::isfinite(end) && m.distance >= end)) continue;
        const double other = chosen > 0 ? density(l, ray.origin, ray.direction, m.distance) / double(sampled_.size()) : 0;
        sum += (chosen > 0 ? chosen * chosen / (chosen * chosen + other * other) : 1) * m.radiance;
    }
    return sum;
}

Lights::Color Lights::sky(const Point& direction) const {
    Color sum;
    for (const Lamp& l : skies_) sum += meet(l, {}, direction).radiance;
    return sum;
}

Lights::Color Lights::behind(const Ray& ray, double chosen) const {
    Color sum;
    for (const Lamp& l : sampled_) {
        if (!l.image) continue;
        const double other = density(l, ray.origin, ray.direction, kFar) / double(sampled_.size());
        sum += (chosen * chosen / (chosen * chosen + other * other)) * meet(l, ray.origin, ray.direction).radiance;
    }
    return sum;
}

std::optional<Lights::Color> Lights::backdrop(const Point& direction) const {
    std::optional<Color> sum;
    for (const auto* const lights : {&skies_, &sampled_})
        for (const Lamp& l : *lights)
            if (l.kind == Kind::environment && l.seen) sum = sum.value_or(Color{}) + meet(l, {}, direction).radiance;
    return sum;
}

Lights::Color Lights::irradiance(const Point& at, const Point& up) const {
    Color sum;
    for (const Lamp& l : sampled_) {
        if (l.image) continue;
        if (l.kind == Kind::rectangle) {
            if (dot(cross(l.edges[0], l.edges[1]), at - l.at) > 0) sum += irradiance_of_rectangle(l.at - at, l.edges, up) * l.power;
        } else if (l.kind == Kind::directional) {
            const double sine = std::sin(l.radius);
            sum += (l.radius == 0 ? std::max(0.0, dot(up, l.direction)) : irradiance_of_disc(dot(up, l.direction), sine) / (kPi * sine * sine)) * l.power;
        } else if (outside(l, at)) {
            sum += irradiance_of_disc(dot(up, normalized(l.at - at)), l.radius / distance(l.at, at)) * l.power;
        }
    }
    return sum;
}

Lights::Color Lights::sky_irradiance(const Point& up) const {
    constexpr int kSteps = 256;
    const LocalFrame frame(up);
    Color sum;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) {
            const Point d = frame.to_world(on_hemisphere({(i + 0.5) / kSteps, (k + 0.5) / kSteps}));
            sum += sky(d);
        }
    sum = (kPi / (double(kSteps) * kSteps)) * sum;
    for (const Lamp& l : sampled_) {  // as they are sampled: narrow suns count
        if (!l.image) continue;
        Color of_image;
        for (int i = 0; i < 4 * kSteps; ++i)
            for (int k = 0; k < 4 * kSteps; ++k) {
                const Sample s = sample(l, {}, {(i + 0.5) / (4 * kSteps), (k + 0.5) / (4 * kSteps)});
                if (s.density > 0) of_image += std::max(0.0, dot(up, s.direction)) * s.radiance;
            }
        sum += of_image / (16.0 * kSteps * kSteps);
    }
    return sum;
}

}  // namespace isoparm
