#include "light/bsdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/facet_albedo.h"
#include "light/ggx.h"
#include "light/local_frame.h"

namespace isoparm {
namespace {

using Color = Bsdf::Color;
constexpr double kPi = std::numbers::pi;

double max_of(const Color& c) { return std::max({c.x, c.y, c.z}); }

Color schlick(const Color& at_right_angles, double cosine) {
    const double rest = std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5);
    return (1 - rest) * at_right_angles + rest * Color{1, 1, 1};
}

constexpr double kLeastLost = 2e-3;  // what smoother metals lose is left out: it is at grazing angles only, where it would be found by few samples of great weight

/// Of samples: as much as single reflections give back, for metals; `coat_share` for others.
double share_of_facets(const Material& m, double coat_share, const Point& out) {
    if (m.kind != Material::Kind::metal) return coat_share;
    return 1 - mean_facet_albedo(m.roughness) < kLeastLost ? 1 : facet_albedo(m.roughness, out.z);
}

}  // namespace

double fresnel(double cosine, double ior) {
    const double c = std::clamp(cosine, 0.0, 1.0), refracted = 1 - (1 - c * c) / (ior * ior);
    if (refracted <= 0) return 1;
    const double t = std::sqrt(refracted), s = (c - ior * t) / (c + ior * t), p = (ior * c - t) / (ior * c + t);
    return 0.5 * (s * s + p * p);
}

double pane_fresnel(double cosine, double ior) {
    const double one = fresnel(cosine, ior);
    return 2 * one / (1 + one);
}

double mean_fresnel(double n) {  // Walsh 1926, as in Duntley, The Optical Properties of Diffusing Materials, JOSA 32, 1942
    const double n2 = n * n, n4 = n2 * n2;
    return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) + n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
           2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) + 8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
}

Bsdf::Bsdf(const Material& material, const Color& color, bool inside)
    : material_(material), color_(color), inside_(inside), alpha_(std::max(1e-3, material.roughness * material.roughness)) {
    if (material.kind == Material::Kind::metal) coat_share_ = 1;
    if (material.kind == Material::Kind::plastic) {
        const double mean = mean_fresnel(material.ior), coat = mean + 0.1, base = 0.9 * max_of(color);
        coat_share_ = coat / (coat + base);
        entering_ = 1 - mean;
    }
}

Color Bsdf::coat(const Point& out, const Point& in) const {
    if (material_.kind == Material::Kind::diffuse) return {};
    const Point h = normalized(out + in);
    const double c = dot(out, h);
    const double shape = facets(h, alpha_) / ((1 + lambda(out, alpha_) + lambda(in, alpha_)) * 4 * out.z);  // the cosine of `in` cancels
    return material_.kind == Material::Kind::metal ? shape * schlick(color_, c) + between_facets(out, in) : (shape * fresnel(c, material_.ior)) * Color{1, 1, 1};
}

/// What a metal's facets throw at each other before it leaves: as much as single reflections lack, the same for all pairs of directions but for how
/// much each lacks (Kulla and Conty, Revisiting Physically Based Shading at Imageworks, SIGGRAPH 2017 course).
Color Bsdf::between_facets(const Point& out, const Point& in) const {
    const double mean = mean_facet_albedo(material_.roughness), lost = 1 - mean;
    if (lost < kLeastLost) return {};
    const double shape = (1 - facet_albedo(material_.roughness, out.z)) * (1 - facet_albedo(material_.roughness, in.z)) / (kPi * lost) * in.z;
    const auto one = [&](double at_right_angles) {
        const double f = at_right_angles + (1 - at_right_angles) / 21;  // Schlick's approximation on average over the cosine
        return f * f * mean / (1 - f * lost);
    };
    return shape * Color{one(color_.x), one(color_.y), one(color_.z)};
}

Color Bsdf::base(const Point& out, const Point& in) const {
    if (material_.kind == Material::Kind::metal) return {};
    if (material_.kind == Material::Kind::diffuse) return (in.z / kPi) * color_;
    // What enters through the coat, is scattered below it, partly thrown back by the coat from below, and leaves: (1 - f(out)) (1 - f(in)) / n^2 c / (1 - k c) of a base of
    // albedo c under a coat that throws back k = 1 - (1 - mean) / n^2. The base is such that of what enters the colour comes out again: c / (1 - k c) = colour / (1 - k).
    const double through = (1 - fresnel(out.z, material_.ior)) * (1 - fresnel(in.z, material_.ior)) / entering_;
    return (through * in.z / kPi) * color_;
}

Color Bsdf::value(const Point& out, const Point& in) const {
    if (specular() || out.z <= 0 || in.z <= 0) return {};
    return coat(out, in) + base(out, in);
}

Color Bsdf::spread(const Point& out, const Point& in) const { return specular() || out.z <= 0 || in.z <= 0 ? Color{} : base(out, in); }

double Bsdf::coat_density(const Point& out, const Point& in) const {
    const Point h = normalized(out + in);
    return facets(h, alpha_) * seen(out, alpha_) / (4 * out.z);
}

double Bsdf::density(const Point& out, const Point& in) const {
    if (specular() || out.z <= 0 || in.z <= 0) return 0;
    const double share = share_of_facets(material_, coat_share_, out);
    return (share > 0 ? share * coat_density(out, in) : 0) + (1 - share) * in.z / kPi;
}

Bsdf::Sample Bsdf::sample(const Point& out, double lobe, const Vec2& s) const {
    if (out.z <= 0) return {};
    if (specular()) return refracted(out, lobe);
    Sample r;
    if (lobe < share_of_facets(material_, coat_share_, out)) {
        const Point h = seen_facet(out, alpha_, s);
        r.direction = 2 * dot(out, h) * h - out;
    } else {
        r.direction = on_hemisphere(s);
        r.spread = material_.kind != Material::Kind::metal;
    }
    r.density = density(out, r.direction);
    if (r.direction.z <= 0 || !(r.density > 0)) return {};
    r.weight = value(out, r.direction) / r.density;
    return r;
}

Bsdf::Sample Bsdf::refracted(const Point& out, double lobe) const {
    const double ior = material_.thin ? material_.ior : inside_ ? 1 / material_.ior : material_.ior;
    const double reflected = material_.thin ? pane_fresnel(out.z, ior) : fresnel(out.z, ior);
    if (lobe < reflected) return mirrored(out);
    Sample r;
    r.density = 1;
    if (material_.thin) {
        r.direction = -out;
        r.weight = color_;
    } else {
        const double c = std::sqrt(std::max(0.0, 1 - (1 - out.z * out.z) / (ior * ior)));
        r.direction = {-out.x / ior, -out.y / ior, -c};
        // Each way through the border takes half of the colour, so that a body shows it once. Radiance is not scaled by the square of
        // the index: light is followed to where it leaves the body again.
        r.weight = {std::sqrt(color_.x), std::sqrt(color_.y), std::sqrt(color_.z)};
    }
    return r;
}

}  // namespace isoparm
