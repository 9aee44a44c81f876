// optimize.h -- fewer triangles under the same certificate; internal to tessellate.cpp.
#pragma once
#include <functional>

#include "tessellation/refine.h"

namespace isoparm {

/// Takes a refinement whose triangles all keep the tolerance, and replaces it by one with fewer triangles: vertices move, edges flip, and
/// vertices are removed where their neighbours can take over, until little is gained. Every triangle is marked as fresh: the
/// refinement itself has to prove the result. The same for every number of threads.
void optimize(Refinement& refinement, const Composite& surface, const Topology& topology, double tolerance, Measure measure,
              const std::function<void(double)>& progress);

}  // namespace isoparm
