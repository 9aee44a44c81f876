// panels.h -- where the panels and insets of a picture lie, their cameras, titles and frames.
#pragma once
#include "drawing/drawing.h"
#include "picture/camera.h"
#include "scene/scene.h"

namespace isoparm {

/// A part of the picture that one camera fills; pixels.
struct View {
    std::vector<SceneObject> objects;
    CameraSettings camera;
    std::vector<Point> fitted;  // what the camera fits
    int x = 0, y = 0, width = 0, height = 0;
    double letter = 0;  // size of letters, pixels
    Vec2 room;          // around what the camera fits, for labels and axes
    int legends = 0;    // pixels at the right for legends, of this view or of one that shares its camera, so that all have one scale
    std::optional<Inset> inset;               // it is one; it lies over the view before it that is none
    std::optional<std::array<double, 5>> zoom;  // of an inset: x, y and width of what is enlarged in that view's pixels; its width and height
    std::vector<std::array<int, 4>> covered{};  // x, y, width and height of the insets over it, its own pixels
};

/// The whole picture when the scene has no panels; otherwise panels of equal size in rows, each with room for a title
/// under it when any has one. Behind each view follow its insets. Throws Error(usage) when the picture is too small for them.
/// `also_fit`: further points for the cameras. `letter`: size of letters, pixels, instead of one that goes with the picture's.
std::vector<View> views_of(const Scene& scene, int width, int height, const std::vector<Point>& also_fit, std::optional<double> letter = {});

/// The size of letters, in pixels, on a part width x height of a picture.
double letter_size(int picture_width, int picture_height, int width, int height);
/// The camera of a view: what it fits has room for labels and axes around it, and for legends at the right.
Camera camera_of(const View& view);

/// The marks and titles of the panels, under them or in their corners. `views`: as views_of() gave them.
Drawing titles_of(const Scene& scene, const std::vector<View>& views);

}  // namespace isoparm
