// composite.h -- named patches that belong together. Which edges they share is found by geometry (topology.h).
#pragma once
#include <string>
#include <vector>

#include "patch.h"

namespace isoparm {

struct Member {
    std::string name;
    Patch patch;
};
using Composite = std::vector<Member>;

struct Bounds {
    Point low, high;
    double diagonal() const { return distance(low, high); }
};
/// From samples, refined at the extremes: accurate to about 1e-9 of its size, and never larger than the true box by more
/// than rounding. (Sampled, not proved.)
Bounds bounding_box(const Composite& surface);
Bounds bounding_box(const Curve& curve);
Bounds united(const Bounds& a, const Bounds& b);

}  // namespace isoparm
