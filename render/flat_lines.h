// flat_lines.h -- curves as lines of constant width on the picture, cut where surfaces hide them.
#pragma once
#include "drawing.h"
#include "sight.h"
#include "tubes.h"

namespace isoparm {

struct LineLook {
    Color color;
    double opacity = 1, width = 1;  // pixels
    std::vector<double> dash;       // pixels
    Hidden hidden = Hidden::hide;
};

/// The curve in steps of about a pixel and a half, as far as it is in front of the camera.
std::vector<Point> fine_points(const std::vector<CubicPiece>& pieces, const Camera& camera);

/// Points that follow each other within some pixels. `clear` as for Sight.
void add_line(const std::vector<Point>& points, const LineLook& look, const Sight& sight, double clear,
              Drawing& drawing);

/// How the part of a line or label is drawn that is seen as much as `seen`: its opacity.
double opacity_of(Hidden hidden, double seen);

}  // namespace isoparm
