// overlay.h -- the vectors over a traced scene: flat lines, axes, labels.
#pragma once
#include "drawing.h"
#include "sight.h"

namespace isoparm {

/// `pixel`: pixels of this picture to one of the scene's; `letter`: size of letters that say nothing else. The same for
/// every number of threads. `isolines`: those of surfaces too, which the tracer otherwise paints.
Drawing overlay(const Scene& scene, const std::vector<SceneObject>& objects, const TracedScene& traced,
                const Camera& camera, double pixel, double letter, bool isolines = false);

/// The size of letters, in pixels, on a part width x height of a picture.
double letter_size(int picture_width, int picture_height, int width, int height);
/// Pixels to keep free about what a camera fits, for the labels and axes of the objects.
Vec2 room_for_text(const std::vector<SceneObject>& objects, double letter);

}  // namespace isoparm
