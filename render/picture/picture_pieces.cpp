#include "picture/picture_pieces.h"

#include <algorithm>
#include <cmath>

#include "drawing/paint.h"
#include "picture/palette.h"

namespace isoparm {

Area common(const Area& a, const Area& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

Layers blank_layers(int width, int height, const std::vector<Aov>& aovs) {
    Layers layers{channels_of(aovs), {}};
    const auto pixel = empty_pixel(aovs);
    const std::size_t pixels = pixel.empty() ? 0 : static_cast<std::size_t>(width) * height;
    layers.values.reserve(pixels * pixel.size());
    for (std::size_t i = 0; i < pixels; ++i) layers.values.insert(layers.values.end(), pixel.begin(), pixel.end());
    return layers;
}

Image blank(int width, int height, const std::optional<Color>& background) {
    Image image{width, height, {}};
    image.pixels.resize(4 * static_cast<std::size_t>(width) * height);
    if (background)
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            image.pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>((*background)[static_cast<int>(i % 4)]);
    return image;
}

namespace {

/// How bright it looks, from 0 to 1.
double shown(const Color& c) { return srgb_from_linear(luminance(c)); }

Color rim_of(const Color& letters, const Color& background) {
    if (std::fabs(shown(letters) - shown(background)) > 0.4) return background;
    return shown(letters) > 0.5 ? Color{0, 0, 0} : Color{1, 1, 1};
}

void paste(const Image& part, int x0, int y0, Image& whole) {
    for (int y = 0; y < part.height; ++y)
        std::copy_n(part.at(0, y), 4 * static_cast<std::size_t>(part.width), whole.at(x0, y0 + y));
}

}  // namespace

void paste(const Picture& part, int x0, int y0, Picture& whole) {
    paste(part.image, x0, y0, whole.image);
    const std::size_t channels = part.layers.channels.size(), row = channels * part.image.width;
    for (int y = 0; y < part.image.height; ++y)
        std::copy_n(part.layers.values.data() + y * row, row,
                    whole.layers.values.data() + channels * (static_cast<std::size_t>(y0 + y) * whole.image.width + x0));
}

void put_over(Drawing drawing, int x, int y, int width, int height, bool vectors, const std::optional<Color>& background, Picture& picture) {
    for (DrawingItem& item : drawing) {
        if (background && shown(*background) < 0.35 && (item.color == ink_color() || item.color == curve_color())) item.color = Color{0.9, 0.9, 0.9};
        if (auto* text = std::get_if<Text>(&item.shape)) text->rim = rim_of(item.color, background.value_or(Color{1, 1, 1}));
    }
    if (vectors)
        picture.drawn.push_back({std::move(drawing), x, y, width, height});
    else
        paint(drawing, width, height, -x, -y, picture.image);
}

}  // namespace isoparm
