// outlines.h -- the outline of a surface as the camera sees it: where it turns away from the eye, where it ends, and folds between
// patches of which one faces the eye and the other does not.
#pragma once
#include <vector>

#include "composite.h"
#include "picture/camera.h"

namespace isoparm {

/// Lines, each as points that follow each other within about a pixel and a half; hidden parts too. The normal is at right angles to the
/// view there to 1e-6, on the surface itself. Found on a grid of cells of about four pixels: what is smaller may be missed (sampled).
/// `borders`: with the edges that only one patch has. `size`: diagonal of the scene.
std::vector<std::vector<Point>> outline_of(const Composite& patches, const Camera& camera, double size, bool borders);

}  // namespace isoparm
