// isolines.h -- parameter lines of constant width in the picture.
#pragma once
#include <array>
#include <vector>

#include "patch.h"
#include "picture/camera.h"
#include "scene/scene.h"

namespace isoparm {

/// What a sample needs to know of its place on a patch.
struct PatchPlace {
    Domain domain = Domain::quad;
    Rect rect;
    double u = 0, v = 0;
    Point du, dv;  // S_u, S_v, finite
};

/// By how much u, v and (on triangles) w change a pixel of the picture; infinite where the surface is seen edge on.
std::array<double, 3> parameters_a_pixel(const PatchPlace& place, const Camera& camera, const Point& position, const Point& direction);
/// 1; less, down to 0, where lines so far apart in the parameter come closer to each other than they are wide.
double isoline_fade(double a_pixel, double step, double width);
/// Where the lines of a family are: `count` over [low, high], ends included; a single one is in the middle.
double isoline_step(int count, double low, double high);
std::vector<double> isoline_places(int count, double low, double high);

/// How much of the line colour covers a sample at `position`, seen along `direction`; 0 off the lines. The distance to
/// the nearest line is that of the parameter divided by its gradient over the picture (first order), so lines are as
/// wide as asked wherever the surface is seen from, and fade where they come closer to each other than they are wide.
/// On triangles a third family w = const joins, as many as the larger of the two others.
double isoline_cover(const Isolines& lines, const PatchPlace& place, const Camera& camera, const Point& position,
                     const Point& direction);

}  // namespace isoparm
