#include "scene_light.h"

#include <cmath>
#include <numbers>

namespace isoparm {
namespace {

using Kind = Json::Kind;
constexpr double kMostPower = 1e12;

const std::vector<std::string> kMaterials{"diffuse", "plastic", "metal", "glass"};
const std::vector<std::string> kLights{"studio", "environment", "directional", "sphere", "rectangle"};

/// A number, or [r, g, b]: linear.
Color read_power(const Json& j, const SceneValues& values, const std::string& what) {
    const auto one = [&](const Json& n) { return values.in_range(n, 0, kMostPower, what + " from 0 to 1e12"); };
    if (!j.is(Kind::array)) {
        const double p = one(j);
        return {p, p, p};
    }
    const auto rgb = values.list(j, 3, 3, what + ": a number, or three for red, green and blue");
    return {one(rgb[0]), one(rgb[1]), one(rgb[2])};
}

Point read_direction(const Json& j, const SceneValues& values) {
    const Point d = values.point(j);
    if (!(length(d) > 0 && std::isfinite(length(d)))) j.expected("a direction that is not zero and has a finite length");
    return normalized(d);
}

Light read_light(const Json& j, const SceneValues& values) {
    if (!j.is(Kind::object)) j.expected("a light, such as {\"type\": \"sphere\", \"center\": [0,0,5], \"radius\": 1, \"radiance\": 10}");
    Light l;
    l.kind = static_cast<Light::Kind>(values.word(j.at("type", "the type of the light"), kLights));
    switch (l.kind) {
        case Light::Kind::studio:
            j.allow_keys({"type", "scale"});
            if (const auto scale = j.find("scale")) l.power = read_power(*scale, values, "a factor");
            break;
        case Light::Kind::environment:
            j.allow_keys({"type", "radiance"});
            if (const auto radiance = j.find("radiance")) l.power = read_power(*radiance, values, "a radiance");
            break;
        case Light::Kind::directional:
            j.allow_keys({"type", "direction", "irradiance", "angle"});
            l.direction = -read_direction(j.at("direction", "the direction in which the light goes"), values);
            l.power = read_power(j.at("irradiance", "the irradiance at right angles to the light"), values, "an irradiance");
            if (const auto angle = j.find("angle")) l.radius = 0.5 * std::numbers::pi / 180 * values.in_range(*angle, 0, 170, "the width of the light's disc in degrees, 0 to 170");
            break;
        case Light::Kind::sphere:
            j.allow_keys({"type", "center", "radius", "radiance"});
            l.at = values.point(j.at("center", "the centre of the sphere"));
            l.radius = values.positive(j.at("radius", "the radius of the sphere"), "a positive radius in scene units");
            l.power = read_power(j.at("radiance", "the radiance of the light"), values, "a radiance");
            break;
        case Light::Kind::rectangle: {
            j.allow_keys({"type", "corner", "edges", "radiance"});
            l.at = values.point(j.at("corner", "a corner of the rectangle"));
            const Json edges = j.at("edges", "the two edges from the corner");
            const auto both = values.points(edges, 2, 2);
            l.edges = {both[0], both[1]};
            const double across = dot(both[0], both[1]), most = length(both[0]) * length(both[1]);
            if (!(most > 0) || std::fabs(across) > 1e-6 * most) edges.expected("two edges at right angles; light leaves on the side of edges[0] x edges[1]");
            l.power = read_power(j.at("radiance", "the radiance of the light"), values, "a radiance");
            break;
        }
    }
    return l;
}

}  // namespace

Material read_material(const Json& j, const SceneValues& values) {
    Material m;
    if (j.is(Kind::string)) {
        m.kind = static_cast<Material::Kind>(values.word(j, kMaterials));
        return m;
    }
    if (!j.is(Kind::object)) j.expected("a material: \"diffuse\", \"plastic\", \"metal\", \"glass\", or {\"type\": ..., \"roughness\": ...}");
    m.kind = static_cast<Material::Kind>(values.word(j.at("type", "the type of the material"), kMaterials));
    switch (m.kind) {
        case Material::Kind::diffuse: j.allow_keys({"type"}); break;
        case Material::Kind::plastic: j.allow_keys({"type", "roughness", "ior"}); break;
        case Material::Kind::metal: j.allow_keys({"type", "roughness"}); break;
        case Material::Kind::glass: j.allow_keys({"type", "ior", "thin"}); break;
    }
    if (const auto roughness = j.find("roughness")) m.roughness = values.in_range(*roughness, 0, 1, "a roughness from 0 to 1");
    if (const auto ior = j.find("ior")) m.ior = values.in_range(*ior, 1.01, 4, "an index of refraction from 1.01 to 4");
    if (const auto thin = j.find("thin")) m.thin = values.boolean(*thin);
    return m;
}

LightingSettings read_lighting(const Json& j, const SceneValues& values) {
    LightingSettings s;
    if (j.is(Kind::string)) {
        values.word(j, {"studio"});
        s.lights = {Light{}};
        return s;
    }
    if (!j.is(Kind::object)) j.expected("\"studio\", or {\"bounces\": n, \"lights\": [...]}");
    j.allow_keys({"bounces", "caustics", "lights"});
    if (const auto caustics = j.find("caustics")) s.caustics = values.boolean(*caustics);
    if (const auto bounces = j.find("bounces")) s.bounces = values.integer(*bounces, 0, 64, "a number of bounces");
    if (const auto lights = j.find("lights")) {
        for (const Json& l : values.list(*lights, 1, 1000, "lights")) s.lights.push_back(read_light(l, values));
    } else {
        s.lights = {Light{}};
    }
    return s;
}

}  // namespace isoparm
