#include "drawing/paint.h"

#include <algorithm>
#include <array>

#include "drawing/text_cairo.h"
#include "picture/palette.h"

namespace isoparm {
namespace {

/// use(how much of it is covered, the pixel); (left, top) is the pixel of what `c` was made for at the image's corner.
template <class Use> void each_covered(const Coverage& c, int left, int top, Image& image, Use use) {
    const int dx = c.x0 - left, dy = c.y0 - top;
    for (int y = std::max(0, -dy); y < std::min(c.height, image.height - dy); ++y)
        for (int x = std::max(0, -dx); x < std::min(c.width, image.width - dx); ++x)
            if (const auto part = c.part[static_cast<std::size_t>(y) * c.width + x]) use(part / 255.0, image.at(dx + x, dy + y));
}

void add(const Coverage& c, const Vec3<double>& color, double opacity, int left, int top, Image& image) {
    each_covered(c, left, top, image, [&](double covered, float* out) {
        const double a = opacity * covered;
        for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(a * color[k] + (1 - a) * out[k]);
        out[3] = static_cast<float>(a + (1 - a) * out[3]);
    });
}

/// As add(), but from what is there to the letter by how bright it looks, as programs that show PDF and SVG do it: in linear light the rims of dark letters on white paper would be so bright that
/// they look thin.
void add_letters(const Coverage& c, const Vec3<double>& color, double opacity, int left, int top, Image& image) {
    each_covered(c, left, top, image, [&](double covered, float* out) {
        const double a = opacity * covered, alpha = out[3];
        for (int k = 0; k < 3; ++k) {
            const double there = alpha > 0 ? std::max(0.0, out[k] / alpha) : 0, letter = opacity * color[k] + (1 - opacity) * there;
            const double seen = covered == 1 ? letter : linear_from_srgb(srgb_from_linear(there) + covered * (srgb_from_linear(letter) - srgb_from_linear(there)));
            out[k] = static_cast<float>(alpha * seen + (1 - alpha) * a * color[k]);
        }
        out[3] = static_cast<float>(a + (1 - a) * alpha);
    });
}

/// The pixels of an area of `from` put at (x,y) of `to`, as far as both have them.
void copy(const Image& from, const std::array<int, 4>& area, int x, int y, Image& to) {
    const auto [x0, y0, width, height] = area;
    const int first = std::max({0, -x, -x0}), last = std::min({width, to.width - x, from.width - x0});
    for (int row = std::max({0, -y, -y0}); row < std::min({height, to.height - y, from.height - y0}) && first < last; ++row)
        std::copy_n(from.at(x0 + first, y0 + row), 4 * (last - first), to.at(x + first, y + row));
}

}  // namespace

void paint(const Drawing& drawing, int width, int height, int left, int top, Image& image) {
    for (const DrawingItem& item : drawing)
        std::visit(
            [&](const auto& shape) {
                if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Text>) {
                    if (shape.halo > 0) add(coverage(shape, shape.halo, width, height), shape.rim, halo_opacity(item.opacity), left, top, image);
                    add_letters(coverage(shape, 0, width, height), item.color, item.opacity, left, top, image);
                } else {
                    add(coverage(shape, width, height), item.color, item.opacity, left, top, image);
                }
            },
            item.shape);
}

void paint(const std::vector<DrawnPart>& parts, Image& image) {
    for (const DrawnPart& part : parts) {
        Image seen{part.width, part.height, std::vector<float>(4 * static_cast<std::size_t>(part.width) * part.height)};
        copy(image, {part.x, part.y, part.width, part.height}, 0, 0, seen);
        const Image before = seen;
        paint(part.drawing, part.width, part.height, 0, 0, seen);
        for (const auto& hole : part.holes) copy(before, hole, hole[0], hole[1], seen);
        copy(seen, {0, 0, part.width, part.height}, part.x, part.y, image);
    }
}

}  // namespace isoparm
