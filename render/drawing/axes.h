// axes.h -- coordinate axes with arrow heads, ticks, numbers and names.
#pragma once
#include "drawing/labels.h"
#include "rays/sight.h"

namespace isoparm {

/// Round numbers from low to high, at least `least` apart: multiples of 1, 2 or 5 times a power of ten. At most 1000.
std::vector<double> round_ticks(double low, double high, double least);

/// `pixel`: pixels of this picture to one of the scene's; `letter`: size of letters in pixels. Lines become
/// obstacles; numbers and names are placed with the labels, when all that they may cover is known.
void add_axes(const SceneObject& o, const Color& color, const Sight& sight, double pixel, double letter,
              std::vector<Obstacle>& obstacles, std::vector<MarkRequest>& marks, Drawing& drawing);

}  // namespace isoparm
