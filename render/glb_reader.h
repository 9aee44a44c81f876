// glb_reader.h -- triangle meshes of binary glTF 2.0 files (.glb), and of all files that verify reads.
//
// Read: every mesh that the nodes of the scene show, by the nodes' matrices; triangles, strips and fans of float32 positions in the file's own
// binary chunk, with indices of 8, 16 or 32 bits or none. Vertices of equal coordinates become one: glTF makes several where normals
// differ. Points and lines are passed over, as are materials, skins and morphs. What would need another reader (sparse accessors, other
// buffers, compressed or quantized positions) is refused by name, as is what needs more memory than its bytes account for.
#pragma once
#include <string>

#include "io/mesh_reader.h"

namespace isoparm {

/// `bytes` are the whole file. Throws Error(input): "path: byte N: found ..., expected ..." for the container, "path (JSON):line:column: at $..."
/// for what it says.
MeshFile read_glb(const std::string& bytes, const std::string& path);

/// Throws Error(usage) when the ending of a name is none of .ply, .obj, .stl or .glb.
void require_mesh_file(const std::string& path);

/// The file `path`, by its ending. Throws Error(io) when it cannot be read, Error(input) for bad data or when there is no triangle.
MeshFile read_mesh_file(const std::string& path);

}  // namespace isoparm
