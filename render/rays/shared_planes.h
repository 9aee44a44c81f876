// shared_planes.h -- flat surfaces that lie in one plane and cover each other: rays meet both at one place, and a rule must say which is seen.
#pragma once
#include "rays/embree_scene.h"
#include "scene/scene.h"

namespace isoparm {

/// For each object and each of its patches the plane that it shares: the patch is flat but for rounding, and in its plane lies such a patch of another object that may overlap it.
/// Told by samples of the patches, and their convex hulls in the plane. Flat is what is within 1e-6 sizes of the scene of a plane, in one plane what is within 2e-6 of the other's;
/// so hits up to 4e-6 apart are at one place. Empty for an object none of whose patches shares its plane.
std::vector<std::vector<EmbreeScene::Plane>> shared_planes(const Scene& scene, const std::vector<SceneObject>& objects, double size);

}  // namespace isoparm
