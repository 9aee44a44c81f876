// drawn.h -- what a scene draws, where it is and how thick.
#pragma once
#include <vector>

#include "scene/scene.h"

namespace isoparm {

/// The scene's objects, or all its surfaces and curves when it has none.
std::vector<SceneObject> drawn_objects(const Scene& scene);
/// The surface or curve that an object names. Throws Error(input) when there is none.
const Surface& surface_of(const Scene& scene, const SceneObject& o);
const Curve& curve_of(const Scene& scene, const SceneObject& o);
/// Radius of an object's tubes, rods or ball; `size` is the diagonal of the scene's box.
double radius_of(const SceneObject& o, double size);
inline constexpr double kNetBall = 2.2;  // balls of a net, in radii of its rods
/// Points all over what is drawn, for cameras that fit. Do not depend on a tolerance.
std::vector<Point> drawn_points(const Scene& scene);
std::vector<Point> drawn_points(const Scene& scene, const std::vector<SceneObject>& objects);

}  // namespace isoparm
