// surfel_kernel.h -- normals and clear places of surfels, side by side; internal to surfel.cpp.
//
// Each loop is compiled for several instruction sets, which give the same bits. A surfel's numbers do not depend on those beside it.
#pragma once
#include <cstdint>

#include "batch.h"

namespace isoparm {

/// Loops take whole groups of lanes: those of the last group beyond the last surfel must hold some surfel too.
struct SurfelLanes {
    static constexpr int lanes = 16, group = 8;
    alignas(64) double view[3][lanes];                                 // unit, toward the viewer
    double clear[lanes];                                               // how far from surface and mesh rays begin
    double corner[3][3][lanes], u[lanes], v[lanes];                    // of the triangle that was met, and where on it
    double frame[9][lanes];                                            // S, S_u, S_v: S is the position
    double on_mesh[3][lanes], outward[3][lanes];                       // where the ray met; the unit normal that tells front from back
    double normal[3][lanes];                                           // unit, of the surface
    std::int64_t regular[lanes];                                       // not 0: S_u and S_v span a plane, and S is finite
    std::int64_t toward[lanes];                                        // not 0: the viewer is on the side of `outward`
    double geometric[3][lanes], shading[3][lanes], facing[3][lanes];   // outward and normal on the viewer's side; bent just enough to face the viewer
    double origin[3][lanes], beneath[3][lanes];                        // clear of both surface and mesh, on the viewer's side and the other
};

struct SurfelKernel {
    /// Sets on_mesh, outward, normal and regular from corners and frames.
    void (*normals)(int n, SurfelLanes& p);
    /// Sets what is below `regular`.
    void (*places)(int n, SurfelLanes& p);
};
const SurfelKernel& surfel_kernel(Isa isa);

}  // namespace isoparm
