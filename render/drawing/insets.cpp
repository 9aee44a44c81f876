#include "drawing/insets.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "picture/palette.h"

namespace isoparm {
namespace {

constexpr double kMargin = 0.025;  // between a frame and the border of its picture, of the lesser side

struct Frame {
    double left, top, right, bottom;
};
Frame frame_of(const View& v) { return {double(v.x), double(v.y), double(v.x + v.width), double(v.y + v.height)}; }

Polyline rectangle(const Frame& b, double width) { return {{{b.left, b.top}, {b.right, b.top}, {b.right, b.bottom}, {b.left, b.bottom}, {b.left, b.top}}, width, {}, true}; }

/// The two lines between like corners that cross neither box.
std::vector<std::array<Vec2, 2>> connections(const Frame& a, const Frame& b) {
    const bool left = a.left < b.left, right = a.right < b.right, top = a.top < b.top, bottom = a.bottom < b.bottom;
    std::vector<std::array<Vec2, 2>> lines;
    if (left != top) lines.push_back({Vec2{a.left, a.top}, Vec2{b.left, b.top}});
    if (left == bottom) lines.push_back({Vec2{a.left, a.bottom}, Vec2{b.left, b.bottom}});
    if (right == top) lines.push_back({Vec2{a.right, a.top}, Vec2{b.right, b.top}});
    if (right != bottom) lines.push_back({Vec2{a.right, a.bottom}, Vec2{b.right, b.bottom}});
    return lines;
}

int checked(double pixels, const Inset&) {
    const long n = std::lround(pixels);
    if (n < 2) throw Error(ErrorKind::usage, "an inset of the scene comes to less than 2 pixels, expected a larger picture or inset");
    return static_cast<int>(n);
}

}  // namespace

View view_of(const Inset& inset, const View& parent) {
    View v = parent;
    v.covered.clear();
    v.inset = inset;
    v.width = std::min(checked(inset.width * parent.width, inset), parent.width);
    const double shape = inset.region ? ((*inset.region)[3] - (*inset.region)[1]) / ((*inset.region)[2] - (*inset.region)[0]) : 1;
    v.height = std::min(checked(inset.height ? *inset.height * parent.height : v.width * shape * parent.height / parent.width, inset), parent.height);

    const double margin = kMargin * std::min(parent.width, parent.height);
    const double across = std::max(0, parent.width - parent.legends - v.width), down = parent.height - v.height;
    const int column = inset.side == 8 ? 0 : int(std::lround(std::cos(inset.side * 0.785398163397448))), row = inset.side == 8 ? 0 : -int(std::lround(std::sin(inset.side * 0.785398163397448)));
    const auto place = [&](int where, double free) { return where < 0 ? std::min(margin, free) : where > 0 ? std::max(free - margin, 0.0) : 0.5 * free; };
    const Vec2 corner = inset.at ? Vec2{std::min(inset.at->x * parent.width, across), std::min(inset.at->y * parent.height, down)} : Vec2{place(column, across), place(row, down)};
    v.x = parent.x + static_cast<int>(std::lround(corner.x));
    v.y = parent.y + static_cast<int>(std::lround(corner.y));

    if (inset.camera) {
        v.camera = *inset.camera;
        v.legends = 0;
    } else if (inset.region) {
        // The middle of the region stays, its shape becomes that of the frame.
        const auto& r = *inset.region;
        const double width = std::max((r[2] - r[0]) * parent.width, (r[3] - r[1]) * parent.height * v.width / v.height);
        v.zoom = {{0.5 * (r[0] + r[2]) * parent.width - 0.5 * width, 0.5 * (r[1] + r[3]) * parent.height - 0.5 * width * v.height / v.width, width, double(parent.width), double(parent.height)}};
    } else {
        const Camera camera = camera_of(parent);
        if (!(camera.depth(*inset.around) > 0)) throw_input("the point that an inset shows is behind the camera");
        const Vec2 middle = camera.project(*inset.around);
        const double width = v.width / inset.zoom;
        v.zoom = {{middle.x - 0.5 * width, middle.y - 0.5 * v.height / inset.zoom, width, double(parent.width), double(parent.height)}};
    }
    return v;
}

Drawing frames_of(const std::vector<View>& views, double pixel) {
    Drawing drawing;
    const View* parent = nullptr;
    for (const View& v : views) {
        if (!v.inset) {
            parent = &v;
            continue;
        }
        const Color color = v.inset->color.value_or(ink_color());
        const double width = v.inset->line * pixel;
        if (v.zoom) {
            const auto& z = *v.zoom;
            const Frame part{parent->x + z[0], parent->y + z[1], parent->x + z[0] + z[2], parent->y + z[1] + z[2] * v.height / v.width};
            drawing.push_back({rectangle(part, 0.7 * width), color, 0.8});
            if (v.inset->lines)
                for (const auto& [a, b] : connections(part, frame_of(v))) drawing.push_back({Polyline{{a, b}, 0.7 * width, {}, false}, color, 0.8});
        }
        drawing.push_back({rectangle(frame_of(v), width), color});
    }
    return drawing;
}

}  // namespace isoparm
