#include "picture/curvature_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "picture/color_map.h"

namespace isoparm {
namespace {

/// Oklab to linear sRGB (B. Ottosson 2020), cut to the gamut.
Color from_oklab(double L, double a, double b) {
    const double l = std::pow(L + 0.3963377774 * a + 0.2158037573 * b, 3), m = std::pow(L - 0.1055613458 * a - 0.0638541728 * b, 3),
                 s = std::pow(L - 0.0894841775 * a - 1.2914855480 * b, 3);
    const auto cut = [](double x) { return std::clamp(x, 0.0, 1.0); };
    return {cut(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s), cut(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            cut(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

std::vector<double> samples(const Composite& patches, const std::vector<char>& flipped, ColorBy::What what) {
    std::vector<double> values;
    const int n = std::clamp(int(2000 / std::sqrt(double(patches.size()) * 2000)), 3, 40);
    for (std::size_t k = 0; k < patches.size(); ++k) {
        const Patch& p = patches[k].patch;
        const Rect r = p.rect();
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const double x = (i + 0.5) / n, y = (j + 0.5) / n;
                if (p.domain() == Domain::triangle && x + y > 1) continue;
                const double value = curvature_of(p, {r.u0 + x * (r.u1 - r.u0), r.v0 + y * (r.v1 - r.v0)}, what, k < flipped.size() && flipped[k]);
                if (std::isfinite(value)) values.push_back(value);
            }
    }
    std::sort(values.begin(), values.end());
    return values;
}

}  // namespace

Color diverging(double x) {
    constexpr double kLight = 0.965, kDark = 0.44, kChroma = 0.15, kBlue = 258, kOrange = 55;  // hues in degrees
    const double s = std::min(1.0, std::fabs(x)), hue = (x < 0 ? kBlue : kOrange) * std::numbers::pi / 180;
    const double chroma = kChroma * std::min(1.0, 1.6 * s) * (1 - 0.28 * s);  // colourful soon, not beyond what a screen has
    return from_oklab(kLight + s * (kDark - kLight), chroma * std::cos(hue), chroma * std::sin(hue));
}

double rounded_up(double x) {
    const double power = std::pow(10, std::floor(std::log10(x)));
    for (const double digit : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
        if (digit * power >= x * (1 - 1e-9)) return digit * power;
    return 10 * power;
}

Color ColorScale::color(double value) const {
    return two_sided() ? diverging(value / std::max(-low, high)) : viridis((value - low) / (high - low));
}

double curvature_of(const Patch& patch, const Vec2& at, ColorBy::What what, bool flipped) {
    const SurfacePoint e = evaluate(patch, at.x, at.y);
    if (!e.gaussian || !e.mean) return NAN;
    const double K = *e.gaussian, H = flipped ? -*e.mean : *e.mean, root = std::sqrt(std::max(0.0, H * H - K));
    switch (what) {
        case ColorBy::What::gaussian: return K;
        case ColorBy::What::mean: return H;
        case ColorBy::What::k1: return H + root;
        default: return H - root;
    }
}

/// The diagonal of a box about samples of the patches; 1 when they are a point.
double size_of(const Composite& patches) {
    Bounds all{patches.front().patch.point(patches.front().patch.rect().u0, patches.front().patch.rect().v0), {}};
    all.high = all.low;
    for (const Member& m : patches) {
        const Rect r = m.patch.rect();
        for (int i = 0; i <= 4; ++i)
            for (int j = 0; j <= (m.patch.domain() == Domain::quad ? 4 : 4 - i); ++j) {
                const Point p = m.patch.point(r.u0 + (r.u1 - r.u0) * i / 4, r.v0 + (r.v1 - r.v0) * j / 4);
                if (finite(p)) all = united(all, {p, p});
            }
    }
    const double size = all.diagonal();
    return size > 0 && std::isfinite(size) ? size : 1;
}

ColorScale settled(const ColorBy& by, const Composite& patches, const std::vector<char>& flipped) {
    ColorScale scale;
    scale.by = by;
    if (!by.curvature()) return scale;
    const auto values = samples(patches, flipped, by.what);
    if (by.range) {
        scale.low = (*by.range)[0], scale.high = (*by.range)[1];
    } else if (!values.empty()) {
        const std::size_t tail = values.size() / 50;
        const double low = values[tail], high = values[values.size() - 1 - tail], most = std::max(std::fabs(low), std::fabs(high));
        // What is flat but for rounding, for its size, gets no colours of its own.
        const double size = size_of(patches), top = most * size > 1e-9 && size > 0 ? rounded_up(most) : by.what == ColorBy::What::gaussian ? 1 / (size * size) : 1 / size;
        const bool about_zero = by.what == ColorBy::What::gaussian || by.what == ColorBy::What::mean || (low < 0 && high > 0);
        scale.low = about_zero || high <= 0 ? -top : 0, scale.high = about_zero || high > 0 ? top : 0;
    }
    if (!values.empty()) {
        const double rounding = 1e-9 * (scale.high - scale.low);
        scale.below = values.front() < scale.low - rounding, scale.above = values.back() > scale.high + rounding;
    }
    return scale;
}

bool in_dark_stripe(const ColorBy& by, const Point& normal, const Point& ray, const Camera& camera) {
    double angle;
    if (by.what == ColorBy::What::reflection) {
        const Point axis = by.direction ? normalized(*by.direction) : camera.right;
        const Point seen = ray - (2 * dot(ray, normal)) * normal;
        // Any two directions that complete the axis to a frame: the lamps are evenly spaced all around.
        const Point x = normalized(cross(axis, std::fabs(dot(axis, camera.up)) < 0.9 ? camera.up : camera.forward)), y = cross(axis, x);
        angle = std::atan2(dot(seen, y), dot(seen, x));
    } else {
        const Point light = by.direction ? normalized(*by.direction) : camera.up;
        angle = std::acos(std::clamp(dot(normal, light), -1.0, 1.0));
    }
    const double turn = by.stripes * angle / (2 * std::numbers::pi);
    return turn - std::floor(turn) < 0.5;
}

}  // namespace isoparm
