// scene_axes.h -- axes and arrows of a scene file, and places on what they and labels stand on.
#pragma once
#include "scene/scene_builder.h"

namespace isoparm {

/// Throw LocatedError: where, what was found, what was expected.
Axes read_axes(const Json& j, const SceneValues& values);
/// From point to point, or a derivative or normal of a surface of one patch or a curve.
Arrow read_arrow(const Json& j, SceneBuilder& builder);
/// A parameter of the curve, or [u, v] in the domain of the patch.
double place_on(const Curve& curve, const Json& at, const SceneValues& values);
Vec2 place_on(const Patch& patch, const Json& at, const SceneValues& values);

}  // namespace isoparm
