// verify.h -- how far a mesh made by anyone and a surface are apart: a proved interval for each way.
//
// The surface is replaced by a finer mesh whose distance from it is certified (tessellate.h); the distance of two meshes is bounded
// from above by cutting the triangles of one along the sides of the other, and from below at points. docs/certificates.md has the proof.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "composite.h"
#include "triangle_mesh.h"

namespace isoparm {

struct VerifyOptions {
    double gap = 0.05;                      // upper - lower <= gap * upper is what is tried for, each way
    std::optional<double> limit;            // and that the limit does not lie between lower and upper
    std::size_t max_triangles = 2'000'000;  // of the finer mesh: the budget
    std::function<void(double)> progress;   // called from the calling thread with a fraction in [0,1]; may be empty
};

/// lower <= the largest distance of a point of one set from the other set <= upper, proved.
struct DirectedDistance {
    double lower = 0, upper = 0;
    Point at;                   // where `lower` was found: a point of the mesh, or of the surface and then within the finer mesh's error of one that is so far
    std::size_t member = 0;     // surface to mesh: the patch, and parameters
    Vec2 uv;
    std::size_t triangle = 0;   // mesh to surface: the triangle
    bool narrowed = false;      // within the gap, and beside the limit if there is one
};

/// Angles between triangles and the surface at their middles: seen, not proved. Degrees, at most 90: sides do not count.
struct NormalDeviation {
    double mean = 0, most = 0;
    std::size_t worst = 0;      // triangle
    std::size_t compared = 0;   // triangles; degenerate ones, and those beside a place without normal, are left out
    std::size_t against = 0;    // of these, triangles whose side is the other one than that of most triangles
};

struct Verification {
    DirectedDistance surface_to_mesh, mesh_to_surface;
    NormalDeviation normals;
    double usual = 0;                          // nine in ten of the mesh's triangles have their middle so near to the surface: seen, not proved
    std::vector<std::array<Point, 2>> border;  // of the surface: the open edges of the finer mesh, within its error of the surface's
    std::size_t finer_triangles = 0;           // what the surface was replaced by, and how far that is from it
    double finer_error = 0;
    std::string stopped;                       // why it was not narrowed further; empty where it was narrowed

    double lower() const { return std::max(surface_to_mesh.lower, mesh_to_surface.lower); }
    double upper() const { return std::max(surface_to_mesh.upper, mesh_to_surface.upper); }
};

/// At least one triangle and one patch. Throws Error(input) for coordinates beyond 1e50, and Error(budget) when even the coarsest finer
/// mesh is beyond the budget. The result does not depend on the number of threads.
Verification verify(const TriangleMesh& mesh, const Composite& surface, const VerifyOptions& options);

}  // namespace isoparm
