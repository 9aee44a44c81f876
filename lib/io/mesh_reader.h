// io/mesh_reader.h -- triangle meshes from PLY, OBJ and STL files, whoever wrote them.
//
// Nothing in a file is believed before it is checked: counts against the bytes that are there, indices against the vertices,
// coordinates to be finite. What does not fit is Error(input) "path:line:column: found ..., expected ..." in text and
// "path: byte N: found ..., expected ..." in binary data.
#pragma once
#include <string>

#include "triangle_mesh.h"

namespace isoparm {

struct MeshFile {
    TriangleMesh mesh;
    std::string format;        // "PLY, binary, little-endian" ...
    std::size_t polygons = 0;  // faces of more than three corners, which were cut into fans about their first corner
    std::size_t welded = 0;    // vertices of an STL file, which shares none, that are equal to another one and became one with it
};

/// Throws Error(usage) when the ending of a name is none of .ply, .obj or .stl, in capitals or not.
void require_mesh_name(const std::string& path);

/// `bytes` are the whole file; the ending of `path` says in which format: .ply, .obj or .stl, in capitals or not. Throws Error(usage)
/// for another one, and Error(input) for bad data or when there is no triangle.
MeshFile read_mesh(const std::string& bytes, const std::string& path);

/// The same by format. PLY: ascii, binary in either order of bytes; the elements vertex (x, y, z) and face (vertex_indices or
/// vertex_index), all others are passed over. OBJ: v and f, negative indices too; points, lines, groups and materials are passed over.
/// STL: ascii or binary; normals are passed over.
MeshFile read_ply(const std::string& bytes, const std::string& path);
MeshFile read_obj(const std::string& bytes, const std::string& path);
MeshFile read_stl(const std::string& bytes, const std::string& path);

}  // namespace isoparm
