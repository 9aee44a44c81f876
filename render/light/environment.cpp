#include "light/environment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

#include "error.h"
#include "image/image_colors.h"
#include "image/image_decoder.h"

namespace isoparm {
namespace {

constexpr double kEven = 0.1;  // of samples, in proportion to all radiance
constexpr double kPi = std::numbers::pi;
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 25;  // 8192 x 4096
constexpr float kMostRadiance = 1e12f;

/// The step of a cumulative list in which x of [0,1) falls, none of them empty, and where in it.
std::pair<int, double> step_of(const double* cumulative, int steps, double x) {
    const double* const at = std::upper_bound(cumulative, cumulative + steps + 1, x * cumulative[steps]);
    int i = std::clamp(static_cast<int>(at - cumulative) - 1, 0, steps - 1);
    while (i > 0 && !(cumulative[i + 1] > cumulative[i])) --i;
    const double wide = cumulative[i + 1] - cumulative[i];
    return {i, wide > 0 ? std::clamp((x * cumulative[steps] - cumulative[i]) / wide, 0.0, 1.0) : 0.5};
}

/// Where in [0,1] a density that goes from a to b in a straight line has so much of it behind.
double on_slope(double a, double b, double part) {
    if (!(a + b > 0)) return part;
    return std::min(1.0, part * (a + b) / (a + std::sqrt(a * a + part * (b * b - a * a))));
}

}  // namespace

EnvironmentImage::EnvironmentImage(int width, int height, std::vector<float> rgb) : width_(width), height_(height), rgb_(std::move(rgb)) {
    const auto sum_of = [&](auto value) {
        double sum = 0;
        for (int y = 0; y < height_; ++y) {
            double row = 0;
            for (int x = 0; x < width_; ++x) row += value(grey(x, y));
            sum += row * (std::cos(kPi * y / height_) - std::cos(kPi * (y + 1) / height_));
        }
        return sum;
    };
    const double all = sum_of([](double g) { return g; });
    mean_ = all / (2 * width_), brightest_sky_ = 16 * mean_;
    if (const double above = sum_of([&](double g) { return std::max(0.0, g - mean_); }); above > 1e-9 * all) even_ = kEven / all, bright_ = (1 - kEven) / above;
    const auto across = static_cast<std::size_t>(width_), rows = static_cast<std::size_t>(height_) + 1;
    row_.assign(rows + 1, 0);
    in_row_.assign((across + 1) * rows, 0);
    for (int y = 0; y <= height_; ++y) {
        double* const sums = &in_row_[(across + 1) * static_cast<std::size_t>(y)];
        for (int x = 0; x < width_; ++x) {
            const Cell c = cell(x, y);
            sums[x + 1] = sums[x] + 0.25 * (c.w00 + c.w10 + c.w01 + c.w11);
        }
        row_[static_cast<std::size_t>(y) + 1] = row_[static_cast<std::size_t>(y)] + sums[width_] * (row_top(y) - row_top(y + 1));
        if (sums[width_] > 0)
            for (int x = 0; x <= width_; ++x) sums[x] /= sums[width_];
    }
    total_ = row_.back();
    if (total_ > 0)
        for (double& r : row_) r /= total_;
}

double EnvironmentImage::row_top(int row) const { return std::cos(kPi * std::clamp(row - 0.5, 0.0, double(height_)) / height_); }

double EnvironmentImage::grey(int x, int y) const {
    const float* c = &rgb_[3 * (static_cast<std::size_t>(std::clamp(y, 0, height_ - 1)) * static_cast<std::size_t>(width_) + static_cast<std::size_t>((x + width_) % width_))];
    return (static_cast<double>(c[0]) + static_cast<double>(c[1]) + static_cast<double>(c[2])) / 3;
}
double EnvironmentImage::weight(int x, int y) const {
    const double g = grey(x, y);
    return even_ * g + bright_ * std::max(0.0, g - mean_);
}
/// Right of the middle of column x, below that of row - 1.
EnvironmentImage::Cell EnvironmentImage::cell(int x, int row) const { return {weight(x, row - 1), weight(x + 1, row - 1), weight(x, row), weight(x + 1, row)}; }

Vec2 EnvironmentImage::place(const Point& d) const {
    return {width_ * (0.5 - std::atan2(d.y, d.x) / (2 * kPi)), height_ * std::acos(std::clamp(d.z, -1.0, 1.0)) / kPi};
}

Vec3<double> EnvironmentImage::radiance(const Point& direction) const {
    const Vec2 p = place(direction);
    const double u = p.x - 0.5, v = p.y - 0.5, x0 = std::floor(u), y0 = std::floor(v), fx = u - x0, fy = v - y0;
    Vec3<double> sum;
    for (const int dy : {0, 1})
        for (const int dx : {0, 1}) {
            const int x = (static_cast<int>(x0) + dx + width_) % width_, y = std::clamp(static_cast<int>(y0) + dy, 0, height_ - 1);
            const float* c = &rgb_[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x))];
            sum += ((dx ? fx : 1 - fx) * (dy ? fy : 1 - fy)) * Vec3<double>{c[0], c[1], c[2]};
        }
    return sum;
}

