// scene_views.h -- what a scene file says of its views: cameras, panels, insets.
#pragma once
#include <optional>

#include "scene/scene_builder.h"

namespace isoparm {

/// Throw LocatedError: where, what was found, what was expected.
CameraSettings read_camera(const Json& j, const SceneValues& values);
/// "panels" with "layout" and "marks", and "insets", of a scene file.
void read_panels(const Json& root, SceneBuilder& builder, Scene& scene);

}  // namespace isoparm
