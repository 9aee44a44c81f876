// labels.h -- where labels stand: beside what they name, over neither each other nor lines, inside the picture.
#pragma once
#include "drawing/drawing.h"
#include "scene/scene.h"

namespace isoparm {

/// Something on the picture that labels had better not cover.
struct Obstacle {
    Vec2 at;
    double radius = 0;
};

/// A place where a label may be anchored.
struct Anchor {
    Vec2 at;
    double seen = 1;  // as Sight has it
    Vec2 away;        // the label stands rather on this side; any length
    double gap = 0;   // radius of what is there
};

struct LabelRequest {
    const Label* label;
    int side = -1;                // the only one that is tried; -1: any of the eight
    std::vector<Anchor> anchors;  // the first is preferred
    double size = 0;              // of the letters, pixels
    Color color;
};

/// A text whose ink has its middle at `middle`, and the box that it then fills.
struct TextPlace {
    Text text;
    double left, top, right, bottom;
};
/// A text that may stand in some places only, as numbers of axes.
struct MarkRequest {
    struct Place {
        TextPlace at;
        double cost = 0;  // the lower, the better; to cover a point of a line, or a ball, is 5
    };
    std::vector<Place> places;
    Color color;
    double opacity = 1;
};

/// From a label's box toward its anchor, which has a gap around it: two points, or none where there is no room.
std::vector<Vec2> leader_of(double left, double top, double right, double bottom, const Anchor& anchor, double size);

/// Places the marks and then one label after the other, each where it costs least: labels among the eight sides of their anchors and some
/// distances. One that stands more than 1.5 letter heights off gets a leader: a thin line to what it names. The outcome depends on nothing but
/// the arguments. Texts go to the end of the drawing, each behind its leader.
void place_labels(const std::vector<LabelRequest>& requests, const std::vector<Obstacle>& obstacles, int width,
                  int height, Drawing& drawing, const std::vector<MarkRequest>& marks = {});

TextPlace centred_text(const MathText& text, double size, const Vec2& middle);
/// The same beside `at`: in direction (x,y), of unit length, `gap` pixels away.
TextPlace text_beside(const MathText& text, double size, const Vec2& at, double x, double y, double gap);
/// The same of a text that stands centred at `at`.
TextPlace beside(TextPlace centred, double x, double y, double gap);
TextPlace shifted(TextPlace t, const Vec2& by);
/// The rim of letters of this size.
double halo_of(double size);

}  // namespace isoparm
