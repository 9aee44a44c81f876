// Any bytes as a scene file: a scene whose surfaces evaluate and tessellate, or an isoparm::Error that says where.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "error.h"
#include "scene.h"
#include "tessellate.h"

namespace {

std::string temporary_file() {
    char name[] = "/tmp/isoparm-fuzz-XXXXXX";
    const int fd = mkstemp(name);
    if (fd < 0) std::abort();
    static std::string path;
    path = name;
    std::atexit([] { std::remove(path.c_str()); });
    return path;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string path = temporary_file();
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file || std::fwrite(data, 1, size, file) != size || std::fclose(file) != 0) std::abort();
    try {
        const isoparm::Scene scene = isoparm::load_scene(path);
        for (const auto& surface : scene.surfaces) {
            isoparm::TessellationOptions options;
            options.tolerance = 0.1 * isoparm::bounding_box(surface.patches).diagonal();
            options.max_triangles = 500;
            if (options.tolerance > 0) isoparm::tessellate(surface.patches, options);
        }
    } catch (const isoparm::Error&) {
    }
    return 0;
}
