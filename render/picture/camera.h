// camera.h -- perspective and orthographic cameras.
#pragma once
#include <limits>
#include <vector>

#include "scene/scene.h"

namespace isoparm {

/// points origin + t direction, t >= 0; direction has unit length.
struct Ray {
    Point origin, direction;
    double reach = std::numeric_limits<double>::infinity();  // of rays to a light: its distance, in lengths of the direction
};

/// Looks along `forward`; right, up and forward are orthonormal. Pixels: x to the right, y down, (0,0) is the corner of
/// the picture's top left pixel, whose middle is (0.5, 0.5).
struct Camera {
    Point eye, right, up, forward;
    bool orthographic = false;
    double half_height = 1;  // of the view: scene units (orthographic), or at depth 1 (perspective)
    int width = 1, height = 1;
    Vec2 shift{};            // pixels from the middle of the picture to where the view direction meets it: of parts of larger pictures

    Ray ray(double x, double y) const;
    /// Pixel coordinates of a point in front of the camera.
    Vec2 project(const Point& p) const;
    double depth(const Point& p) const { return dot(p - eye, forward); }
    /// Size of one pixel at a depth, in scene units.
    double pixel_size(double depth) const { return 2 * half_height / height * (orthographic ? 1 : depth); }
};

/// The camera of a part of a camera's picture, at (x,y) and width x height of its pixels, which then fills `across` x `down` pixels.
Camera zoomed(Camera camera, double x, double y, double width, int across, int down);

/// The camera that the settings describe. What they leave open is chosen for `drawn`, points of everything that is
/// drawn (its convex hull, or about): a three-quarter view from the front, right and above with z up, everything inside
/// with a margin of 6% of the picture and `room` pixels at the sides and at top and bottom. Throws Error(input) when eye and target coincide or a field of view is no such
/// angle.
Camera make_camera(const CameraSettings& settings, const std::vector<Point>& drawn, int width, int height, const Vec2& room = {});

/// A camera as settings that fit nothing any more: they make it again, at any size. `middle`: the target is as far from the eye, if that is in front.
CameraSettings settings_of(const Camera& camera, const Point& middle);

/// How far, in scene units, any point of `box` in the picture may move at least before its projection moves by a pixel (to first order).
double finest_pixel(const Camera& camera, const Bounds& box);

}  // namespace isoparm
