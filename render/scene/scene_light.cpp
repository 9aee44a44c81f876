#include "scene/scene_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/included_file.h"
#include "scene/suggest.h"

namespace isoparm {
namespace {

using Kind = Json::Kind;
constexpr double kMostPower = 1e12;
constexpr double kNarrowest = 1e-7;  // radians: rays of float32 know no narrower light from one direction

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
    const double most = std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
    if (!(most > 0 && std::isfinite(most))) j.expected("a direction that is not zero and has a finite length");
    return normalized(Point{d.x / most, d.y / most, d.z / most});
}

/// Lengths whose products and squares are numbers.
void must_be_usual(const Json& j, double length, const std::string& what) {
    if (!(length >= 1e-70 && length <= 1e70)) j.fail("found " + what + " of length " + to_text(length) + ", expected 1e-70 to 1e70 scene units");
}
double length_of(const Point& p) { return std::hypot(p.x, p.y, p.z); }
Point read_place(const Json& j, const SceneValues& values) {
    const Point p = values.point(j);
    if (!(length_of(p) <= 1e70)) j.fail("found a point at a distance of " + to_text(length_of(p)) + " from the origin, expected at most 1e70 scene units");
    return p;
}

void read_environment_image(const Json& j, const SceneValues& values, Light& l) {
    const auto image = j.find("image"), rotation = j.find("rotation"), up = j.find("up");
    if (image) l.image = included_file(*image, values.text(*image, "the name of an image of all directions (.exr, .hdr), relative to the scene")), l.place = image->place();
    for (const auto* key : {&rotation, &up})
        if (*key && !image) (*key)->fail_at_key("found " + quoted((*key)->key()) + " without \"image\", expected the image that it turns");
    if (rotation) l.turn = std::numbers::pi / 180 * values.in_range(*rotation, -360, 360, "degrees, -360 to 360");
    if (up) l.direction = read_direction(*up, values);
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
            j.allow_keys({"type", "radiance", "image", "rotation", "up", "seen"});
            read_environment_image(j, values, l);
            if (const auto seen = j.find("seen")) l.seen = values.boolean(*seen);
            if (const auto radiance = j.find("radiance")) l.power = read_power(*radiance, values, "a radiance");
            break;
        case Light::Kind::directional:
            j.allow_keys({"type", "direction", "irradiance", "angle"});
            l.direction = -read_direction(j.at("direction", "the direction in which the light goes"), values);
            l.power = read_power(j.at("irradiance", "the irradiance at right angles to the light"), values, "an irradiance");
            if (const auto angle = j.find("angle")) l.radius = 0.5 * std::numbers::pi / 180 * values.in_range(*angle, 0, 170, "the width of the light's disc in degrees, 0 to 170");
            if (l.radius < kNarrowest) l.radius = 0;
            break;
        case Light::Kind::sphere:
            j.allow_keys({"type", "center", "radius", "radiance"});
            l.at = read_place(j.at("center", "the centre of the sphere"), values);
            l.radius = values.positive(j.at("radius", "the radius of the sphere"), "a positive radius in scene units");
            must_be_usual(j.at("radius", ""), l.radius, "a radius");
            l.power = read_power(j.at("radiance", "the radiance of the light"), values, "a radiance");
            break;
        case Light::Kind::rectangle: {
            j.allow_keys({"type", "corner", "edges", "radiance"});
            l.at = read_place(j.at("corner", "a corner of the rectangle"), values);
            const Json edges = j.at("edges", "the two edges from the corner");
            const auto both = values.points(edges, 2, 2);
            l.edges = {both[0], both[1]};
            for (const Point& e : both) must_be_usual(edges, length_of(e), "an edge");
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

std::optional<Ground> read_ground(const Json& j, const SceneValues& values) {
    if (j.is(Kind::boolean)) return j.boolean() ? std::optional(Ground{}) : std::nullopt;
    if (!j.is(Kind::object)) j.expected("true, or {\"up\": [x,y,z], \"height\": h, \"shadow\": 0 to 1}");
    j.allow_keys({"up", "height", "shadow"});
    Ground g;
    if (const auto up = j.find("up")) g.up = read_direction(*up, values);
    if (const auto height = j.find("height")) g.height = values.in_range(*height, -1e70, 1e70, "a height in scene units, at most 1e70");
    if (const auto shadow = j.find("shadow")) g.shadow = values.in_range(*shadow, 0, 1, "how much of the shadow shows, 0 to 1");
    return g;
}

LightingSettings read_lighting(const Json& j, const SceneValues& values) {
    LightingSettings s;
    if (j.is(Kind::string)) {
        values.word(j, {"studio"});
        s.lights = {Light{}};
        return s;
    }
    if (!j.is(Kind::object)) j.expected("\"studio\", or {\"bounces\": n, \"lights\": [...]}");
    j.allow_keys({"bounces", "caustics", "fireflies", "lights"});
    if (const auto caustics = j.find("caustics")) s.caustics = values.boolean(*caustics);
    if (const auto fireflies = j.find("fireflies")) s.fireflies = LightingSettings::Fireflies(values.word(*fireflies, {"keep", "spread"}));
    if (const auto bounces = j.find("bounces")) s.bounces = values.integer(*bounces, 0, 64, "a number of bounces");
    if (const auto lights = j.find("lights")) {
        for (const Json& l : values.list(*lights, 1, 1000, "lights")) s.lights.push_back(read_light(l, values));
    } else {
        s.lights = {Light{}};
    }
    return s;
}

}  // namespace isoparm
