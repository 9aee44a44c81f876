// Any bytes as a scene file: a scene whose surfaces, examined and tessellated, give finite meshes, or an isoparm::Error that says where.
#include <tbb/global_control.h>

#include <cmath>
#include <cstdlib>

#include "error.h"
#include "promises.h"
#include "scene/scene_file.h"
#include "scene_mutator.h"
#include "tessellate.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace isoparm;
    static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    try {
        const Scene scene = parse_scene({reinterpret_cast<const char*>(data), size}, "/no/folder/fuzz.json");
        for (const auto& surface : scene.surfaces) {
            if (surface.patches.size() > 20) continue;
            if (surface.examine) surface.examine();
            TessellationOptions options;
            options.tolerance = 0.1 * bounding_box(surface.patches).diagonal();
            options.max_triangles = 200;
            options.study = false;
            if (!(options.tolerance > 0)) continue;
            for (const Point& p : tessellate(surface.patches, options).mesh.positions)
                if (!finite(p)) std::abort();
        }
    } catch (const Error&) {
    }
    return 0;
}
