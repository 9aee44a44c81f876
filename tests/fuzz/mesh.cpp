// Any bytes as a mesh file, the first one choosing the format: triangles of vertices that are there, or an isoparm::Error that says where.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "error.h"
#include "io/mesh_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    static const char* const names[] = {"fuzz.ply", "fuzz.obj", "fuzz.stl"};
    try {
        const isoparm::MeshFile file = isoparm::read_mesh(std::string(reinterpret_cast<const char*>(data) + 1, size - 1), names[data[0] % 3]);
        for (const auto& t : file.mesh.triangles)
            for (const auto v : t)
                if (v >= file.mesh.points.size()) std::abort();
    } catch (const isoparm::Error&) {
    }
    return 0;
}
