#include "drawing/arrows.h"

#include <algorithm>

namespace isoparm {
namespace {

// Of the head, in widths of the line; its notch, in lengths of the head.
constexpr double kLength = 5.5, kHalf = 1.9, kNotch = 0.78, kMost = 0.6;

/// Where the shaft is `pixels` from the tip on the picture.
Point neck_of(const Arrow& arrow, double pixels, const Camera& camera) {
    const Vec2 tip = camera.project(arrow.tip);
    double low = 0, high = 1;  // from the tip
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        (apart(camera.project(arrow.tip + middle * (arrow.tail - arrow.tip)), tip) < pixels ? low : high) = middle;
    }
    return arrow.tip + high * (arrow.tail - arrow.tip);
}

}  // namespace

void add_arrow(const Arrow& arrow, const LineLook& look, const Sight& sight, Drawing& drawing) {
    const Camera& camera = sight.camera();
    if (!(camera.depth(arrow.tail) > 0 && camera.depth(arrow.tip) > 0)) return;
    const Vec2 tail = camera.project(arrow.tail), tip = camera.project(arrow.tip);
    const double pixels = apart(tail, tip);
    if (!(pixels > 0.5)) return;  // along the view
    const double head = std::min(kLength * look.width, kMost * pixels), half = head * kHalf / kLength;
    const Vec2 along{(tip.x - tail.x) / pixels, (tip.y - tail.y) / pixels}, across{-along.y, along.x};
    const auto at = [&](double back, double aside) { return Vec2{tip.x - back * along.x + aside * across.x, tip.y - back * along.y + aside * across.y}; };

    add_line(fine_points({straight(arrow.tail, neck_of(arrow, 0.9 * kNotch * head, camera))}, camera), look, sight, 0, drawing);
    const double seen = look.hidden == Hidden::show ? 1 : sight.of(neck_of(arrow, 0.5 * head, camera));
    const double opacity = look.opacity * opacity_of(look.hidden, seen);
    if (opacity >= 0.02) drawing.push_back({Filled{{tip, at(head, half), at(kNotch * head, 0), at(head, -half)}}, look.color, opacity});
}

}  // namespace isoparm
