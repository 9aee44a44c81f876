// legend.h -- the bar that says which colour is which curvature.
#pragma once
#include "curvature_map.h"
#include "drawing.h"

namespace isoparm {

/// Bars beside each other at the right of a picture width x height, the first outermost; pixels. `letter`: size of letters.
Drawing legends(const std::vector<ColorScale>& scales, int width, int height, double letter);
/// What one of them takes off the width.
double legend_width(double letter);
/// Pixels at the right of a picture that the legends of its objects take; the camera sees what is left of them, which is half at least.
int legend_room(const std::vector<SceneObject>& objects, double letter, int width);

}  // namespace isoparm
