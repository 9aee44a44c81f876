// build_coons.cpp -- surfaces that a scene file gives by curves: Coons patches and networks.
#include "patches/coons.h"
#include "patches/coons_hermite.h"
#include "patches/network.h"
#include "registry.h"

namespace isoparm {

namespace {

Part part_of(const Json& j, const SceneValues& values) {
    static constexpr Part parts[] = {Part::sum, Part::P1, Part::P2, Part::P1P2};
    const auto part = j.find("part");
    return part ? parts[values.word(*part, {"sum", "P1", "P2", "P1P2"})] : Part::sum;
}

/// For a surface whose parts cannot be drawn yet.
void whole_only(const Json& j, const SceneValues& values, const std::vector<std::string>& parts) {
    const auto part = j.find("part");
    if (part && values.word(*part, parts) != 0) part->expected("\"sum\": the other parts are known but not built yet here");
}

Twist twist_of(const Json& j, const SceneValues& values, Twist otherwise) {
    static constexpr Twist twists[] = {Twist::compatible, Twist::gregory, Twist::average, Twist::zero};
    const auto twist = j.find("twist");
    return twist ? twists[values.word(*twist, {"compatible", "gregory", "average", "zero"})] : otherwise;
}

Function formula_of(const Json& j, const SceneValues& values) { return make_formula(values.formula(j)); }

std::optional<Function> blend_of(const Json& j, const SceneValues& values) {
    const auto blend = j.find("blend");
    if (!blend || (blend->is(Json::Kind::string) && blend->string() == "linear")) return {};
    if (blend->is(Json::Kind::string) && blend->string() == "cubic") return cubic_blend();
    return formula_of(*blend, values);
}

std::array<Curve, 4> four_curves(const Json& j, const char* key, const char* meaning, SceneBuilder& scene) {
    const auto c = scene.curves(j.at(key, meaning), 4, 4);
    return {c[0], c[1], c[2], c[3]};
}

}  // namespace

BuiltSurface build_coons(const Json& j, SceneBuilder& scene) {
    const auto curve = [&](const char* key, const char* meaning) { return scene.curve(j.at(key, meaning)).curve; };
    const CoonsCurves curves{curve("c0", "the curve x(u,0)"), curve("c1", "the curve x(u,1)"), curve("d0", "the curve x(0,v)"), curve("d1", "the curve x(1,v)")};
    return make_coons(curves, blend_of(j, scene.values()), part_of(j, scene.values()));
}

BuiltSurface build_coons_hermite(const Json& j, SceneBuilder& scene) {
    const HermiteData data{four_curves(j, "f", "the curves x(0,v), x_u(0,v), x_u(1,v), x(1,v)", scene),
                           four_curves(j, "g", "the curves x(u,0), x_v(u,0), x_v(u,1), x(u,1)", scene)};
    return make_coons_hermite(data, twist_of(j, scene.values(), Twist::compatible), part_of(j, scene.values()));
}

BuiltSurface build_network(const Json& j, SceneBuilder& scene) {
    const SceneValues& values = scene.values();
    if (const auto cross = j.find("cross")) {
        if (cross->is(Json::Kind::object)) cross->expected("\"finite_difference\": twists and cross derivatives are known but not built yet");
        values.word(*cross, {"finite_difference"});
    }
    whole_only(j, values, {"sum", "P1", "P2", "P1P2"});
    const Network network{scene.curves(j.at("a", "the curves x(i,v), i = 0..m"), 2, 1000), scene.curves(j.at("b", "the curves x(u,j), j = 0..n"), 2, 1000)};
    return make_network(network, twist_of(j, values, Twist::average));
}

}  // namespace isoparm
