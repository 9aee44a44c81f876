// panels.h -- where the panels of a picture lie, and their titles.
#pragma once
#include "drawing.h"
#include "scene.h"

namespace isoparm {

/// A part of the picture that one camera fills; pixels.
struct View {
    std::vector<SceneObject> objects;
    CameraSettings camera;
    std::vector<Point> fitted;  // what the camera fits
    int x = 0, y = 0, width = 0, height = 0;
    double letter = 0;  // size of letters, pixels
};

/// The whole picture when the scene has no panels; otherwise panels of equal size in rows, each with room for a title
/// under it when any has one. Throws Error(usage) when the picture is too small for them. `also_fit`: further points
/// for the cameras. `letter`: size of letters, pixels, instead of one that goes with the picture's.
std::vector<View> views_of(const Scene& scene, int width, int height, const std::vector<Point>& also_fit, std::optional<double> letter = {});

/// The titles under the views of the panels.
Drawing titles_of(const Scene& scene, const std::vector<View>& views);

}  // namespace isoparm
