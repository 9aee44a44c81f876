// shared_planes.h -- flat surfaces that lie in one plane and cover each other: rays meet both at one place, and a rule must say which is seen.
#pragma once
#include "scene/scene.h"

namespace isoparm {

/// For each object: is it a surface, flat but for rounding, in whose plane another such object lies that may overlap it? By samples of the patches, and their convex hulls in the plane.
std::vector<char> shared_planes(const Scene& scene, const std::vector<SceneObject>& objects, double size);

}  // namespace isoparm
