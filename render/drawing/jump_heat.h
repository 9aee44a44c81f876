// jump_heat.h -- how much a surface jumps across the edges of its patches and cells, for lines coloured by it. Sampled: check proves.
#pragma once
#include <vector>

#include "picture/curvature_map.h"

namespace isoparm {

struct HotEdge {
    std::vector<Point> points;  // along the edge
    std::vector<double> jumps;  // as many; NaN where there is none
};
/// Of every shared edge, seam and line between cells (continuity.h). `size`: the diagonal of the scene's box.
std::vector<HotEdge> hot_edges(const Composite& surface, JumpHeat::Of of, double size);
/// From 0 to the largest jump. What is no more than rounding, in degrees or for the scene's size, does not count: then to 1 degree, or 1 / size.
ColorScale scale_of(const JumpHeat& heat, const std::vector<HotEdge>& edges, double size);

}  // namespace isoparm
