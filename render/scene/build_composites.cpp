// build_composites.cpp -- surfaces that a scene file makes of surfaces, or reads from other files.
#include <algorithm>
#include <cmath>

#include "io/bv.h"
#include "io/extension.h"
#include "curves/modify.h"
#include "patches/transformed.h"
#include "promises.h"
#include "scene/registry.h"
#include "scene/suggest.h"

namespace isoparm {

namespace {
constexpr std::size_t kMaxPatches = 100'000;

void append(ControlNet& net, const ControlNet& more) {
    const int first = static_cast<int>(net.points.size());
    net.points.insert(net.points.end(), more.points.begin(), more.points.end());
    net.indices.insert(net.indices.end(), more.indices.begin(), more.indices.end());
    for (const auto& rod : more.rods) net.rods.push_back({rod[0] + first, rod[1] + first});
}
/// A member of a composite, and where its patches begin there.
struct Examined {
    std::string name;
    std::size_t first_patch;
    std::function<DataReport()> examine;
};
DataReport together(const std::vector<Examined>& members) {
    DataReport all;
    for (const Examined& m : members) {
        DataReport r = m.examine();
        for (Condition& c : r.conditions) c.what = m.name + ": " + c.what, all.conditions.push_back(c);
        all.twists.insert(all.twists.end(), r.twists.begin(), r.twists.end());
        for (const std::size_t p : r.smooth) all.smooth.push_back(p + m.first_patch);
        for (Promise& p : r.promises) p.what = m.name + ": " + p.what, p.patch += m.first_patch, all.promises.push_back(p);
    }
    return all;
}

/// Conditions, and the gaps of twists, are those of the data before the map.
DataReport moved(DataReport r, const Transform& map) {
    Transform linear = map;
    for (auto& row : linear.m) row[3] = 0;
    double stretch = 0;
    for (int k = 0; k < 3; ++k) stretch = std::max(stretch, std::hypot(map.m[0][k], map.m[1][k], map.m[2][k]));
    for (TwistPair& t : r.twists) t.at = map.point(t.at), t.of_f = map.vector(t.of_f), t.of_g = map.vector(t.of_g);
    for (Promise& p : r.promises) {
        p.curve = transformed(p.curve, p.derivative == 0 ? map : linear), p.allowed *= stretch;
        // Lengths grow by less than the sum of the columns'; a moved patch is rounded by itself, which its bounds know.
        if (p.on_edge) p.on_edge = transformed(*p.on_edge, map), p.slack *= 4 * stretch;
    }
    return r;
}
}  // namespace

// A member with one patch gives it its name, a member with several puts its name before theirs: "body/lid#2".
BuiltSurface build_composite(const Json& j, SceneBuilder& scene) {
    BuiltSurface all{Composite{}};
    std::set<std::string> names;
    std::vector<Examined> examined;
    for (const Json& m : scene.values().list(j.at("members", "the surfaces that belong together"), 1, 0, "surfaces")) {
        const BuiltSurface member = scene.surface(m);
        const std::string name = m.is(Json::Kind::string) ? m.string() : "#" + std::to_string(names.size());
        if (!names.insert(name).second) m.fail("found " + quoted(name) + " for the second time, expected every member once");
        if (member.examine) examined.push_back({name, all.patches.size(), member.examine});
        for (const Member& p : member.patches) all.patches.push_back({p.name.empty() ? name : name + "/" + p.name, p.patch});
        if (all.patches.size() > kMaxPatches) m.fail("found more than " + std::to_string(kMaxPatches) + " patches, expected fewer");
        append(all.net, member.net);
    }
    if (!examined.empty()) all.examine = [examined] { return together(examined); };
    return all;
}

BuiltSurface build_transformed_surface(const Json& j, SceneBuilder& scene) {
    BuiltSurface s = scene.surface(j.at("surface", "the surface to move"));
    const Transform m = scene.values().transform(j);
    for (Member& p : s.patches) p.patch = transformed(p.patch, m);
    for (Point& p : s.net.points) p = m.point(p);
    if (s.examine) s.examine = [m, before = s.examine] { return moved(before(), m); };
    return s;
}

BuiltSurface build_file(const Json& j, SceneBuilder& scene) {
    const Json path = j.at("path", "the name of a .bv file, relative to the scene");
    if (extension_of(scene.values().text(path, "the name of a .bv file, relative to the scene")) != ".bv") path.expected("a file that ends in .bv (other formats are not read)");
    const IncludedFile file = scene.included(path, "a BV file");
    return BuiltSurface(read_bv(file.text, file.path));
}

}  // namespace isoparm
