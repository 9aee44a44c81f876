#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "diff/diff.h"
#include "scene/suggest.h"

namespace isoparm {
namespace {

constexpr std::size_t kBins = std::size_t{1} << 15;
constexpr std::size_t kMostGroups = 10000;

std::size_t bin_of(double difference) { return std::bit_cast<std::uint32_t>(static_cast<float>(difference)) >> 16; }

bool matches(const std::string& pattern, const std::string& name) {
    if (!pattern.empty() && pattern.back() == '*') return name.compare(0, pattern.size() - 1, pattern, 0, pattern.size() - 1) == 0;
    return pattern == name;
}

int place_of(const std::vector<std::string>& names, const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

std::vector<std::string> missing(const std::vector<std::string>& from, const std::vector<std::string>& in) {
    std::vector<std::string> names;
    for (const std::string& n : from)
        if (place_of(in, n) < 0) names.push_back(n);
    return names;
}

std::string text_of(const ImageWindow& w) {
    return std::to_string(w.width) + " x " + std::to_string(w.height) + " at (" + std::to_string(w.x) + "," + std::to_string(w.y) + ")";
}

/// All halves as floats.
const std::vector<float>& half_values() {
    static const std::vector<float> table = [] {
        std::vector<float> t(65536);
        for (std::uint32_t h = 0; h < t.size(); ++h) {
            const std::uint32_t exponent = h >> 10 & 31, mantissa = h & 1023;
            float v = std::ldexp(static_cast<float>(exponent == 0 ? mantissa : mantissa + 1024), exponent == 0 ? -24 : static_cast<int>(exponent) - 25);
            if (exponent == 31) v = mantissa ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
            t[h] = h >> 15 ? -v : v;
        }
        return t;
    }();
    return table;
}
/// The same as below for halves: those that are positive have the order of their bits.
std::pair<bool, float> survey(const HalfBits* a, std::size_t n) {
    std::int16_t most = 0;
    std::uint16_t odd = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto bits = static_cast<std::int16_t>(a[i]);
        most = bits > most ? bits : most;
        odd = static_cast<std::uint16_t>(odd | ((a[i] & 0x7c00) == 0x7c00 ? 0xffff : 0));
    }
    return {odd == 0, half_values()[static_cast<std::uint16_t>(most)]};
}
double value_of(HalfBits h) { return half_values()[h]; }
double value_of(float x) { return x; }
double value_of(double x) { return x; }

/// Whether all are finite, and then the largest of them or 0; without waiting for one number before the next.
template <class T>
std::pair<bool, T> survey(const T* a, std::size_t n) {
    constexpr std::size_t lanes = 16;
    T most[lanes] = {}, test[lanes] = {};
    std::size_t i = 0;
    for (; i + lanes <= n; i += lanes)
        for (std::size_t k = 0; k < lanes; ++k) {
            most[k] = a[i + k] > most[k] ? a[i + k] : most[k];
            test[k] += a[i + k] * T(0);  // becomes NaN when one is not finite
        }
    for (; i < n; ++i) most[0] = a[i] > most[0] ? a[i] : most[0], test[0] += a[i] * T(0);
    for (std::size_t k = 1; k < lanes; ++k) most[0] = std::max(most[0], most[k]), test[0] += test[k];
    return {test[0] == 0, most[0]};
}

bool same_nonfinite(double a, double b) { return (std::isnan(a) && std::isnan(b)) || a == b; }

}  // namespace

double histogram_end(std::uint32_t bin) { return bin == 0 ? 0 : std::bit_cast<float>((bin << 16) | 0xffffu); }

double ChannelDiff::rms() const { return samples ? std::sqrt(squares / static_cast<double>(samples)) : 0; }
double ChannelDiff::psnr() const { return squares > 0 ? 20 * std::log10(peak / rms()) : std::numeric_limits<double>::infinity(); }

double ChannelDiff::percentile(double part) const {
    const double most = std::ceil(std::clamp(part, 0.0, 1.0) * static_cast<double>(samples));
    std::uint64_t below = 0;
    for (const auto& [bin, count] : histogram) {
        below += count;
        if (static_cast<double>(below) >= most) return std::min(histogram_end(bin), max);
    }
    return max;
}

std::vector<std::string> incomparable(const ImagePart& a, const ImagePart& b) {
    std::vector<std::string> why;
    if (a.data.width != b.data.width || a.data.height != b.data.height)
        why.push_back("size: found " + std::to_string(b.data.width) + " x " + std::to_string(b.data.height) + " pixels, expected " + std::to_string(a.data.width) + " x " + std::to_string(a.data.height));
    else if (!(a.data == b.data)) why.push_back("data window: found " + text_of(b.data) + ", expected " + text_of(a.data));
    if (!(a.display == b.display)) why.push_back("display window: found " + text_of(b.display) + ", expected " + text_of(a.display));
    if (const auto names = missing(a.channels, b.channels); !names.empty()) why.push_back("channels missing: " + listed(names));
    if (const auto names = missing(b.channels, a.channels); !names.empty()) why.push_back("channels that the reference lacks: " + listed(names));
    std::vector<std::string> sorted = a.channels;
    std::sort(sorted.begin(), sorted.end());
    if (a.channels.size() != b.channels.size() || std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
        if (why.empty()) why.push_back("channels: found two of one name");
    }
    if (const auto facts = missing(a.space, b.space); !facts.empty()) why.push_back("colour space: expected " + listed(facts) + ", found " + listed(missing(b.space, a.space)));
    else if (const auto more = missing(b.space, a.space); !more.empty()) why.push_back("colour space: found " + listed(more) + ", which the reference lacks");
    return why;
}

DiffMeter::DiffMeter(const ImagePart& a, const ImagePart& b, const DiffLimits& limits, const DiffMask& mask) : limits_(limits), mask_(mask) {
    diff_.name = a.name;
    diff_.window = a.data;
    channels_ = static_cast<int>(a.channels.size());
    for (int c = 0; c < channels_; ++c) {
        ChannelDiff d;
        d.name = a.channels[static_cast<std::size_t>(c)];
        d.in_a = c, d.in_b = place_of(b.channels, d.name);
        d.fail = limits.fail.value, d.warn = limits.warn.value;
        for (const auto& [pattern, value] : limits.channels)
            if (matches(pattern, d.name)) d.fail = d.warn = value;
        same_order_ = same_order_ && d.in_b == c;
        diff_.channels.push_back(std::move(d));
    }
    bins_.assign(diff_.channels.size(), std::vector<std::uint64_t>(kBins));
    patch_ = place_of(a.channels, "patch.I"), u_ = place_of(a.channels, "uv.U"), v_ = place_of(a.channels, "uv.V");
    if (u_ < 0 || v_ < 0) u_ = v_ = -1;
}

void DiffMeter::add_failure(std::size_t channel, double difference, const DiffSample& where, double patch, double u, double v) {
    const auto id = std::isfinite(patch) && std::fabs(patch) < 9e15 ? static_cast<std::int64_t>(patch) : std::int64_t{-1};
    const std::pair key{channel, id};
    auto found = groups_.find(key);
    if (found == groups_.end()) {
        if (groups_.size() >= kMostGroups) {
            ++diff_.patches_left_out;
            return;
        }
        found = groups_.emplace(key, PatchFailures{channel, id, 0, -1, {}, 0, 0}).first;
    }
    PatchFailures& g = found->second;
    ++g.pixels;
    if (difference > g.difference) g.difference = difference, g.worst = where, g.u = u, g.v = v;
}

/// Rows that are equal to the bit and finite need no look at each number's difference.
template <class T>
bool DiffMeter::add_equal_row(const T* a, const T* b) {
    if (!mask_.empty() || !same_order_) return false;
    const std::size_t n = static_cast<std::size_t>(diff_.window.width) * static_cast<std::size_t>(channels_);
    if (std::memcmp(a, b, n * sizeof(T)) != 0) return false;
    const auto [finite, largest] = survey(a, n);
    if (!finite) return false;
    for (int c = 0; c < channels_; ++c) {
        ChannelDiff& d = diff_.channels[static_cast<std::size_t>(c)];
        if (static_cast<double>(largest) > d.peak)
            for (std::size_t i = static_cast<std::size_t>(c); i < n; i += static_cast<std::size_t>(channels_)) d.peak = std::max(d.peak, value_of(a[i]));
    }
    count_equal_row();
    return true;
}

void DiffMeter::count_equal_row() {
    const auto width = static_cast<std::uint64_t>(diff_.window.width);
    for (std::size_t c = 0; c < diff_.channels.size(); ++c) diff_.channels[c].samples += width, bins_[c][0] += width;
    diff_.pixels += width;
}

template <class T>
void DiffMeter::add_pixel(const T* a, const T* b, int x) {
    bool fails = false, warns = false, odd = false;
    for (std::size_t c = 0; c < diff_.channels.size(); ++c) {
        ChannelDiff& d = diff_.channels[c];
        const double p = a[d.in_a], q = b[d.in_b];
        ++d.samples;
        double difference = std::fabs(q - p);
        if (!std::isfinite(p) || !std::isfinite(q)) {
            if (limits_.allow_nonfinite && same_nonfinite(p, q)) {
                ++bins_[c][0], ++d.allowed_nonfinite;
                continue;
            }
            if (d.nonfinite++ == 0) d.worst = {diff_.window.x + x, diff_.window.y + y_, p, q};
            difference = std::numeric_limits<double>::infinity();
            odd = true;
            ++bins_[c][kBins - 1];
        } else {
            d.peak = std::max({d.peak, p, q});
            ++bins_[c][bin_of(difference)];
            if (difference == 0) continue;
            d.sum += difference, d.squares += difference * difference;
            if (difference > d.max) {
                d.max = difference;
                if (d.nonfinite == 0) d.worst = {diff_.window.x + x, diff_.window.y + y_, p, q};
            }
        }
        ++d.differing;
        warns = warns || difference > d.warn;
        if (difference > d.fail) {
            fails = true;
            ++d.failing;
            if (patch_ >= 0) add_failure(c, difference, {diff_.window.x + x, diff_.window.y + y_, p, q}, a[patch_], u_ < 0 ? 0 : a[u_], v_ < 0 ? 0 : a[v_]);
        }
    }
    ++diff_.pixels;
    diff_.failing += fails, diff_.warning += warns, diff_.nonfinite += odd;
}

template <class T>
void DiffMeter::add_rows(const T* a, const T* b, int rows) {
    const std::size_t width = static_cast<std::size_t>(diff_.window.width), stride = width * static_cast<std::size_t>(channels_);
    for (int r = 0; r < rows; ++r, ++y_, a += stride, b += stride) {
        if (add_equal_row(a, b)) continue;
        for (std::size_t x = 0; x < width; ++x)
            if (mask_.empty() || mask_[static_cast<std::size_t>(y_) * width + x])
                add_pixel(a + x * static_cast<std::size_t>(channels_), b + x * static_cast<std::size_t>(channels_), static_cast<int>(x));
    }
}

void DiffMeter::add(const float* a, const float* b, int rows) { add_rows(a, b, rows); }
void DiffMeter::add(const double* a, const double* b, int rows) { add_rows(a, b, rows); }

void DiffMeter::add(const HalfBits* a, const HalfBits* b, int rows) {
    const std::size_t stride = static_cast<std::size_t>(diff_.window.width) * static_cast<std::size_t>(channels_);
    const std::vector<float>& value = half_values();
    for (int r = 0; r < rows; ++r, a += stride, b += stride) {
        if (add_equal_row(a, b)) {
            ++y_;
            continue;
        }
        for (auto& row : row_) row.resize(stride);
        for (std::size_t i = 0; i < stride; ++i) row_[0][i] = value[a[i]], row_[1][i] = value[b[i]];
        add_rows(row_[0].data(), row_[1].data(), 1);
    }
}

PartDiff DiffMeter::result() const {
    PartDiff all = diff_;
    for (std::size_t c = 0; c < bins_.size(); ++c)
        for (std::uint32_t bin = 0; bin < kBins; ++bin)
            if (bins_[c][bin] > 0) all.channels[c].histogram.emplace_back(bin, bins_[c][bin]);
    for (const auto& [key, group] : groups_) all.patches.push_back(group);
    std::stable_sort(all.patches.begin(), all.patches.end(), [](const PatchFailures& p, const PatchFailures& q) { return p.channel != q.channel ? p.channel < q.channel : p.pixels > q.pixels; });
    return all;
}

DiffVerdict judge(const std::vector<PartDiff>& parts, const DiffLimits& limits) {
    bool fails = false, warns = false;
    for (const PartDiff& p : parts) {
        const auto exceeds = [&](std::uint64_t pixels, const DiffTier& t) {
            double most = 0;
            for (const ChannelDiff& c : p.channels) most = std::max(most, c.max);
            return static_cast<double>(pixels) > t.percent / 100 * static_cast<double>(p.pixels) || most > t.hard;
        };
        fails = fails || p.nonfinite > 0 || exceeds(p.failing, limits.fail);
        warns = warns || exceeds(p.warning, limits.warn);
    }
    return fails ? DiffVerdict::fail : warns ? DiffVerdict::warn : DiffVerdict::pass;
}

}  // namespace isoparm
