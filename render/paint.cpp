#include "paint.h"

#include <algorithm>
#include <array>

#include "text_cairo.h"

namespace isoparm {
namespace {

void add(const Coverage& c, const Vec3<double>& color, double opacity, Image& image) {
    for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x) {
            const double a = opacity * c.part[static_cast<std::size_t>(y) * c.width + x] / 255;
            if (a == 0) continue;
            float* out = image.at(c.x0 + x, c.y0 + y);
            for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(a * color[k] + (1 - a) * out[k]);
            out[3] = static_cast<float>(a + (1 - a) * out[3]);
        }
}

Vec2 moved(const Vec2& p, int left, int top) { return {p.x - left, p.y - top}; }
void move(Polyline& line, int left, int top) {
    for (Vec2& p : line.points) p = moved(p, left, top);
    for (auto& other : line.more)
        for (Vec2& p : other) p = moved(p, left, top);
}
void move(Filled& area, int left, int top) {
    for (Vec2& p : area.outline) p = moved(p, left, top);
}
void move(Text& text, int left, int top) { text.at = moved(text.at, left, top); }

/// The pixels of an area of `from` put at (x,y) of `to`, as far as both have them.
void copy(const Image& from, const std::array<int, 4>& area, int x, int y, Image& to) {
    const auto [x0, y0, width, height] = area;
    const int first = std::max({0, -x, -x0}), last = std::min({width, to.width - x, from.width - x0});
    for (int row = std::max({0, -y, -y0}); row < std::min({height, to.height - y, from.height - y0}) && first < last; ++row)
        std::copy_n(from.at(x0 + first, y0 + row), 4 * (last - first), to.at(x + first, y + row));
}

}  // namespace

void paint(const Drawing& drawing, int left, int top, Image& image) {
    const Vec3<double> white{1, 1, 1};
    for (const DrawingItem& item : drawing)
        std::visit(
            [&](auto shape) {
                move(shape, left, top);
                if constexpr (std::is_same_v<decltype(shape), Text>) {
                    if (shape.halo > 0)
                        add(coverage(shape, shape.halo, image.width, image.height), white,
                            halo_opacity(item.opacity), image);
                    add(coverage(shape, 0, image.width, image.height), item.color, item.opacity, image);
                } else {
                    add(coverage(shape, image.width, image.height), item.color, item.opacity, image);
                }
            },
            item.shape);
}

void paint(const std::vector<DrawnPart>& parts, Image& image) {
    for (const DrawnPart& part : parts) {
        Image seen{part.width, part.height, std::vector<float>(4 * static_cast<std::size_t>(part.width) * part.height)};
        copy(image, {part.x, part.y, part.width, part.height}, 0, 0, seen);
        const Image before = seen;
        paint(part.drawing, 0, 0, seen);
        for (const auto& hole : part.holes) copy(before, hole, hole[0], hole[1], seen);
        copy(seen, {0, 0, part.width, part.height}, part.x, part.y, image);
    }
}

}  // namespace isoparm
