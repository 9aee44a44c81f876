// twist_arrows.h -- twists that disagree, as arrows: both mixed derivatives at each corner where a surface's cross derivatives do not fit together.
#pragma once
#include <string>
#include <vector>

#include "drawing/drawing.h"
#include "scene/scene.h"

namespace isoparm {

/// Of one corner. Arrows go from `foot`.
struct TwistArrow {
    Point foot, tip_f, tip_g;  // x_uv, of the derivatives across the lines u = const; x_vu, of those across v = const
    std::string gap;           // "gap 10"
};
/// Of the corners whose gap is above what is allowed; none where all fit. `size`: of the scene.
std::vector<TwistArrow> twist_arrows(const Surface& surface, const TwistArrows& how, double size);

/// Colours of x_uv and x_vu.
Color twist_color(int which);
/// What the colours mean, and how long the arrows are, at the top left corner of a picture. `letter`: size of letters, pixels.
void add_twist_legend(const Surface& surface, const TwistArrows& how, double size, double letter, Drawing& drawing);

}  // namespace isoparm
