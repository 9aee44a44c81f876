#include "diff/flip.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace isoparm {
namespace {

// ---- colours (2020, section 4.1) ------------------------------------------------------------------------------------

struct Rgb {
    float r, g, b;
};
struct Triple {  // XYZ, Y Cx Cz, or L*a*b*
    float x, y, z;
};

// Linear sRGB to XYZ, as the ratios that the primaries and D65 give; and its inverse. White is where R = G = B = 1.
constexpr double kXyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                               {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                               {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
constexpr float kRgb[3][3] = {{3.241003275f, -1.537398934f, -0.498615861f}, {-0.969224334f, 1.875930071f, 0.041554224f}, {0.055639423f, -0.204011202f, 1.057148933f}};
constexpr float kWhite[3] = {0.950428545f, 1.0f, 1.088900371f};
constexpr float kBlack[3] = {1.052156925f, 1.0f, 0.918357670f};  // 1 / white

Triple xyz_over_white(const Rgb& c) {
    const auto row = [&](int i) { return (static_cast<float>(kXyz[i][0]) * c.r + static_cast<float>(kXyz[i][1]) * c.g + static_cast<float>(kXyz[i][2]) * c.b) * kBlack[i]; };
    return {row(0), row(1), row(2)};
}
Triple ycxcz(const Rgb& c) {
    const Triple t = xyz_over_white(c);
    return {116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)};
}
/// Clamped to what a display can show.
Rgb rgb_of_ycxcz(const Triple& t) {
    const float y = (t.x + 16) / 116, x = (y + t.y / 500) * kWhite[0], z = (y - t.z / 200) * kWhite[2];
    const auto row = [&](int i) { return std::clamp(kRgb[i][0] * x + kRgb[i][1] * y + kRgb[i][2] * z, 0.0f, 1.0f); };
    return {row(0), row(1), row(2)};
}
/// L*a*b*, with a* and b* weaker where it is dark (Hunt).
Triple hunt_lab(const Rgb& c) {
    constexpr float delta = 6.0f / 29;
    const auto root = [](float t) { return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29; };
    const Triple t = xyz_over_white(c);
    const float x = root(t.x), y = root(t.y), z = root(t.z), l = 116 * y - 16;
    return {l, 0.01f * l * 500 * (x - y), 0.01f * l * 200 * (y - z)};
}
float length(float x, float y) { return std::sqrt(x * x + y * y); }
/// (2020, eq. 3) Kept between lightness and the plane of colours.
float hyab(const Triple& p, const Triple& q) { return std::fabs(p.x - q.x) + length(p.y - q.y, p.z - q.z); }

constexpr float kColor = 0.7f, kFeature = 0.5f;  // exponents qc and qf
float largest_color_error() {
    static const float most = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColor);
    return most;
}
/// To [0,1]; the lower 0.4 of all errors take 0.95 of it (2020, section 4.1.3).
float redistributed(float error) {
    const float most = largest_color_error(), knee = 0.4f * most;
    return error < knee ? 0.95f / knee * error : 0.95f + (error - knee) / (most - knee) * 0.05f;
}

/// ACES as fitted by Narkowicz, with the exposure of 0.6 taken into its coefficients (2021, section 4).
constexpr double kAces[6] = {0.6 * 0.6 * 2.51, 0.6 * 0.03, 0, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14};
float tone_mapped(float x) {
    const double y = std::max(x, 0.0f), below = (kAces[3] * y + kAces[4]) * y + kAces[5];
    return std::isinf(below) ? 1.0f : static_cast<float>(std::clamp(((kAces[0] * y + kAces[1]) * y + kAces[2]) / below, 0.0, 1.0));
}

// ---- filters --------------------------------------------------------------------------------------------------------

using Taps = std::vector<float>;  // from -radius to radius

Taps taps(int radius, const auto& f) {
    std::vector<double> exact;
    for (int i = -radius; i <= radius; ++i) exact.push_back(f(static_cast<double>(i)));
    return {exact.begin(), exact.end()};
}
double total(const Taps& t) {
    double sum = 0;
    for (const float w : t) sum += w;
    return sum;
}

/// Contrast sensitivity as sums of Gaussians a sqrt(pi/b) exp(-pi^2 r^2 / b), r in degrees, each the product of one along x and one
/// along y (2020, table 1); detectors of edges and points as first and second derivatives of a Gaussian along x (section 4.2).
struct Filters {
    int radius, feature_radius;
    Taps achromatic, red_green, blue_yellow[2];  // the weights of the two are in their taps along y
    Taps blue_yellow_down[2];
    Taps gauss, edge, point;

