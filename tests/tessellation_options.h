// tessellation_options.h -- what most tests ask of tessellate().
#pragma once
#include "composite.h"
#include "tessellate.h"

namespace isoparm::tests {

/// The tolerance is relative to the diagonal of the bounding box.
inline TessellationOptions options_of(const Composite& surface, double relative, Measure measure) {
    TessellationOptions options;
    options.tolerance = relative * bounding_box(surface).diagonal();
    options.measure = measure;
    return options;
}

}  // namespace isoparm::tests
