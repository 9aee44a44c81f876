#include "diff/ssim.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>

namespace isoparm {
namespace {

constexpr int kWindow = 2 * SsimMeter::radius + 1;

const std::array<double, kWindow>& window() {
    static const auto weights = [] {
        std::array<double, kWindow> w{};
        double sum = 0;
        for (int i = 0; i < kWindow; ++i) sum += w[static_cast<std::size_t>(i)] = std::exp(-(i - SsimMeter::radius) * (i - SsimMeter::radius) / (2 * 1.5 * 1.5));
        for (double& x : w) x /= sum;
        return w;
    }();
    return weights;
}

/// Of a, b, a a, b b and a b, weighted along x.
std::vector<double> moments(const float* a, const float* b, int n) {
    const auto& w = window();
    std::vector<double> m(5 * static_cast<std::size_t>(n));
    for (int k = 0; k < kWindow; ++k)
        for (int x = 0; x < n; ++x) {
            const double p = a[x + k], q = b[x + k], f = w[static_cast<std::size_t>(k)];
            double* to = &m[5 * static_cast<std::size_t>(x)];
            to[0] += f * p, to[1] += f * q, to[2] += f * p * p, to[3] += f * q * q, to[4] += f * p * q;
        }
    return m;
}

/// (Wang et al., eq. 13)
double similarity(const double* m) {
    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    const double ma = m[0], mb = m[1], va = m[2] - ma * ma, vb = m[3] - mb * mb, cov = m[4] - ma * mb;
    return (2 * ma * mb + c1) * (2 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
}

}  // namespace

void SsimMeter::add(const float* a, const float* b, int rows) {
    const int n = width_ - 2 * radius;
    if (n < 1) return;
    const std::size_t before = moments_.size();
    moments_.resize(before + static_cast<std::size_t>(rows));
    tbb::parallel_for(tbb::blocked_range<int>(0, rows), [&](const tbb::blocked_range<int>& range) {
        for (int r = range.begin(); r < range.end(); ++r) {
            const std::size_t at = static_cast<std::size_t>(r) * static_cast<std::size_t>(width_);
            moments_[before + static_cast<std::size_t>(r)] = moments(a + at, b + at, n);
        }
    });
    const int ready = static_cast<int>(moments_.size()) - kWindow + 1;
    if (ready < 1) {
        rows_ += rows;
        return;
    }
    std::vector<double> values(static_cast<std::size_t>(ready) * static_cast<std::size_t>(n));
    tbb::parallel_for(tbb::blocked_range<int>(0, ready), [&](const tbb::blocked_range<int>& range) {
        for (int r = range.begin(); r < range.end(); ++r) {
            std::vector<double> sum(5 * static_cast<std::size_t>(n));
            for (int k = 0; k < kWindow; ++k) {
                const double f = window()[static_cast<std::size_t>(k)];
                const auto& m = moments_[static_cast<std::size_t>(r + k)];
                for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += f * m[i];
            }
            for (int x = 0; x < n; ++x) values[static_cast<std::size_t>(r) * static_cast<std::size_t>(n) + static_cast<std::size_t>(x)] = similarity(&sum[5 * static_cast<std::size_t>(x)]);
        }
    });
    const int first = rows_ - static_cast<int>(before) + radius;  // the centre of the first whole window
    for (int r = 0; r < ready; ++r) sink_(first + r, &values[static_cast<std::size_t>(r) * static_cast<std::size_t>(n)]);
    moments_.erase(moments_.begin(), moments_.begin() + ready);
    rows_ += rows;
}

}  // namespace isoparm