    explicit Filters(double ppd) {
        constexpr double pi = 3.14159265358979323846;
        radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
        const auto bell = [&](double b) { return taps(radius, [=](double i) { return std::exp(-pi * pi * (i / ppd) * (i / ppd) / b); }); };
        achromatic = normalized(bell(0.0047));
        red_green = normalized(bell(0.0053));
        double sum = 0;
        const double a[2] = {34.1, 13.5}, b[2] = {0.04, 0.025};
        for (int k = 0; k < 2; ++k) {
            blue_yellow[k] = bell(b[k]);
            sum += a[k] * std::sqrt(pi / b[k]) * total(blue_yellow[k]) * total(blue_yellow[k]);
        }
        for (int k = 0; k < 2; ++k) {
            blue_yellow_down[k] = blue_yellow[k];
            for (float& w : blue_yellow_down[k]) w = static_cast<float>(w * a[k] * std::sqrt(pi / b[k]) / sum);
        }
        const double s = 0.5 * 0.082 * ppd;
        feature_radius = static_cast<int>(std::ceil(3 * s));
        const auto g = [=](double i) { return std::exp(-i * i / (2 * s * s)); };
        gauss = normalized(taps(feature_radius, g));
        edge = balanced(taps(feature_radius, [=](double i) { return -i * g(i); }));
        point = balanced(taps(feature_radius, [=](double i) { return (i * i / (s * s) - 1) * g(i); }));
    }
    static Taps normalized(Taps t) {
        const double sum = total(t);
        for (float& w : t) w = static_cast<float>(w / sum);
        return t;
    }
    /// Positive weights sum to 1, negative ones to -1.
    static Taps balanced(Taps t) {
        double plus = 0, minus = 0;
        for (const float w : t) (w > 0 ? plus : minus) += w;
        for (float& w : t) w = static_cast<float>(w > 0 ? w / plus : w < 0 ? -w / minus : 0.0);
        return t;
    }
    int reach() const { return std::max(radius, feature_radius); }
};

/// A part of an image with as many more pixels around it as filters reach.
struct Plane {
    int width = 0, height = 0;
    std::vector<float> values;
    Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    float* row(int y) { return &values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width)]; }
    const float* row(int y) const { return &values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width)]; }
};

void add_weighted(float* to, const float* from, float w, int n) {
    for (int i = 0; i < n; ++i) to[i] += w * from[i];
}
/// Along x; the result is narrower by `margin` on both sides, at least the taps' reach.
Plane across(const Plane& p, const Taps& t, int margin) {
    const int r = static_cast<int>(t.size() / 2);
    Plane out(p.width - 2 * margin, p.height);
    for (int y = 0; y < p.height; ++y)
        for (int k = -r; k <= r; ++k) add_weighted(out.row(y), p.row(y) + margin + k, t[static_cast<std::size_t>(k + r)], out.width);
    return out;
}
/// Along y, added to `out`, which is lower by `margin` at both ends.
void down(const Plane& p, const Taps& t, int margin, Plane& out) {
    const int r = static_cast<int>(t.size() / 2);
    for (int y = 0; y < out.height; ++y)
        for (int k = -r; k <= r; ++k) add_weighted(out.row(y), p.row(y + margin + k), t[static_cast<std::size_t>(k + r)], out.width);
}
Plane filtered(const Plane& p, const Taps& x, const Taps& y, int margin) {
    Plane out(p.width - 2 * margin, p.height - 2 * margin);
    down(across(p, x, margin), y, margin, out);
    return out;
}

/// What is left of a picture's part after the eye: colours, and how strong edges and points are.
struct Seen {
    std::vector<Triple> color;
    std::vector<float> edge, point;
};

std::vector<float> strength(const Plane& lightness, const Taps& detector, const Filters& f) {
    const Plane x = filtered(lightness, detector, f.gauss, f.reach()), y = filtered(lightness, f.gauss, detector, f.reach());
    std::vector<float> s(x.values.size());
    for (std::size_t i = 0; i < s.size(); ++i) s[i] = length(x.values[i], y.values[i]);
    return s;
}

