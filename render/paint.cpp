#include "paint.h"

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

}  // namespace isoparm
