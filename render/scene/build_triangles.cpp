// build_triangles.cpp -- surfaces that a scene file gives by the three edges of a triangle: one row for each method.
#include <algorithm>

#include "patches/bbg.h"
#include "patches/nielson.h"
#include "patches/side_vertex.h"
#include "patches/three_curves.h"
#include "promises.h"
#include "scene/registry.h"
#include "scene/repair.h"

namespace isoparm {

namespace {

using Three = std::array<Curve, 3>;

constexpr const char* common_keys[] = {"type", "method", "edges", "repair"};  // and "loop", where there is nothing along the edges

struct Method {
    const char* name;
    std::vector<std::string> keys;   // besides common_keys
    std::vector<std::string> parts;  // the whole first; none: it has no parts
    const char* along;               // the key of the curves given along the edges; none: nullptr
    Patch (*build)(const Json& j, SceneBuilder& scene, const TriangleCurves& curves, std::size_t part);
};

Three three(const Json& j, const char* key, const char* meaning, SceneBuilder& scene) {
    const auto c = scene.curves(j.at(key, meaning), 3, 3);
    return {c[0], c[1], c[2]};
}

const char* along_meaning(const std::string& key) {
    return key == "cross" ? "the cross derivatives [D1, D2, D3] along the edges, in the direction of the medians" : "the normals [N1, N2, N3] along the edges";
}

Patch build_side_vertex(const Json& j, SceneBuilder& scene, const TriangleCurves& curves, std::size_t part) {
    static constexpr SideVertexForm forms[] = {SideVertexForm::delta, SideVertexForm::seed};
    static constexpr SideVertexPart parts[] = {SideVertexPart::sum, SideVertexPart::s1, SideVertexPart::s2, SideVertexPart::s3, SideVertexPart::s4};
    const auto H = j.find("H"), form = j.find("form");
    return make_side_vertex(curves.edges, H ? scene.values().function(*H, 0, 1) : Function::polynomial({0, 0, 1}),
                            form ? forms[scene.values().word(*form, {"delta", "seed"})] : SideVertexForm::delta, parts[part]);
}

template <BbgForm::Kind kind> Patch build_bbg(const Json& j, SceneBuilder& scene, const TriangleCurves& curves, std::size_t part) {
    BbgForm form{kind};
    if (const auto list = j.find("projectors")) {
        const std::string meaning = "two different projectors, as [\"P1\", \"P2\"]";
        const auto two = scene.values().list(*list, 2, 2, meaning);
        form.i = 1 + int(scene.values().word(two[0], {"P1", "P2", "P3"}));
        form.j = 1 + int(scene.values().word(two[1], {"P1", "P2", "P3"}));
        if (form.i == form.j) two[1].expected(meaning);
    }
    if (part == 4) form.kind = BbgForm::Kind::product;
    else if (part > 0) form = {BbgForm::Kind::projector, int(part)};
    return make_bbg(curves.edges, form);
}

const std::vector<Method>& methods() {
    using Curves = const TriangleCurves&;
    const auto three_curves = [](const Json&, SceneBuilder&, Curves c, std::size_t) { return make_three_curves(c.edges); };
    const auto bbg_c1 = [](const Json&, SceneBuilder&, Curves c, std::size_t part) { return make_bbg_c1(c.edges, c.along, TrianglePart(part)); };
    const auto nielson_c1 = [](const Json&, SceneBuilder&, Curves c, std::size_t part) { return make_nielson_c1(c.edges, c.along, TrianglePart(part)); };
    const auto nielson_g1 = [](const Json&, SceneBuilder&, Curves c, std::size_t part) { return make_nielson_g1(c.edges, c.along, TrianglePart(part)); };
    static const std::vector<std::string> projectors{"sum", "P1", "P2", "P3"}, rays{"sum", "T1", "T2", "T3"};
    static const std::vector<Method> list{
        {"side_vertex", {"H", "form", "part"}, {"sum", "s1", "s2", "s3", "s4"}, nullptr, build_side_vertex},
        {"three_curves", {}, {}, nullptr, three_curves},
        {"bbg_convex", {"part"}, projectors, nullptr, build_bbg<BbgForm::Kind::convex>},
        {"bbg_boolean", {"projectors", "part"}, {"sum", "P1", "P2", "P3", "P1P2"}, nullptr, build_bbg<BbgForm::Kind::boolean>},
        {"bbg_symmetric", {"part"}, projectors, nullptr, build_bbg<BbgForm::Kind::symmetric>},
        {"bbg_c1", {"cross", "part"}, projectors, "cross", bbg_c1},
        {"nielson_c1", {"cross", "part"}, rays, "cross", nielson_c1},
        {"nielson_g1", {"normals", "part"}, rays, "normals", nielson_g1},
    };
    return list;
}

}  // namespace

std::map<std::string, std::vector<std::string>> triangle_methods() {
    std::map<std::string, std::vector<std::string>> keys;
    for (const auto& m : methods()) {
        keys[m.name] = {"edges", "repair"};
        if (!m.along) keys[m.name].push_back("loop");
        keys[m.name].insert(keys[m.name].end(), m.keys.begin(), m.keys.end());
    }
    return keys;
}

namespace {

Three edges_of(const Json& j, SceneBuilder& scene) {
    const auto loop = j.find("loop");
    if (!loop) return three(j, "edges", "the edges [E1: B to C, E2: C to A, E3: A to B]", scene);
    for (const char* key : {"edges", "repair"})
        if (const auto also = j.find(key)) also->expected("\"loop\" without \"" + std::string(key) + "\": a loop gives all three curves and is always put in order");
    return three(j, "loop", "the three curves around", scene);  // fitted() turns and exchanges what does not run around
}

}  // namespace

BuiltSurface build_coons_triangle(const Json& j, SceneBuilder& scene) {
    std::vector<std::string> names;
    std::string all;
    for (const auto& m : methods()) names.push_back(m.name), all += (all.empty() ? "" : ", ") + names.back();
    const Method& method = methods()[scene.values().word(j.at("method", "one of the methods " + all), names)];
    for (const auto& key : j.children())
        if (!(key.key() == "loop" && !method.along) && std::find(std::begin(common_keys), std::end(common_keys), key.key()) == std::end(common_keys) && std::find(method.keys.begin(), method.keys.end(), key.key()) == method.keys.end())
            key.fail_at_key("found \"" + key.key() + "\", expected no such key for the method " + method.name);
    const auto named = j.find("part");
    const std::size_t part = named ? scene.values().word(*named, method.parts) : 0;
    const Three edges = edges_of(j, scene);
    // A part of the construction keeps no promises.
    const auto examined = [&](Patch patch, const TriangleCurves& c) {
        BuiltSurface s(std::move(patch));
        if (part != 0) return s;
        if (method.name == std::string("nielson_c1")) return s.examined([c] { return examine_nielson(c.edges, c.along); });
        if (method.name == std::string("nielson_g1")) return s.examined([c] { return examine_nielson_g1(c.edges, c.along); });
        if (method.along && method.along == std::string("cross")) return s.examined([c] { return examine_triangle(c.edges, c.along); });
        return s.examined([c] { return examine_triangle(c.edges); });
    };
    if (!method.along) return fitted(edges, j, scene, [&](const Three& e) { return examined(method.build(j, scene, {e, e}, part), {e, e}); });
    const TriangleCurves curves{edges, three(j, method.along, along_meaning(method.along), scene)};
    return fitted(curves, j, scene, [&](const TriangleCurves& c) { return examined(method.build(j, scene, c, part), c); });
}

}  // namespace isoparm
