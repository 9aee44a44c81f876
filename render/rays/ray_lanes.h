// ray_lanes.h -- rays side by side, as Embree and the loops of several instruction sets take them.
#pragma once
#include "picture/camera.h"

namespace isoparm {

/// Rays without end. Every lane must hold a ray: those beyond the last one, any.
struct RayLanes {
    static constexpr int lanes = 16;
    alignas(64) double origin[3][lanes];
    double direction[3][lanes];

    Ray operator[](int i) const { return {{origin[0][i], origin[1][i], origin[2][i]}, {direction[0][i], direction[1][i], direction[2][i]}}; }
    void set(int i, const Ray& ray) {
        for (int k = 0; k < 3; ++k) origin[k][i] = ray.origin[k], direction[k][i] = ray.direction[k];
    }
};

}  // namespace isoparm
