// surfel.h -- from a hit of the mesh to the point of the exact surface that it stands for.
#pragma once
#include "light/shade.h"
#include "rays/traced_scene.h"

namespace isoparm {

/// Position and normal are those of the patch at the hit's parameters (of its mesh, or of itself), in double, with the limit normal at poles and
/// apexes and the mesh's where there is none.
/// One for each of the n hits, hit k by rays[k], into surfels as they are constructed; n is at most EmbreeScene::packet.
void surfels_at(const TracedScene& scene, const Camera& camera, const Ray* rays, const Hit* hits, int n, Surfel* out);

/// Where a ray meets the ground, at that distance.
Surfel ground_surfel(const Ground& ground, const Ray& ray, double distance, const TracedScene& scene);

}  // namespace isoparm
