#include "io/mesh_reader.h"

#include "error.h"
#include "io/extension.h"
#include "io/mesh_scanner.h"

namespace isoparm {

void require_mesh_name(const std::string& path) {
    const std::string extension = extension_of(path);
    if (extension != ".ply" && extension != ".obj" && extension != ".stl")
        throw Error(ErrorKind::usage, path + ": found the extension " + in_quotes(extension) + ", expected .ply, .obj or .stl");
}

MeshFile read_mesh(const std::string& bytes, const std::string& path) {
    require_mesh_name(path);
    const std::string extension = extension_of(path);
    MeshFile file = extension == ".ply" ? read_ply(bytes, path) : extension == ".obj" ? read_obj(bytes, path) : read_stl(bytes, path);
    if (file.mesh.triangles.size() > kMostElements) throw_input(path + ": found " + std::to_string(file.mesh.triangles.size()) + " triangles, expected at most " + std::to_string(kMostElements));
    if (file.mesh.triangles.empty()) throw_input(path + ": found no triangle, expected at least one");
    return file;
}

}  // namespace isoparm
