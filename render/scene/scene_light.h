// scene_light.h -- reads "lighting" of a scene and "material" of an object (docs/light.md).
#pragma once
#include "light/light.h"
#include "scene/scene_values.h"

namespace isoparm {

/// "metal", or {"type": "metal", "roughness": 0.2}. Throws LocatedError.
Material read_material(const Json& j, const SceneValues& values);
/// true, or {"up": ..., "height": ..., "shadow": ...}; nothing for false. Throws LocatedError.
std::optional<Ground> read_ground(const Json& j, const SceneValues& values);
/// "studio", or {"bounces": n, "lights": [...]}. Throws LocatedError.
LightingSettings read_lighting(const Json& j, const SceneValues& values);

}  // namespace isoparm
