#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>

#include "commands/limit_view.h"
#include "drawing/legend.h"
#include "drawing/paint.h"
#include "drawing/text_cairo.h"
#include "picture/curvature_map.h"
#include "picture/palette.h"
#include "provenance.h"

namespace isoparm {
namespace {

/// Three panels beside each other, each with a title over it and room for a legend at its right.
class Sheet {
public:
    Sheet(int width, int height, int panels) : letter_(std::max(9.0, height / 32.0)), top_(int(2.4 * letter_)), panel_(width + int(legend_width(letter_))) {
        sheet_ = {panels * panel_, height + top_, {}};
        sheet_.pixels.assign(4 * std::size_t(sheet_.width) * std::size_t(sheet_.height), 1.0f);
        width_ = width, height_ = height;
    }
    void add(const std::string& title, const std::function<Color(std::size_t)>& color) {
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                const Color c = color(std::size_t(y) * width_ + x);
                for (int k = 0; k < 3; ++k) sheet_.at(x + left_, y + top_)[k] = float(c[k]);
            }
        const MathText text = parse_math_text(title, true);
        const double size = std::min(1.0, (width_ - letter_) / text_box(text, letter_).advance) * letter_;  // small pictures have small titles
        write({{Text{{left_ + 0.5 * (width_ - text_box(text, size).advance), 0.7 * top_}, size, text}, ink_color()}}, 0, 0);
        left_ += panel_;
    }
    void add(const std::string& title, const ColorScale& scale, const std::vector<float>& values) {
        add(title, [&](std::size_t i) { return std::isnan(values[i]) ? Color{1, 1, 1} : scale.color(values[i]); });
        write(legends({scale}, panel_, height_, letter_), left_ - panel_, top_);
    }
    Image take() { return std::move(sheet_); }

private:
    void write(const Drawing& drawing, int left, int top) { paint(drawing, sheet_.width - left, sheet_.height - top, -left, -top, sheet_); }
    double letter_;
    int top_, panel_, width_ = 0, height_ = 0, left_ = 0;
    Image sheet_;
};

ColorScale scale(const std::string& name, double top) {
    ColorScale s;
    s.name = name, s.low = 0, s.high = top > 0 ? rounded_up(top) : 1;
    return s;
}

std::string text(const char* format, double a, double b) {
    char line[160];
    std::snprintf(line, sizeof line, format, a, b);
    return line;
}

Image difference_sheet(const LimitView& v) {
    Sheet sheet(v.width, v.height, 3);
    sheet.add(text("colours: at most %.2g, RMS %.2g", v.color_max, v.color_rms), scale("largest of R, G, B", v.color_max), v.pictures.color);
    sheet.add(text("normals: at most %.3g, on average %.2g degrees", v.normal_max_degrees, v.normal_mean_degrees), scale("degrees", v.normal_max_degrees), v.pictures.degrees);
    const Color both = linear_from_srgb(0.84, 0.85, 0.86), limit = linear_from_srgb(0.84, 0.37, 0), composite = linear_from_srgb(0, 0.45, 0.70);
    sheet.add(text("silhouettes: %.0f pixels differ, by %.3g; orange: limit only, blue: composite only", v.silhouette_differing, v.silhouette_distance),
              [&](std::size_t i) { return v.pictures.inside[i] == 3 ? both : v.pictures.inside[i] == 1 ? limit : v.pictures.inside[i] == 2 ? composite : Color{1, 1, 1}; });
    return sheet.take();
}

}  // namespace

const std::vector<std::string>& limit_view_files() {
    static const std::vector<std::string> names{"view-limit.png", "view-composite.png", "view-difference.png"};
    return names;
}

void write_limit_view(const std::string& folder, const LimitView& view) {
    const auto& names = limit_view_files();
    const auto write = [&](const std::string& name, const Image& image, const std::string& title) {
        write_image((std::filesystem::path(folder) / name).string(), image, {{"Software", "isoparm " + program_version()}, {"Title", title}});
    };
    write(names[0], view.pictures.limit, "limit surface");
    write(names[1], view.pictures.composite, "composite of one patch a face");
    write(names[2], difference_sheet(view), "limit surface and composite: colours, normals, silhouettes");
}

}  // namespace isoparm
