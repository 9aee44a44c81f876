// tessellate.h -- adaptive, crack-free triangulation whose error is proved.
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "bound.h"
#include "composite.h"
#include "mesh.h"

namespace isoparm {

/// fast: bisection only. optimal: then vertices move, edges flip and vertices are removed, under the same certificate.
enum class Quality { fast, optimal };

struct TessellationOptions {
    double tolerance = 0;                    // scene units, absolute, > 0: largest distance between mesh and surface, both ways
    Measure measure = Measure::parametric;   // geometric: the distance of the two sets; parametric: of points at equal parameters, never less
    std::size_t max_triangles = 20'000'000;  // budget; beyond it tessellate() throws Error(budget)
    std::function<void(double)> progress;    // called from the calling thread with a fraction in [0,1]; may be empty
    Quality quality = Quality::fast;
};

struct SurfaceReport {
    std::string name;
    std::size_t triangles = 0;
    double certified_error = 0;
    double optimal_triangles = 0;  // asymptotic optimum at this tolerance (interpolating vertices)
};

struct Tessellation {
    Mesh mesh;
    MeshTopology topology;
    double tolerance = 0;
    double certified_error = 0;  // proved: no point of either set is farther from the other; rounded up
    double sampled_error = 0;    // largest distance at equal parameters seen at sample points (parametric, as the certificate)
    std::vector<SurfaceReport> surfaces;
    double seconds_tessellate = 0, seconds_sample = 0;
};

/// Triangulates the composite so that certified_error <= options.tolerance. Edges that coincide are shared, vertices on
/// them are evaluated once. The result does not depend on the number of threads (TBB's current arena is used).
/// Throws Error(budget) that states what was reached and about how many triangles would be needed.
Tessellation tessellate(const Composite& surface, const TessellationOptions& options);

}  // namespace isoparm
