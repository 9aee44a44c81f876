#include "facet_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ggx.h"
#include "sampler.h"

namespace isoparm {
namespace {

constexpr int kSteps = 32, kSamples = 512;

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
    std::array<std::array<double, kSteps + 1>, kSteps + 1> albedo{};  // [roughness][cosine]
    std::array<double, kSteps + 1> mean{};
    Table() {
        for (int r = 0; r <= kSteps; ++r) {
            for (int c = 0; c <= kSteps; ++c) albedo[r][c] = std::min(1.0, integrated(double(r) / kSteps, double(c) / kSteps));
            for (int c = 0; c < kSteps; ++c) {  // 2 x (a + b x) over each step
                const double x0 = double(c) / kSteps, x1 = double(c + 1) / kSteps, a = albedo[r][c], b = albedo[r][c + 1];
                mean[r] += (x1 - x0) / 3 * (a * (2 * x0 + x1) + b * (x0 + 2 * x1));
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
    explicit Place(double x) : step(std::clamp(static_cast<int>(x * kSteps), 0, kSteps - 1)), rest(std::clamp(x * kSteps - step, 0.0, 1.0)) {}
    double between(double a, double b) const { return a + rest * (b - a); }
};

}  // namespace

double facet_albedo(double roughness, double cosine) {
    const Place r(roughness), c(cosine);
    const auto of = [&](int row) { return c.between(table().albedo[row][c.step], table().albedo[row][c.step + 1]); };
    return r.between(of(r.step), of(r.step + 1));
}
double mean_facet_albedo(double roughness) {
    const Place r(roughness);
    return r.between(table().mean[r.step], table().mean[r.step + 1]);
}

}  // namespace isoparm
