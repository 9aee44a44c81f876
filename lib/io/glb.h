// io/glb.h -- triangle meshes as binary glTF 2.0.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "composite.h"
#include "mesh.h"

namespace isoparm {

struct GlbSurface {
    std::string name;
    Point color{0.8, 0.8, 0.8};  // linear RGB, 0 to 1
    double opacity = 1;
    std::vector<std::size_t> parts;  // of the mesh
};

/// One node, mesh, primitive and material a surface. Positions and normals are float32, the normals those of the exact surface (of the triangles
/// where it has none), towards the side about which triangles wind counter-clockwise; vertices are shared where both are equal. Indices are
/// uint32. Triangles that float32 makes degenerate, and surfaces without any other, are left out. Coordinates are the scene's, whichever
/// of its axes points up. Throws Error(io) beyond 4 GiB.
void write_glb(std::ostream& out, const Mesh& mesh, const Composite& surface, const std::vector<GlbSurface>& surfaces);

}  // namespace isoparm
