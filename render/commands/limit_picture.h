// commands/limit_picture.h -- where on a limit surface the composite of `isoparm limit` is off it.
#pragma once
#include <string>

#include "commands/limit_report.h"

namespace isoparm {

/// A picture of the limit surface, coloured by the distance of the composite, one patch a face (Gregory's on quads, Nielson's on triangles), at the middles of small
/// triangles. Faces with a corner without tangents are as dark as those without a distance. Nothing is written where the cage has no exact limit surface.
void write_limit_picture(const std::string& path, const LimitResult& result);

}  // namespace isoparm
