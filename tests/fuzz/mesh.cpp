// Any bytes as a mesh file, the first one choosing the format: triangles of vertices that are there, or an isoparm::Error that says where.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "error.h"
#include "glb_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    static const char* const names[] = {"fuzz.ply", "fuzz.obj", "fuzz.stl", "fuzz.glb"};
    const int format = data[0] % 4;
    const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    try {
        const isoparm::MeshFile file = format == 3 ? isoparm::read_glb(bytes, names[3]) : isoparm::read_mesh(bytes, names[format]);
        for (const auto& t : file.mesh.triangles)
            for (const auto v : t)
                if (v >= file.mesh.points.size()) std::abort();
    } catch (const isoparm::Error&) {
    }
    return 0;
}
