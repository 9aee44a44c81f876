// surface_lines.h -- parameter lines of surfaces as vectors, where the tracer would paint them.
#pragma once
#include "composite.h"
#include "drawing/drawing.h"
#include "rays/sight.h"

namespace isoparm {

/// One item for all lines that are seen alike. `pixel`: pixels of this picture to one of the scene's; `size`: diagonal of the scene. Lines
/// on an edge that patches share are drawn once. Where they crowd they fade, in steps.
void add_isolines(const Composite& patches, const Isolines& lines, double pixel, double size, const Sight& sight, Drawing& drawing);

}  // namespace isoparm
