// diff.h -- how two images differ: numbers of every channel, pixel by pixel, from blocks of rows.
//
// A difference is |b - a| of the numbers as the files hold them (whole numbers as fractions of their largest, 32-bit integers as they are),
// in double. A pixel fails when a channel of it differs by more than that channel's limit; -0 equals +0; what is no finite number in either
// image fails beyond all percentages, unless `allow_nonfinite` and both hold the same. Sums go row by row: results do not depend on how the
// rows come in blocks. Pure functions and values; no files.
#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "image/image_decoder.h"

namespace isoparm {

/// As idiff has them: X is exceeded by a difference above it, P percent by a larger part of the pixels.
struct DiffTier {
    double value = 1e-6, percent = 0, hard = std::numeric_limits<double>::infinity();
};
struct DiffLimits {
    DiffTier fail, warn;
    std::vector<std::pair<std::string, double>> channels;  // name, or beginning and *: the value of `fail` and `warn` for it
    bool allow_nonfinite = false;
    std::optional<double> flip, rms, ssim;                 // the mean FLIP and the RMS may reach; the SSIM must reach
};

struct DiffSample {
    int x = 0, y = 0;  // from the display window's corner, as in the file
    double a = 0, b = 0;
};

/// One channel of one part.
struct ChannelDiff {
    std::string name;
    double fail = 0, warn = 0;  // its own limits
    int in_a = 0, in_b = 0;     // its place in either file
    std::uint64_t samples = 0, differing = 0, failing = 0, nonfinite = 0;  // nonfinite: and fails
    std::uint64_t allowed_nonfinite = 0;                                   // the same in both, and allowed
    double sum = 0, squares = 0, max = 0, peak = 1;                        // of finite differences; the largest value in either image, or 1
    DiffSample worst;                                                      // the first that is not finite, or the largest
    /// Samples by the upper 15 of the 31 bits of their difference as a float (0: none, or below 1e-38), in order; those that there are.
    std::vector<std::pair<std::uint32_t, std::uint64_t>> histogram;

    double mean() const { return samples ? sum / static_cast<double>(samples) : 0; }
    double rms() const;
    /// 20 log10(peak / RMS); infinite for equal channels.
    double psnr() const;
    /// At most that part of the samples (0 to 1) differ by more; to 0.8 % of itself, rounded up, at most `max`.
    double percentile(double part) const;
};

/// Failing pixels of a channel that show the same patch: the numbers of "patch.I", "uv.U" and "uv.V" in the reference.
struct PatchFailures {
    std::size_t channel = 0;
    std::int64_t patch = 0;
    std::uint64_t pixels = 0;
    double difference = 0;
    DiffSample worst;
    double u = 0, v = 0;
};

struct PartDiff {
    std::string name;
    ImageWindow window;
    std::uint64_t pixels = 0, failing = 0, warning = 0, nonfinite = 0;  // those compared; pixels that ...
    std::vector<ChannelDiff> channels;                                  // in the order of the reference
    std::vector<PatchFailures> patches;                                 // by channel, then by number of pixels
    std::uint64_t patches_left_out = 0;                                 // failing samples of more than 10000 groups
};

/// A half float as it is stored: 1 bit of sign, 5 of exponent, 10 of mantissa.
using HalfBits = std::uint16_t;

/// The pixels that count; empty: all.
using DiffMask = std::vector<bool>;

/// What keeps two parts from being compared, one sentence each; nothing when they can be.
std::vector<std::string> incomparable(const ImagePart& a, const ImagePart& b);

class DiffMeter {
public:
    /// The parts are comparable. `mask` must live as long.
    DiffMeter(const ImagePart& a, const ImagePart& b, const DiffLimits& limits, const DiffMask& mask);
    /// The next rows of both, channels interleaved in each file's own order.
    void add(const float* a, const float* b, int rows);
    void add(const double* a, const double* b, int rows);
    void add(const HalfBits* a, const HalfBits* b, int rows);
    int rows_added() const { return y_; }
    /// Complete when all rows have been added.
    PartDiff result() const;

private:
    template <class T> void add_rows(const T* a, const T* b, int rows);
    template <class T> bool add_equal_row(const T* a, const T* b);
    void count_equal_row();
    template <class T> void add_pixel(const T* a, const T* b, int x);
    void add_failure(std::size_t channel, double difference, const DiffSample& where, double patch, double u, double v);
    PartDiff diff_;
    const DiffLimits& limits_;
    const DiffMask& mask_;
    int y_ = 0, channels_ = 0;
    bool same_order_ = true;
    std::vector<float> row_[2];  // of halves
    int patch_ = -1, u_ = -1, v_ = -1;  // places in a, where there are such channels
    std::map<std::pair<std::size_t, std::int64_t>, PatchFailures> groups_;
    std::vector<std::vector<std::uint64_t>> bins_;  // histograms, by channel
};

/// The end of the differences in a bin of a histogram.
double histogram_end(std::uint32_t bin);

/// From the best to the worst; `missing`: one of two images is not there, which fails.
enum class DiffVerdict { pass, warn, missing, fail, not_comparable, unreadable };
/// What the limits say of all parts together, the flip, rms and ssim limits left out.
DiffVerdict judge(const std::vector<PartDiff>& parts, const DiffLimits& limits);

}  // namespace isoparm
