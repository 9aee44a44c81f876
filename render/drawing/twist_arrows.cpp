#include "drawing/twist_arrows.h"

#include <algorithm>

#include "picture/palette.h"
#include "promises.h"
#include "text/short_text.h"

namespace isoparm {
namespace {

std::vector<TwistPair> apart(const Surface& surface) {
    std::vector<TwistPair> r = surface.examine ? surface.examine().twists : std::vector<TwistPair>();
    std::erase_if(r, [](const TwistPair& t) { return t.gap <= t.tolerance; });
    return r;
}
/// The longest arrow is a sixth of the scene, unless the scale is given.
double scale_of(const std::vector<TwistPair>& pairs, const TwistArrows& how, double size) {
    double most = 0;
    for (const TwistPair& t : pairs) most = std::max({most, length(t.of_f), length(t.of_g)});
    return how.scale ? *how.scale : most > 0 ? size / 6 / most : 1;
}

}  // namespace

Color twist_color(int which) { return which == 0 ? linear_from_srgb(0.10, 0.34, 0.65) : linear_from_srgb(0.75, 0.16, 0.22); }

std::vector<TwistArrow> twist_arrows(const Surface& surface, const TwistArrows& how, double size) {
    if (!how.on) return {};
    const auto pairs = apart(surface);
    const double scale = scale_of(pairs, how, size);
    std::vector<TwistArrow> arrows;
    for (const TwistPair& t : pairs) arrows.push_back({t.at, t.at + scale * t.of_f, t.at + scale * t.of_g, "gap " + short_text(t.gap, 3)});
    return arrows;
}

void add_twist_legend(const Surface& surface, const TwistArrows& how, double size, double letter, Drawing& drawing) {
    double y = 0.5 * letter;
    const auto add = [&](const std::string& text, const Color& color) {
        drawing.push_back({Text{{0.8 * letter, y += 1.1 * letter}, 0.8 * letter, parse_math_text(text, true), 0.25 * letter}, color});
    };
    const auto pairs = apart(surface);
    if (pairs.empty()) return add("all twists fit together", ink_color());
    add("$x_{uv}$, across $u = $const", twist_color(0));
    add("$x_{vu}$, across $v = $const", twist_color(1));
    add("drawn " + short_text(scale_of(pairs, how, size), 3) + " times" + (pairs.front().remedy.empty() ? "" : "; remedy: " + pairs.front().remedy), ink_color());
}

}  // namespace isoparm
