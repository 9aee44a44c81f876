#include "shade.h"

#include <algorithm>
#include <cmath>

#include "traced_scene.h"

namespace isoparm {
namespace {

constexpr double kBounce = 0.55;  // of the sky's light that comes back from what hides it
constexpr double kGloss = 0.24, kRim = 0.30;

double fifth(double x) { return x * x * (x * x) * x; }  // pow() is slow, and not the same everywhere

/// a and b together, never more than white.
Color screened(const Color& a, const Color& b) {
    const auto one = [](double x, double y) { return x + std::min(y, 1.0) * (1 - x); };
    return {one(a.x, b.x), one(a.y, b.y), one(a.z, b.z)};
}

/// The identity up to kShoulder, then bending toward 1, which it never reaches.
Color below_white(const Color& c) {
    constexpr double kShoulder = 0.8, kRest = 1 - kShoulder;
    const auto one = [](double x) { return x <= kShoulder ? x : 1 - kRest * kRest / (x - kShoulder + kRest); };
    return {one(c.x), one(c.y), one(c.z)};
}

double highlight(const Point& n, const Point& light, const Point& view) {
    const Point h = normalized(light + view);
    const double fresnel = 0.04 + 0.96 * fifth(1 - std::clamp(dot(h, view), 0.0, 1.0));
    const double c = std::max(0.0, dot(n, h)), c2 = c * c, c4 = c2 * c2, c8 = c4 * c4, c16 = c8 * c8, c32 = c16 * c16;
    return kGloss * (0.8 + 4 * fresnel) * (c32 * c32 * c8);  // the power of 72
}

}  // namespace

FigureLighting::FigureLighting(const Camera& camera, const std::optional<Ground>& ground) : studio_(camera), key_(studio_.key) {
    if (!ground) return;
    constexpr int kSteps = 128;
    const LocalFrame frame(ground->up);
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) sky_on_ground_ += (1.0 / (kSteps * kSteps)) * studio_.sky(frame.to_world(on_hemisphere({(i + 0.5) / kSteps, (k + 0.5) / kSteps})));
}

void FigureLighting::shade(const TracedScene& scene, const Surfel* surfels, int n, Color* out) const {
    Ray to_key[EmbreeScene::packet], to_sky[EmbreeScene::packet];
    double key_light[EmbreeScene::packet], sky_light[EmbreeScene::packet];
    std::uint32_t lit = 0;
    SampleOf of[EmbreeScene::packet];
    int dimension[2][EmbreeScene::packet] = {};
    Vec2 at_key[EmbreeScene::packet], at_sky[EmbreeScene::packet];
    for (int i = 0; i < n; ++i) of[i] = surfels[i].sample, dimension[0][i] = surfels[i].dimension, dimension[1][i] = surfels[i].dimension + 1;
    sample_points(of, dimension[0], n, at_key);
    sample_points(of, dimension[1], n, at_sky);
    for (int i = 0; i < n; ++i) {
        const Surfel& s = surfels[i];
        const Vec2 l = on_disc(at_key[i]);
        to_key[i] = {s.origin, normalized(studio_.key + (Studio::key_radius * l.x) * key_.x + (Studio::key_radius * l.y) * key_.y)};
        if (dot(s.normal, to_key[i].direction) > 0) lit |= 1u << i;
        to_sky[i] = {s.origin, normalized(LocalFrame(s.normal).to_world(on_hemisphere(at_sky[i])))};
    }
    scene.embree->transmittance(to_key, n, lit, key_light);
    scene.embree->transmittance(to_sky, n, (1u << n) - 1, sky_light);

    for (int i = 0; i < n; ++i) {
        const Surfel& s = surfels[i];
        const double cosine = std::max(0.0, dot(s.normal, to_key[i].direction)), key = key_light[i];
        const Color ambient = studio_.sky(to_sky[i].direction);
        if (s.ground) {
            // The key light through the middle of its disc, so that the sum has no noise where there is no shadow.
            const double middle = std::max(0.0, dot(s.normal, studio_.key));
            const Color all = middle * Studio::key_light + sky_on_ground_, lacks = (middle * (1 - key) * (lit >> i & 1)) * Studio::key_light + ((1 - kBounce) * (1 - sky_light[i])) * ambient;
            out[i] = {-lacks.x / all.x, -lacks.y / all.y, -lacks.z / all.z};
            continue;
        }
        // What hides the sky is lit itself, and about as bright and coloured as what it hides it from.
        const Color bounced = (kBounce * (1 - sky_light[i])) * product(s.color, ambient);
        const Color diffuse = product(s.color, (cosine * key) * Studio::key_light + sky_light[i] * ambient + bounced);
        const double rim = kRim * fifth(1 - std::clamp(dot(s.normal, s.view), 0.0, 1.0)) * sky_light[i];
        const double gloss = cosine > 0 ? key * highlight(s.normal, to_key[i].direction, s.view) : 0;
        const Color shiny = gloss * Color{1, 0.985, 0.96} + rim * ambient;
        out[i] = screened(below_white(diffuse), shiny);
    }
}

}  // namespace isoparm
