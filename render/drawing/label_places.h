// label_places.h -- where on a surface its name may stand.
#pragma once
#include <vector>

#include "composite.h"

namespace isoparm {

/// Parameters near the middle of a patch, the best first.
std::vector<Vec2> middle_places(const Patch& patch);
/// Points all over a surface, about `most` of them and at least one of each patch.
std::vector<Point> places_all_over(const Composite& patches, std::size_t most);

}  // namespace isoparm
