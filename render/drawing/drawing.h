// drawing.h -- what is drawn on a picture as vectors: lines, areas and texts, in the order in which they lie over each
// other. Knows neither scenes nor how it is painted: paint.h puts it on pixels.
//
// Pixels of the picture: x to the right, y down, (0,0) the corner of the top left pixel. Colours are linear.
#pragma once
#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "drawing/math_text.h"
#include "scalar/vec.h"

namespace isoparm {

struct Polyline {
    std::vector<Vec2> points;
    double width = 1;
    std::vector<double> dash;  // lengths on, off, on, ...; empty: not dashed
    bool round = true;         // ends; corners always are
    std::vector<std::vector<Vec2>> more{};  // further lines, drawn as one with it: where they cross, they are no darker
};
struct Filled {
    std::vector<Vec2> outline;  // closed
};
struct Text {
    Vec2 at;          // where the base line begins
    double size = 0;  // of the letters: one em
    MathText text;
    double halo = 0;  // width of the rim about the letters
    bool turned = false;  // by a quarter: reads upwards
    std::optional<Vec2> anchor{};  // the point that it names
    Vec3<double> rim{1, 1, 1};     // colour of the rim
};

struct DrawingItem {
    std::variant<Polyline, Filled, Text> shape;
    Vec3<double> color;
    double opacity = 1;
};
using Drawing = std::vector<DrawingItem>;

/// Of the rim of a text: that of a faint one is fainter still, so that a hidden label does not bleach what hides it.
inline double halo_opacity(double of_text) { return 0.85 * of_text * of_text * of_text * of_text; }

/// A drawing on a part of a picture, seen only there; its pixels begin at (x,y) of the picture.
struct DrawnPart {
    Drawing drawing;
    int x = 0, y = 0, width = 0, height = 0;
    std::vector<std::array<int, 4>> holes{};  // x, y, width, height of its own pixels, where it is not seen
};

}  // namespace isoparm
