#include "picture/layout.h"

#include <cmath>

#include "drawing/drawn.h"
#include "error.h"

namespace isoparm {

namespace {
/// Radii in points, in scene units where the middle of the object is; behind the eye they are the usual ones.
void set_radii(const Scene& scene, View& v, double pixels_per_point) {
    for (SceneObject& o : v.objects) {
        if (!o.radius || !o.radius->points) continue;
        const Camera camera = camera_of(v);
        const std::vector<Point> points = drawn_points(scene, {o});
        double depth = 0;
        for (const Point& p : points) depth += camera.depth(p) / static_cast<double>(points.size());
        if (depth > 0) o.radius = o.radius->value * pixels_per_point * camera.pixel_size(depth);
    }
}

constexpr double kLeastPrinted = 6;  // points: smaller letters are hard to read on paper
constexpr int kLargestSize = 1 << 16;
}  // namespace

int checked_size(int size, const char* what, int most) {
    if (size < 1 || size > most)
        throw Error(ErrorKind::usage, std::string("the picture's ") + what + " is " + std::to_string(size) +
                                          ", expected 1 to " + std::to_string(most));
    return size;
}

Layout layout_of(const Scene& scene, const RenderOptions& options) {
    Layout layout;
    layout.width = checked_size(options.width ? options.width : scene.image.width, "width", kLargestSize);
    layout.height = checked_size(options.height  ? options.height
                                 : options.width ? static_cast<int>(std::lround(static_cast<double>(layout.width) * scene.image.height / scene.image.width))
                                                 : scene.image.height,
                                 "height", kLargestSize);
    layout.pixel = static_cast<double>(layout.height) / scene.image.height;
    std::optional<double> letter;
    if (options.letter_points) letter = *options.letter_points * options.pixels_per_point;
    layout.views = views_of(scene, layout.width, layout.height, options.also_fit, letter);
    if (const double least = kLeastPrinted * options.pixels_per_point; (options.vectors || options.printed) && !letter && layout.views.front().letter < least)
        layout.views = views_of(scene, layout.width, layout.height, options.also_fit, least);
    for (View& v : layout.views) {
        set_points(v.objects, options.pixels_per_point / layout.pixel);
        set_radii(scene, v, options.pixels_per_point);
        if (v.inset && v.inset->line.points) v.inset->line = options.pixels_per_point / layout.pixel * v.inset->line.value;
    }
    return layout;
}

}  // namespace isoparm
