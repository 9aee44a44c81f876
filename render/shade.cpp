#include "shade.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isoparm {
namespace {

// Directions in the camera's frame (right, up, toward the viewer). A white sheet that faces the key light gets just
// about 1: kKey plus what the sky adds.
constexpr double kKeyFrom[3] = {-0.56, 0.60, 0.64}, kFillFrom[3] = {0.85, 0.10, 0.55};
constexpr double kKeyRadius = 0.13;  // tangent of the light's angular radius: soft shadows
const Color kKey{0.70, 0.685, 0.66}, kSkyTop{0.45, 0.47, 0.50}, kSkySide{0.29, 0.295, 0.305}, kGround{0.18, 0.17, 0.16},
    kFill{0.26, 0.26, 0.25};
constexpr double kBounce = 0.55;  // of the sky's light that comes back from what hides it
constexpr double kGloss = 0.24, kExponent = 72, kRim = 0.30;

Point in_frame(const Camera& c, const double (&d)[3]) {
    return normalized(d[0] * c.right + d[1] * c.up - d[2] * c.forward);
}

/// Two unit vectors that complete n to a frame (Duff et al., JCGT 2017).
std::array<Point, 2> frame(const Point& n) {
    const double s = std::copysign(1.0, n.z), a = -1 / (s + n.z), b = n.x * n.y * a;
    return {Point{1 + s * n.x * n.x * a, s * b, -s * n.x}, Point{b, s + n.y * n.y * a, -n.y}};
}

/// Square to disc, area preserving (Shirley and Chiu 1997).
Vec2 on_disc(const Vec2& s) {
    const double a = 2 * s.x - 1, b = 2 * s.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    const bool wide = std::fabs(a) > std::fabs(b);
    const double r = wide ? a : b,
                 phi = wide ? std::numbers::pi / 4 * (b / a) : std::numbers::pi / 2 - std::numbers::pi / 4 * (a / b);
    return {r * std::cos(phi), r * std::sin(phi)};
}

Color product(const Color& a, const Color& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
Color mixed(const Color& a, const Color& b, double t) { return (1 - t) * a + t * b; }
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
    const double fresnel = 0.04 + 0.96 * std::pow(1 - std::clamp(dot(h, view), 0.0, 1.0), 5);
    return kGloss * (0.8 + 4 * fresnel) * std::pow(std::max(0.0, dot(n, h)), kExponent);
}

}  // namespace

Lighting::Lighting(const Camera& camera)
    : up_(camera.up), key_(in_frame(camera, kKeyFrom)), fill_(in_frame(camera, kFillFrom)) {
    const auto [x, y] = frame(key_);
    key_x_ = x;
    key_y_ = y;
}

Color Lighting::sky(const Point& d) const {
    const double height = dot(d, up_), f = std::max(0.0, dot(d, fill_));
    const double t = height * height * (3 - 2 * std::fabs(height));
    return mixed(kSkySide, height > 0 ? kSkyTop : kGround, t) + (f * f) * kFill;
}

void Lighting::shade(const EmbreeScene& scene, const PixelSampler& sampler, const Surfel* surfels, int n,
                     Color* out) const {
    Ray to_key[EmbreeScene::packet], to_sky[EmbreeScene::packet];
    double key_light[EmbreeScene::packet], sky_light[EmbreeScene::packet];
    std::uint32_t lit = 0;
    for (int i = 0; i < n; ++i) {
        const Surfel& s = surfels[i];
        const Vec2 l = on_disc(sampler(s.sample, s.dimension));
        to_key[i] = {s.origin, normalized(key_ + (kKeyRadius * l.x) * key_x_ + (kKeyRadius * l.y) * key_y_)};
        if (dot(s.normal, to_key[i].direction) > 0) lit |= 1u << i;
        const Vec2 e = on_disc(sampler(s.sample, s.dimension + 1));  // cosine over the hemisphere (Malley)
        const auto [x, y] = frame(s.normal);
        to_sky[i] = {s.origin,
                     normalized(e.x * x + e.y * y + std::sqrt(std::max(0.0, 1 - e.x * e.x - e.y * e.y)) * s.normal)};
    }
    scene.transmittance(to_key, n, lit, key_light);
    scene.transmittance(to_sky, n, (1u << n) - 1, sky_light);

    for (int i = 0; i < n; ++i) {
        const Surfel& s = surfels[i];
        const double cosine = std::max(0.0, dot(s.normal, to_key[i].direction)), key = key_light[i];
        const Color ambient = sky(to_sky[i].direction);
        // What hides the sky is lit itself, and about as bright and coloured as what it hides it from.
        const Color bounced = (kBounce * (1 - sky_light[i])) * product(s.color, ambient);
        const Color diffuse = product(s.color, (cosine * key) * kKey + sky_light[i] * ambient + bounced);
        const double rim = kRim * std::pow(1 - std::clamp(dot(s.normal, s.view), 0.0, 1.0), 5) * sky_light[i];
        const double gloss = cosine > 0 ? key * highlight(s.normal, to_key[i].direction, s.view) : 0;
        const Color shiny = gloss * Color{1, 0.985, 0.96} + rim * ambient;
        out[i] = screened(below_white(diffuse), shiny);
    }
}

}  // namespace isoparm
