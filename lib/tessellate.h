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
    bool study = true;                       // false leaves sampled_error, optimal_triangles and, without a limit, normal_deviation 0
    std::function<void(double)> progress;    // called from the calling thread with a fraction in [0,1]; may be empty
    double normal_deviation = 0;             // degrees, below 90: largest angle between a triangle's normal and those of the surface over it; 0: any
    Quality quality = Quality::fast;
    bool bounds = false;                     // keep the bound of every triangle, MeshPart::bounds
    bool fans = false;                       // triangles at a collapsed edge are bounded together, so that a cone has few: parameters inside such a triangle are not
                                             // those of points near it. Without effect where `bounds` or `normal_deviation` ask about single triangles
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
    double normal_deviation = 0;  // degrees: proved for all triangles but normals_unproved; 0 with the parametric measure, which says nothing
    std::size_t normals_unproved = 0;  // triangles about whose normals nothing is proved; with options.normal_deviation smaller than the tolerance, at singular points
    std::vector<SurfaceReport> surfaces;
    double seconds_tessellate = 0, seconds_sample = 0;
};

/// Triangulates the composite so that certified_error <= options.tolerance. Edges that coincide are shared, vertices on
/// them are evaluated once. The result does not depend on the number of threads (TBB's current arena is used).
/// Throws Error(budget) that states what was reached and about how many triangles would be needed.
Tessellation tessellate(const Composite& surface, const TessellationOptions& options);

/// Edges nearer than this are one. The certificate holds whatever it is: vertices are charged their distance from every
/// patch that uses them. A sixteenth of the tolerance keeps that charge affordable.
double join_tolerance(double tolerance, double diagonal);

/// The asymptotic optimum of triangles of a patch at a tolerance, their vertices on the surface.
double optimal_triangles(const Patch& patch, double tolerance);

}  // namespace isoparm
