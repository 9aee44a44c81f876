// overlay.h -- the vectors over a traced scene: flat lines, axes, labels.
#pragma once
#include "drawing.h"
#include "panels.h"
#include "sight.h"

namespace isoparm {

/// `pixel`: pixels of this picture to one of the scene's; `letter`: size of letters that say nothing else. The same for
/// every number of threads. `isolines`: those of surfaces too, which the tracer otherwise paints.
Drawing overlay(const Scene& scene, const std::vector<SceneObject>& objects, const TracedScene& traced,
                const Camera& camera, double pixel, double letter, bool isolines = false);

/// The size of letters, in pixels, on a part width x height of a picture.
double letter_size(int picture_width, int picture_height, int width, int height);
/// The camera of a view: what it fits has room for labels and axes around it, and for legends at the right.
Camera camera_of(const View& view);

}  // namespace isoparm
