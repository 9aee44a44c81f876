#include "commands/selection.h"

#include <algorithm>
#include <limits>
#include <set>

#include "error.h"
#include "picture/camera.h"
#include "picture/layout.h"

namespace isoparm {
namespace {

void add_surface(Selection& all, const std::string& surface, const Composite& patches, bool prefix) {
    for (const Member& m : patches) {
        all.patches.push_back({prefix && patches.size() > 1 ? surface + "/" + m.name : m.name, m.patch});
        all.surface.push_back(surface);
    }
}

}  // namespace

Selection select_patches(const Scene& scene, const Options& options) { return select_patches(scene, options.value("--surface")); }

Selection select_patches(const Scene& scene, const std::optional<std::string>& surface) {
    Selection all;
    if (surface) {
        add_surface(all, *surface, find_patches(scene, *surface), false);
        return all;
    }
    std::set<std::string> drawn;
    for (const SceneObject& o : scene.objects)
        if (o.kind == SceneObject::Kind::surface) drawn.insert(o.name);
    if (drawn.empty()) throw_input(scene.place + ": found no surface that is drawn, expected one; name one with --surface");
    for (const Surface& s : scene.surfaces)
        if (drawn.count(s.name)) add_surface(all, s.name, s.patches, drawn.size() > 1);
    return all;
}

double absolute_tolerance(const Tolerance& t, const Scene& scene, const Bounds& box) {
    const double diagonal = finite_diagonal(scene, box);
    double pixel = std::numeric_limits<double>::infinity();
    if (t.unit == Tolerance::Unit::pixels)
        for (const View& view : layout_of(scene, {}).views) pixel = std::min(pixel, finest_pixel(camera_of(view), box));
    return t.absolute(diagonal, pixel);
}

double absolute_tolerance(const Tolerance& t, double diagonal, const Options& options) {
    if (t.unit == Tolerance::Unit::pixels) options.fail("a tolerance in pixels needs a picture: give --tolerance in scene units or with rel");
    return t.absolute(diagonal, 0);
}

}  // namespace isoparm
