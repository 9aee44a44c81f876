#include "picture/contact_sheet.h"

#include <algorithm>
#include <cmath>

namespace isoparm {

namespace {
Image blank(int width, int height) {
    Image image{width, height, {}};
    image.pixels.assign(4 * static_cast<std::size_t>(width) * height, 1.0f);
    return image;
}

/// Mean over the rectangle [x0,x1] x [y0,y1] in pixels, borders counted by what lies inside.
void mean(const Image& image, double x0, double x1, double y0, double y1, float* out) {
    double sum[4] = {}, area = 0;
    for (int y = static_cast<int>(y0); y < std::min<double>(image.height, std::ceil(y1)); ++y) {
        const double h = std::min<double>(y + 1, y1) - std::max<double>(y, y0);
        for (int x = static_cast<int>(x0); x < std::min<double>(image.width, std::ceil(x1)); ++x) {
            const double a = h * (std::min<double>(x + 1, x1) - std::max<double>(x, x0));
            for (int c = 0; c < 4; ++c) sum[c] += a * image.at(x, y)[c];
            area += a;
        }
    }
    for (int c = 0; c < 4; ++c) out[c] = static_cast<float>(sum[c] / area);
}
}  // namespace

Image thumbnail(const Image& image, int width, int height) {
    const double scale = std::min({1.0, static_cast<double>(width) / image.width, static_cast<double>(height) / image.height});
    Image small = blank(std::max(1, static_cast<int>(std::lround(scale * image.width))), std::max(1, static_cast<int>(std::lround(scale * image.height))));
    const double dx = static_cast<double>(image.width) / small.width, dy = static_cast<double>(image.height) / small.height;
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) mean(image, x * dx, (x + 1) * dx, y * dy, (y + 1) * dy, small.at(x, y));
    return small;
}

Image contact_sheet(const std::vector<Image>& thumbnails, int cell_width, int cell_height) {
    constexpr int margin = 12;
    const int count = std::max(1, static_cast<int>(thumbnails.size()));
    const int columns = static_cast<int>(std::ceil(std::sqrt(count))), rows = (count + columns - 1) / columns;
    Image sheet = blank(columns * (cell_width + margin) + margin, rows * (cell_height + margin) + margin);
    for (int k = 0; k < static_cast<int>(thumbnails.size()); ++k) {
        const Image& t = thumbnails[k];
        const int left = margin + (k % columns) * (cell_width + margin) + (cell_width - t.width) / 2;
        const int top = margin + (k / columns) * (cell_height + margin) + (cell_height - t.height) / 2;
        for (int y = 0; y < t.height; ++y)
            for (int x = 0; x < t.width; ++x)
                for (int c = 0; c < 4; ++c) sheet.at(left + x, top + y)[c] = t.at(x, y)[c] + (1 - t.at(x, y)[3]);  // over white
    }
    return sheet;
}

}  // namespace isoparm