double EnvironmentImage::sky_part(const Vec3<double>& c) const {
    const double grey = (c.x + c.y + c.z) / 3;
    return grey > brightest_sky_ ? brightest_sky_ / grey : 1;
}

EnvironmentImage::Sample EnvironmentImage::sample(const Vec2& s) const {
    if (!(total_ > 0)) return {};
    const auto [row, sy] = step_of(row_.data(), height_ + 1, s.y);
    const auto [x, sx] = step_of(&in_row_[(static_cast<std::size_t>(width_) + 1) * static_cast<std::size_t>(row)], width_, s.x);
    const Cell c = cell(x, row);
    const double fy = on_slope(c.w00 + c.w10, c.w01 + c.w11, sy), left = c.w00 + fy * (c.w01 - c.w00), right = c.w10 + fy * (c.w11 - c.w10), fx = on_slope(left, right, sx);
    const double z = row_top(row) + fy * (row_top(row + 1) - row_top(row)), r = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * kPi * (0.5 - (x + 0.5 + fx) / width_);
    return {{r * std::cos(phi), r * std::sin(phi), z}, (left + fx * (right - left)) * width_ / (2 * kPi * total_)};
}

double EnvironmentImage::density(const Point& direction) const {
    if (!(total_ > 0)) return 0;
    const Vec2 p = place(direction);
    const double u = p.x - 0.5, x = std::floor(u), fx = u - x, z = std::clamp(direction.z, -1.0, 1.0);
    const int row = std::clamp(static_cast<int>(p.y + 0.5), 0, height_);
    const double fy = std::clamp((row_top(row) - z) / (row_top(row) - row_top(row + 1)), 0.0, 1.0);
    const Cell c = cell(static_cast<int>(x), row);
    const double left = c.w00 + fy * (c.w01 - c.w00), right = c.w10 + fy * (c.w11 - c.w10);
    return (left + fx * (right - left)) * width_ / (2 * kPi * total_);
}

std::shared_ptr<const EnvironmentImage> load_environment(const std::string& path) {
    const auto fail = [&](const std::string& what) { throw Error(ErrorKind::input, path + ": " + what); };
    ImageLimits limits;
    limits.pixels = kMostPixels;
    ImageDecoder file(path, limits);
    file.open();
    const ImagePart& part = file.parts().front();
    const int width = part.data.width, height = part.data.height;
    if (width != 2 * height) fail("found an image of " + std::to_string(width) + " x " + std::to_string(height) + " pixels, expected one that is twice as wide as high: all directions by longitude and latitude");
    const ImageColors colors(part);
    if (!colors.any()) fail("found no colours in the image, expected the channels R, G and B, or Y");
    const int rows = std::min(height, file.most_rows(0));
    file.begin(0, rows, RowKind::floats);
    std::vector<float> rgb, some;
    rgb.reserve(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int first = 0, k = 0; first < height; first += rows, ++k) {
        const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(std::min(rows, height - first));
        colors.linear(static_cast<const float*>(file.block(k)), pixels, some);
        rgb.insert(rgb.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(3 * pixels));
    }
    for (const float c : rgb)
        if (!(c >= 0 && c <= kMostRadiance)) fail("found the value " + to_text(static_cast<double>(c)) + " in the image, expected radiances from 0 to 1e12");
    return std::make_shared<const EnvironmentImage>(width, height, std::move(rgb));
}

EnvironmentImages load_environments(const std::vector<Light>& lights) {
    EnvironmentImages images;
    // Kept, for the frames of a film: the decoder's process is to be forked before there are threads.
    static std::mutex mutex;
    static std::map<std::string, std::shared_ptr<const EnvironmentImage>> known;
    const std::lock_guard lock(mutex);
    for (const Light& l : lights) {
        auto& image = known[l.image];
        if (!image && !l.image.empty()) try {
                image = load_environment(l.image);
            } catch (const Error& e) {
                throw Error(e.kind(), (l.place.empty() ? "" : l.place + ": ") + e.what());
            }
        images.push_back(image);
    }
    return images;
}

}  // namespace isoparm
