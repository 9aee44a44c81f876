#include "light/facet_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "light/ggx.h"
#include "light/sampler.h"

namespace isoparm {
namespace {

constexpr int kSteps = 32, kRoughSteps = 64, kSamples = 1024;

/// What comes back on average when facets are chosen as they are seen: the part of them that is not hidden from where it goes.
double integrated(double roughness, double cosine) {
    const double alpha = width_of_facets(roughness), z = std::max(cosine, 1e-3);
    const Point out{std::sqrt(1 - z * z), 0, z};
    const PixelSampler sampler(0, 0, kSamples);
    double sum = 0;
    for (int i = 0; i < kSamples; ++i) {
        const Point h = seen_facet(out, alpha, sampler(i, 0)), in = 2 * dot(out, h) * h - out;
        if (in.z > 0) sum += (1 + lambda(out, alpha)) / (1 + lambda(out, alpha) + lambda(in, alpha));
    }
    return sum / kSamples;
}

struct Table {
    std::array<std::array<double, kSteps + 1>, kRoughSteps + 1> albedo{};  // [roughness][root of the cosine]: most happens where it is small
    std::array<double, kRoughSteps + 1> mean{};
    Table() {
        for (int r = 0; r <= kRoughSteps; ++r) {
            for (int c = 0; c <= kSteps; ++c) albedo[r][c] = std::min(1.0, integrated(double(r) / kRoughSteps, double(c * c) / (kSteps * kSteps)));
            for (int c = 0; c < kSteps; ++c) {  // 2 x dx = 4 s^3 ds, times a + b s, over each step of the root s
                const double s0 = double(c) / kSteps, s1 = double(c + 1) / kSteps, b = (albedo[r][c + 1] - albedo[r][c]) * kSteps, a = albedo[r][c] - b * s0;
                mean[r] += a * (std::pow(s1, 4) - std::pow(s0, 4)) + 0.8 * b * (std::pow(s1, 5) - std::pow(s0, 5));
            }
        }
    }
};
const Table& table() {
    static const Table made;
    return made;
}

/// Where x of [0,1] lies in the table: the step, and how far in it.
struct Place {
    int step;
    double rest;
    Place(double x, int steps) : step(std::clamp(static_cast<int>(x * steps), 0, steps - 1)), rest(std::clamp(x * steps - step, 0.0, 1.0)) {}
    double between(double a, double b) const { return a + rest * (b - a); }
};

}  // namespace

double facet_albedo(double roughness, double cosine) {
    const Place r(roughness, kRoughSteps), c(std::sqrt(std::max(cosine, 0.0)), kSteps);
    const auto of = [&](int row) { return c.between(table().albedo[row][c.step], table().albedo[row][c.step + 1]); };
    return r.between(of(r.step), of(r.step + 1));
}
double mean_facet_albedo(double roughness) {
    const Place r(roughness, kRoughSteps);
    return r.between(table().mean[r.step], table().mean[r.step + 1]);
}

}  // namespace isoparm
