// Any bytes as a scene file: a scene whose curves and surfaces can be evaluated, or an isoparm::Error that says where. scene_mesh.cpp goes on
// from there; this one is quick. It has no folder: files that a scene includes are refused, as bv.cpp and cage.cpp read them. Subdivision surfaces, of
// which one takes as long to make as a hundred others, are left to scene_mesh.cpp.
#include <tbb/global_control.h>

#include "error.h"
#include "scene/scene_file.h"
#include "scene_mutator.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    if (text.find("subdivision") != text.npos) return 0;
    static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    try {
        const isoparm::Scene scene = isoparm::parse_scene(text, "/no/folder/fuzz.json");
        for (const auto& [name, curve] : scene.curves) curve((curve.begin() + curve.end()) / 2);
        for (const auto& surface : scene.surfaces) {
            const isoparm::Patch& patch = surface.patches.front().patch;
            const auto r = patch.rect();
            isoparm::evaluate(patch, r.u0, r.v0);
            isoparm::evaluate(patch, (r.u0 + 2 * r.u1) / 3, (2 * r.v0 + r.v1) / 3);
        }
    } catch (const isoparm::Error&) {
    }
    return 0;
}