Seen see(const std::vector<Rgb>& pixels, int width, int height, const Filters& f) {
    Plane planes[3] = {{width, height}, {width, height}, {width, height}};
    Plane lightness(width, height);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Triple t = ycxcz(pixels[i]);
        planes[0].values[i] = t.x, planes[1].values[i] = t.y, planes[2].values[i] = t.z;
        lightness.values[i] = (t.x + 16) / 116;
    }
    const int m = f.reach();
    const Plane a = filtered(planes[0], f.achromatic, f.achromatic, m), rg = filtered(planes[1], f.red_green, f.red_green, m);
    Plane by = filtered(planes[2], f.blue_yellow[0], f.blue_yellow_down[0], m);
    down(across(planes[2], f.blue_yellow[1], m), f.blue_yellow_down[1], m, by);
    Seen s;
    for (std::size_t i = 0; i < a.values.size(); ++i) s.color.push_back(hunt_lab(rgb_of_ycxcz({a.values[i], rg.values[i], by.values[i]})));
    s.edge = strength(lightness, f.edge, f), s.point = strength(lightness, f.point, f);
    return s;
}

float error_between(const Seen& a, const Seen& b, std::size_t i) {
    const float color = redistributed(std::pow(hyab(a.color[i], b.color[i]), kColor));
    const float feature = std::max(std::fabs(a.edge[i] - b.edge[i]), std::fabs(a.point[i] - b.point[i]));
    return std::pow(color, 1 - std::pow(std::min(feature / std::sqrt(2.0f), 1.0f), kFeature));
}

constexpr int kTile = 128, kBand = 64;

}  // namespace

void choose_exposures(double largest, double median, FlipOptions& o) {
    o.hdr = true;
    o.start = o.stop = 0, o.exposures = 2;
    if (!(largest > 0)) return;
    const double a = kAces[0] - 0.85 * kAces[3], b = kAces[1] - 0.85 * kAces[4], c = kAces[2] - 0.85 * kAces[5];
    const double half = -0.5 * b / a, x = half + std::sqrt(half * half - c / a);  // which the tone mapper takes to 0.85
    o.start = std::log2(x / largest);
    o.stop = std::log2(x / std::max(median, largest * 0x1p-60));
    o.exposures = static_cast<int>(std::clamp(std::ceil(o.stop - o.start), 2.0, 64.0));
}

LuminanceMeter::LuminanceMeter() : counts_(std::size_t{1} << 24) {}

void LuminanceMeter::add(const float* rgb, std::size_t pixels) {
    for (std::size_t i = 0; i < pixels; ++i, rgb += 3) {
        float y = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
        if (!(y > 0) || std::isinf(y)) y = 0;
        largest_ = std::max(largest_, static_cast<double>(y));
        ++counts_[std::bit_cast<std::uint32_t>(y) >> 7];
    }
    total_ += pixels;
}

double LuminanceMeter::median() const {
    const auto at = [&](std::uint64_t rank) {  // from 0
        std::uint64_t below = 0;
        for (std::size_t bin = 0; bin < counts_.size(); ++bin)
            if ((below += counts_[bin]) > rank) return bin == 0 ? 0.0 : 0.5 * (static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bin) << 7)) + static_cast<double>(std::bit_cast<float>((static_cast<std::uint32_t>(bin) << 7) | 127u)));
        return 0.0;
    };
    return total_ == 0 ? 0 : 0.5 * (at((total_ - 1) / 2) + at(total_ / 2));
}

struct FlipMeter::Work {
    int width, height;
    FlipOptions options;
    Sink sink;
    Filters filters;
    int first = 0, have = 0, done = 0;           // rows [first, have) are held; those before `done` are known
    std::vector<float> pixels[2];                // the held rows of both
    std::vector<float> band;

    Work(int w, int h, const FlipOptions& o, Sink s) : width(w), height(h), options(o), sink(std::move(s)), filters(o.pixels_per_degree), band(static_cast<std::size_t>(w) * kBand) {}

