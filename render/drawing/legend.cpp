#include "drawing/legend.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "drawing/axes.h"
#include "drawing/text_cairo.h"
#include "picture/palette.h"

namespace isoparm {
namespace {

std::string name_of(const ColorScale& s) {
    if (!s.name.empty()) return s.name;
    switch (s.by.what) {
        case ColorBy::What::gaussian: return "Gaussian curvature $K$";
        case ColorBy::What::mean: return "mean curvature $H$";
        case ColorBy::What::k1: return "larger curvature $k_1$";
        default: return "smaller curvature $k_2$";
    }
}

/// Numbers far from 1 are told in units of a power of ten.
int exponent_of(const ColorScale& s) {
    const int e = int(std::floor(std::log10(std::max(std::fabs(s.low), std::fabs(s.high)))));
    return e < -2 || e > 3 ? e : 0;
}

void add_bar(const ColorScale& s, double x, double height, double letter, Drawing& drawing) {
    const double top = 0.12 * height, bottom = 0.88 * height;
    const Color ink = ink_color();
    const double wide = 0.85 * letter;
    const auto at = [&](double value) { return bottom + (top - bottom) * (value - s.low) / (s.high - s.low); };
    constexpr int steps = 256;
    for (int i = 0; i < steps; ++i) {
        // Each reaches under the next one: no seams.
        const double from = s.low + (s.high - s.low) * i / steps, to = s.low + (s.high - s.low) * std::min(i + 3, steps) / steps;
        drawing.push_back({Filled{{{x, at(from)}, {x + wide, at(from)}, {x + wide, at(to)}, {x, at(to)}}}, s.color(s.low + (s.high - s.low) * (i + 0.5) / steps)});
    }
    drawing.push_back({Polyline{{{x, top}, {x + wide, top}, {x + wide, bottom}, {x, bottom}, {x, top}}, 0.06 * letter, {}, true}, ink});
    // An arrow head where the surface has more than the colours show.
    const auto beyond = [&](double y, double up, double value) {
        drawing.push_back({Filled{{{x, y - 0.12 * up}, {x + wide, y - 0.12 * up}, {x + 0.5 * wide, y - up}}}, s.color(value)});
    };
    if (s.above) beyond(top, 0.75 * letter, s.high);
    if (s.below) beyond(bottom, -0.75 * letter, s.low);

    const int exponent = exponent_of(s);
    const double unit = std::pow(10, exponent);
    const auto ticks = round_ticks(s.low / unit, s.high / unit, 1.9 * letter * (s.high - s.low) / unit / std::fabs(bottom - top));
    const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
    for (const double tick : ticks) {
        const double y = at(tick * unit);
        drawing.push_back({Polyline{{{x + wide, y}, {x + wide + 0.3 * letter, y}}, 0.06 * letter, {}, false}, ink});
        drawing.push_back({Text{{x + wide + 0.45 * letter, y + 0.3 * 0.85 * letter}, 0.85 * letter, number_text(tick, std::max(0, int(std::ceil(-std::log10(step) - 1e-9))))}, ink});
    }
    const std::string factor = exponent == 0 ? "" : "$10^{" + std::to_string(exponent) + "}$";
    const std::string units = factor + (factor.empty() || s.unit.empty() ? "" : " ") + s.unit;
    Text name{{0, 0}, 0.85 * letter, parse_math_text(name_of(s) + (units.empty() ? "" : ", " + units), true)};
    name.turned = true;
    const double most = 0.97 * height;  // of the picture
    if (const double advance = text_box(name.text, name.size).advance; advance > most) name.size *= most / advance;
    name.at = {x - 0.45 * letter, 0.5 * (top + bottom + text_box(name.text, name.size).advance)};
    drawing.push_back({name, ink});
}

}  // namespace

std::vector<ColorScale> scales_of(const std::vector<Thing>& things) {
    std::vector<ColorScale> list;
    for (const Thing& t : things) {
        const auto same = [&](const ColorScale& s) { return s.by.what == t.scale.by.what && s.low == t.scale.low && s.high == t.scale.high; };
        if (t.scale.by.legend && std::none_of(list.begin(), list.end(), same)) list.push_back(t.scale);
    }
    return list;
}

double legend_width(double letter) { return 5.2 * letter; }

LegendRoom legend_room(const std::vector<SceneObject>& objects, double letter, int width) {
    std::vector<const ColorBy*> curvatures;  // each with its range once; those without one may differ
    int bars = 0;
    for (const SceneObject& o : objects) {
        const auto same = [&](const ColorBy* by) { return by->what == o.color_by.what && by->range && by->range == o.color_by.range; };
        if (o.color_by.legend && std::none_of(curvatures.begin(), curvatures.end(), same)) curvatures.push_back(&o.color_by), ++bars;
        if (o.jumps.legend) ++bars;
    }
    if (bars == 0) return {0, letter};
    const double least = std::min(letter, width / 2 / legend_width(bars));
    return {std::min(int(bars * legend_width(least) + 0.5), width / 2), least};
}

Drawing legends(const std::vector<ColorScale>& scales, int width, int height, double letter) {
    Drawing drawing;
    for (std::size_t k = 0; k < scales.size(); ++k)
        add_bar(scales[k], width - double(k + 1) * legend_width(letter) + 1.4 * letter, height, letter, drawing);
    return drawing;
}

}  // namespace isoparm
