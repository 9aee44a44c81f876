// overlay.h -- the vectors over a traced scene: flat lines, axes, labels.
#pragma once
#include "drawing.h"
#include "sight.h"

namespace isoparm {

/// `pixel`: pixels of this picture to one of the scene's. The same for every number of threads.
Drawing overlay(const Scene& scene, const std::vector<SceneObject>& objects, const TracedScene& traced, const Camera& camera, double pixel);

/// The size of letters that a label does not give, in pixels, on a picture of this size.
double letter_size(int width, int height);
/// Pixels to keep free about what a camera fits, for the labels and axes of the objects.
Vec2 room_for_text(const std::vector<SceneObject>& objects, int width, int height);

}  // namespace isoparm
