// tessellate.cpp -- certified triangles a second: everything that tessellate() does, from patches to a mesh with its
// error proved, its topology counted and its error sampled.
#include "tessellate.h"

#include <stdexcept>

#include "cases.h"
#include "drawing/drawn.h"

namespace isoparm::bench {

Composite patches_of(const std::string& scene_name) {
    const Scene scene = load_scene(ISOPARM_SOURCE_DIR "/scenes/" + scene_name + ".json");
    Composite all;
    for (const SceneObject& o : drawn_objects(scene))
        if (o.kind == SceneObject::Kind::surface)
            for (const Member& m : surface_of(scene, o).patches) all.push_back(m);
    return all;
}

namespace {

Work tessellate_once(const Composite& surface, double relative, Measure measure = Measure::geometric, Quality quality = Quality::fast) {
    TessellationOptions options;
    options.tolerance = relative * bounding_box(surface).diagonal();
    options.measure = measure;
    options.quality = quality;
    options.fans = true;
    const Tessellation t = tessellate(surface, options);
    if (!(t.certified_error <= t.tolerance) || t.topology.t_junctions > 0)
        throw std::logic_error("the mesh is not what was asked for");
    double optimal = 0;
    for (const SurfaceReport& r : t.surfaces) optimal += r.optimal_triangles;
    const double n = static_cast<double>(t.mesh.triangle_count());
    return {n, {{"triangles", n}, {"of optimum", n / optimal}, {"proved/seen", t.certified_error / t.sampled_error}}};
}

}  // namespace

std::vector<Case> tessellation_cases() {
    struct {
        const char *scene, *title;
    } const surfaces[] = {{"teapot", "teapot, 32 bicubic patches"},
                          {"sphere", "sphere, 8 rational octants"},
                          {"s002_fig4", "2x2 Coons network"},
                          {"side_vertex", "side-vertex triangle"}};
    std::vector<Case> cases;
    for (const auto& [scene, title] : surfaces) {
        const Composite patches = patches_of(scene);
        const std::string table = std::string("tessellation: ") + title;
        for (const auto& [text, relative] : {std::pair{"1e-2", 1e-2}, {"1e-3", 1e-3}, {"1e-4", 1e-4}, {"1e-5", 1e-5}}) {
            Case c{table, std::string(text) + ", one thread", "triangles",
                   [patches, relative = relative] { return tessellate_once(patches, relative); }};
            c.reference = relative == 1e-4;
            if (relative < 5e-5) c.repetitions = 3;  // they take seconds
            cases.push_back(std::move(c));
        }
        cases.push_back({table, "1e-4, one thread, parametric", "triangles", [patches] { return tessellate_once(patches, 1e-4, Measure::parametric); }});
        Case optimal{table, "1e-3, one thread, optimal", "triangles", [patches] { return tessellate_once(patches, 1e-3, Measure::geometric, Quality::optimal); }};
        optimal.repetitions = 1;  // they take many seconds
        cases.push_back(std::move(optimal));
        Case c{table, "1e-4, all cores", "triangles", [patches] { return tessellate_once(patches, 1e-4); }};
        c.clock = Clock::wall;
        cases.push_back(std::move(c));
    }
    return cases;
}

}  // namespace isoparm::bench
