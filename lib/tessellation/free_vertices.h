// free_vertices.h -- meshes whose vertices leave the surface, so that its error is spread to both sides.
#pragma once
#include "tessellate.h"

namespace isoparm {

/// Triangulates at a coarser tolerance, moves vertices along normals until the surface lies as far on one side of the triangles as on the other,
/// and proves the tolerance by sliding (docs/certificates.md, "Certificate files"); the coarsest mesh that is found so, or tessellate()'s where none
/// is. Nothing is proved about normals. On convex pieces about half the triangles,
/// for some ten times the time. Throws what tessellate() throws.
Tessellation tessellate_free(const Composite& surface, const TessellationOptions& options);

}  // namespace isoparm
