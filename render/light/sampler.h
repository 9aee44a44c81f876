// sampler.h -- where in a pixel, on a light, over a hemisphere the samples lie: Owen-scrambled Sobol' points in padded
// pairs of dimensions (Burley, Practical Hash-based Owen Scrambling, JCGT 2020; hash of Vegdahl 2021). A pure function
// of pixel, sample and dimension, so the picture depends neither on threads nor on which part of it is rendered.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "scalar/vec.h"

namespace isoparm {

namespace sampling {
inline std::uint32_t mixed(std::uint32_t x) {  // lowbias32, Wellons 2018
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}
inline std::uint32_t reversed_bits(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    return __builtin_bswap32(x);
}
/// Random bits in which each bit depends on the higher ones only.
inline std::uint32_t owen_scrambled(std::uint32_t x, std::uint32_t seed) {
    x = reversed_bits(x);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reversed_bits(x);
}
inline double unit(std::uint32_t x) { return x * 0x1p-32; }
}  // namespace sampling

class PixelSampler {
public:
    /// For `samples` samples of the pixel (x,y) of the whole picture.
    PixelSampler(int x, int y, int samples)
        : seed_(sampling::mixed(static_cast<std::uint32_t>(x) +
                                sampling::mixed(static_cast<std::uint32_t>(y) + 0x9e3779b9u))),
          bits_(std::max(1, static_cast<int>(std::bit_width(static_cast<std::uint32_t>(samples - 1))))) {}

    /// A point of [0,1)^2; over all samples those of one dimension fill the square evenly.
    Vec2 operator()(int sample, int dimension) const {
        using namespace sampling;
        const std::uint32_t seed = seed_of(dimension);
        const std::uint32_t i =
            owen_scrambled(static_cast<std::uint32_t>(sample) << (32 - bits_), seed) >> (32 - bits_);
        std::uint32_t y = 0;
        for (std::uint32_t k = i, v = 1u << 31; k; k >>= 1, v ^= v >> 1)
            if (k & 1) y ^= v;
        return {unit(owen_scrambled(reversed_bits(i), mixed(seed ^ 0x68bc21ebu))),
                unit(owen_scrambled(y, mixed(seed ^ 0x02e5be93u)))};
    }

    // For sample_points(), which does the same in vectors.
    std::uint32_t seed_of(int dimension) const { return sampling::mixed(seed_ + 0x85ebca6bu * static_cast<std::uint32_t>(dimension)); }
    int bits() const { return bits_; }

private:
    std::uint32_t seed_;
    int bits_;
};

/// Blackman-Harris reconstruction filter by importance sampling (Ernst, Stamminger and Greiner 2006): a sample's place
/// relative to the middle of its pixel is drawn from the filter, so all samples weigh the same and pixels need none of
/// their neighbours' samples.
class PixelFilter {
public:
    static constexpr double radius = 1.5;  // pixels
    PixelFilter() {
        // The inverse of the filter's integral, tabled: its ends are flat, so that the table is fine where it matters.
        std::array<double, kSteps + 1> integral{};
        for (int i = 1; i <= kSteps; ++i) {
            const double a = 2 * std::numbers::pi * (i - 0.5) / kSteps;
            integral[i] = integral[i - 1] + 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) -
                          0.01168 * std::cos(3 * a);
        }
        for (int k = 0, i = 1; k <= kSteps; ++k) {
            const double s = integral[kSteps] * k / kSteps;
            while (i < kSteps && integral[i] < s) ++i;
            const double t = (s - integral[i - 1]) / (integral[i] - integral[i - 1]);
            place_[k] = radius * (2 * (i - 1 + t) / kSteps - 1);
        }
    }
    /// Where in the picture, relative to the middle of the pixel, for a point of [0,1)^2.
    Vec2 operator()(const Vec2& s) const { return {place(s.x), place(s.y)}; }

private:
    double place(double s) const {
        const double x = s * kSteps;
        const int i = static_cast<int>(x);
        return place_[i] + (x - i) * (place_[i + 1] - place_[i]);
    }
    static constexpr int kSteps = 1024;
    std::array<double, kSteps + 1> place_{};
};

}  // namespace isoparm
