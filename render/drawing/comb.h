// comb.h -- curvature combs.
#pragma once
#include <array>
#include <vector>

#include "scene/scene.h"

namespace isoparm {

/// Curvature times the direction to its centre; zero where the curve stands still.
Point curvature_vector(const Curve& curve, double t);
/// Foot and tip of every tooth, along the curve; at a break one of each side. `size`: of the scene.
std::vector<std::array<Point, 2>> comb_teeth(const Curve& curve, const Comb& comb, double size);

}  // namespace isoparm
