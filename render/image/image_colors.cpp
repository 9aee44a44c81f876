#include "image/image_colors.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

float linear_from_display(float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); }
float display_from_linear(float c) {
    c = std::clamp(c, 0.0f, 1.0f);
    return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
}

/// Files of bytes hold few different numbers: those are not worked out again and again.
float linear_from_byte(float c) {
    static const std::vector<float> table = [] {
        std::vector<float> t;
        for (int i = 0; i < 256; ++i) t.push_back(linear_from_display(static_cast<float>(i) / 255.0f));
        return t;
    }();
    const float scaled = c * 255.0f;
    const int i = static_cast<int>(scaled + 0.5f);
    return i >= 0 && i < 256 && std::fabs(scaled - static_cast<float>(i)) < 1e-4f ? table[static_cast<std::size_t>(i)] : linear_from_display(c);
}

}  // namespace

ImageColors::ImageColors(const ImagePart& part) : channels_(static_cast<int>(part.channels.size())), encoded_(part.integers) {
    const auto find = [&](const char* name) {
        const auto at = std::find(part.channels.begin(), part.channels.end(), name);
        return at == part.channels.end() ? -1 : static_cast<int>(at - part.channels.begin());
    };
    red_ = find("R"), green_ = find("G"), blue_ = find("B");
    if (red_ < 0 || green_ < 0 || blue_ < 0) red_ = green_ = blue_ = find("Y");
}

template <class T>
static void pick(const T* rows, std::size_t pixels, int channels, const int (&at)[3], bool encoded, std::vector<float>& rgb) {
    rgb.resize(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i, rows += channels)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto c = static_cast<float>(rows[at[k]]);
            rgb[3 * i + k] = encoded ? linear_from_byte(c) : c;
        }
}

void ImageColors::linear(const void* rows, bool doubles, std::size_t pixels, std::vector<float>& rgb) const {
    const int at[3] = {std::max(red_, 0), std::max(green_, 0), std::max(blue_, 0)};
    if (doubles) pick(static_cast<const double*>(rows), pixels, channels_, at, encoded_, rgb);
    else pick(static_cast<const float*>(rows), pixels, channels_, at, encoded_, rgb);
}
void ImageColors::linear(const float* rows, std::size_t pixels, std::vector<float>& rgb) const { linear(rows, false, pixels, rgb); }

void ImageColors::luma(const float* rows, std::size_t pixels, std::vector<float>& y) const {
    y.resize(pixels);
    const auto sent = [&](float c) { return encoded_ ? c : display_from_linear(c); };
    for (std::size_t i = 0; i < pixels; ++i, rows += channels_)
        y[i] = red_ == green_ ? sent(rows[std::max(red_, 0)]) : 0.299f * sent(rows[red_]) + 0.587f * sent(rows[green_]) + 0.114f * sent(rows[blue_]);
}

}  // namespace isoparm