    const float* pixel(int which, int x, int y) const {
        const std::size_t row = static_cast<std::size_t>(std::clamp(y, 0, height - 1) - first);
        return &pixels[which][3 * (row * static_cast<std::size_t>(width) + static_cast<std::size_t>(std::clamp(x, 0, width - 1)))];
    }
    bool equal(int x0, int x1, int y0, int y1) const {
        x0 = std::max(x0, 0), x1 = std::min(x1, width), y0 = std::max(y0, 0), y1 = std::min(y1, height);
        for (int y = y0; y < y1; ++y)
            if (std::memcmp(pixel(0, x0, y), pixel(1, x0, y), sizeof(float) * 3 * static_cast<std::size_t>(x1 - x0)) != 0) return false;
        return true;
    }
    std::vector<Rgb> shown(int which, int x0, int x1, int y0, int y1, double exposure) const {
        std::vector<Rgb> r;
        r.reserve(static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0));
        const auto scale = static_cast<float>(std::exp2(exposure));
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                const float* p = pixel(which, x, y);
                if (options.hdr) r.push_back({tone_mapped(scale * p[0]), tone_mapped(scale * p[1]), tone_mapped(scale * p[2])});
                else r.push_back({std::clamp(p[0], 0.0f, 1.0f), std::clamp(p[1], 0.0f, 1.0f), std::clamp(p[2], 0.0f, 1.0f)});
            }
        return r;
    }
    /// Columns [x0, x1) of rows [done, y1) into the band.
    void tile(int x0, int x1, int y1) {
        const int m = filters.reach(), w = x1 - x0 + 2 * m, h = y1 - done + 2 * m;
        for (int y = done; y < y1; ++y) std::fill_n(&band[static_cast<std::size_t>(y - done) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x0)], x1 - x0, 0.0f);
        if (equal(x0 - m, x1 + m, done - m, y1 + m)) return;
        for (int e = 0; e < (options.hdr ? options.exposures : 1); ++e) {
            const double exposure = options.hdr ? options.start + e * (options.stop - options.start) / std::max(options.exposures - 1, 1) : 0;
            const Seen a = see(shown(0, x0 - m, x1 + m, done - m, y1 + m, exposure), w, h, filters);
            const Seen b = see(shown(1, x0 - m, x1 + m, done - m, y1 + m, exposure), w, h, filters);
            std::size_t i = 0;
            for (int y = done; y < y1; ++y)
                for (int x = x0; x < x1; ++x, ++i) {
                    float& most = band[static_cast<std::size_t>(y - done) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
                    most = std::max(most, error_between(a, b, i));
                }
        }
    }
    /// The next band, when all the rows that it needs are there.
    bool advance() {
        const int m = filters.reach(), end = std::min(done + kBand, height);
        if (done >= height || have < std::min(end + m, height)) return false;
        const int tiles = (width + kTile - 1) / kTile;
        tbb::parallel_for(tbb::blocked_range<int>(0, tiles), [&](const tbb::blocked_range<int>& range) {
            for (int t = range.begin(); t < range.end(); ++t) tile(t * kTile, std::min((t + 1) * kTile, width), end);
        });
        for (int y = done; y < end; ++y) sink(y, &band[static_cast<std::size_t>(y - done) * static_cast<std::size_t>(width)]);
        done = end;
        const int keep = std::max(done - m, 0);
        for (auto& p : pixels) p.erase(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(3) * (keep - first) * width);
        first = keep;
        return true;
    }
};

FlipMeter::FlipMeter(int width, int height, const FlipOptions& options, Sink sink) : work_(std::make_unique<Work>(width, height, options, std::move(sink))) {}
FlipMeter::~FlipMeter() = default;

void FlipMeter::add(const float* reference, const float* test, int rows) {
    const std::size_t row = 3 * static_cast<std::size_t>(work_->width);
    for (int r = 0; r < rows;) {
        const int n = std::min(rows - r, kBand);
        work_->pixels[0].insert(work_->pixels[0].end(), reference + row * static_cast<std::size_t>(r), reference + row * static_cast<std::size_t>(r + n));
        work_->pixels[1].insert(work_->pixels[1].end(), test + row * static_cast<std::size_t>(r), test + row * static_cast<std::size_t>(r + n));
        work_->have += n, r += n;
        while (work_->advance()) {}
    }
}

}  // namespace isoparm
