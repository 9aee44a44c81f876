// flat_lines.h -- curves as lines of constant width on the picture, cut where surfaces hide them.
#pragma once
#include <cmath>
#include <functional>

#include "drawing/drawing.h"
#include "rays/sight.h"
#include "rays/tubes.h"

namespace isoparm {

struct LineLook {
    Color color;
    double opacity = 1, width = 1;  // pixels
    std::vector<double> dash;       // pixels
    Hidden hidden = Hidden::hide;
};

/// The curve in steps of about a pixel and a half, as far as it is in front of the camera.
std::vector<Point> fine_points(const std::vector<CubicPiece>& pieces, const Camera& camera);

/// Pixels between two points of the picture.
inline double apart(const Vec2& a, const Vec2& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// Parameters from `from` to `to` at which points of a curve follow each other within about a pixel and a half.
std::vector<double> fine_parameters(const std::function<Point(double)>& curve, double from, double to, const Camera& camera);

/// Points that follow each other within some pixels; where the line vanishes behind something is found to a twentieth of a pixel.
/// `clear` as for Sight. `fade`: for each point, a further factor of its opacity; empty: 1.
void add_line(const std::vector<Point>& points, const LineLook& look, const Sight& sight, double clear,
              Drawing& drawing, const std::vector<double>& fade = {});
/// Lines that look alike, from item `first` on, become one.
void join_lines(Drawing& drawing, std::size_t first);

/// How the part of a line or label is drawn that is seen as much as `seen`: its opacity.
double opacity_of(Hidden hidden, double seen);

}  // namespace isoparm
