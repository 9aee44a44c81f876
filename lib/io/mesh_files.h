// io/mesh_files.h -- triangle meshes as PLY, OBJ and STL.
#pragma once
#include <iosfwd>
#include <string>

#include "mesh.h"

namespace isoparm {
/// Binary little-endian PLY: doubles x y z, faces as int lists; vertices are shared, every double is exact.
void write_ply(std::ostream& out, const Mesh& mesh, const std::string& comment);
/// OBJ: one `g` a part, vertices in shortest decimals that read back exactly.
void write_obj(std::ostream& out, const Mesh& mesh, const std::string& comment);
/// Binary STL: float32 and unshared by the format; facets that float32 would collapse are left out and counted in the
/// returned number.
std::size_t write_stl(std::ostream& out, const Mesh& mesh);
/// Writes path in the format of its extension to a temporary name beside it, checks, syncs and renames; on failure the
/// old file stays. Throws Error(io), or Error(usage) for an extension that is not ply, obj or stl.
void write_mesh(const std::string& path, const Mesh& mesh, const std::string& comment);
}
