// legend.h -- the bar that says which colour is which curvature.
#pragma once
#include "drawing/drawing.h"
#include "picture/curvature_map.h"
#include "rays/traced_scene.h"

namespace isoparm {

/// Of the legends that are wanted, each once.
std::vector<ColorScale> scales_of(const std::vector<Thing>& things);
/// Bars beside each other at the right of a picture width x height, the first outermost; pixels. `letter`: size of letters.
Drawing legends(const std::vector<ColorScale>& scales, int width, int height, double letter);
/// What one of them takes off the width.
double legend_width(double letter);
/// Pixels at the right of a picture that the legends of its objects take, and the size of their letters: smaller than `letter` where
/// they would take more than half. The camera sees what is left of them.
struct LegendRoom {
    int width = 0;
    double letter = 0;
};
LegendRoom legend_room(const std::vector<SceneObject>& objects, double letter, int width);

}  // namespace isoparm
