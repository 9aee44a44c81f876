// scene_file.cpp -- a scene from its file: parameters, curves, surfaces, what is drawn, and how.
#include "scene/scene_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "scene/json.h"
#include "scene/scene_builder.h"
#include "scene/scene_light.h"
#include "scene/scene_objects.h"
#include "scene/scene_values.h"
#include "scene/scene_views.h"
#include "scene/suggest.h"

namespace isoparm {

namespace {

using Kind = Json::Kind;

// ---- parameters -----------------------------------------------------------------------------------------------------

struct Parameter {
    double value, least = -INFINITY, most = INFINITY;
};

Parameter read_parameter(const Json& j, const SceneValues& values) {
    Parameter p{};
    if (!j.is(Kind::object)) {
        p.value = values.number(j, "a number, or {\"value\": number}");
        return p;
    }
    j.allow_keys({"value", "min", "max", "label"});
    if (const auto label = j.find("label")) values.text(*label, "a text");
    const auto least = j.find("min"), most = j.find("max");
    if (least) p.least = values.number(*least);
    if (most) p.most = values.number(*most);
    if (p.least > p.most) least->fail("found min " + to_text(p.least) + " above max " + to_text(p.most) + ", expected min <= max");
    const Json value = j.at("value", "the value of the parameter");
    p.value = values.number(value);
    if (p.value < p.least || p.value > p.most) value.fail("found " + to_text(p.value) + ", expected a value from " + to_text(p.least) + " to " + to_text(p.most));
    return p;
}

/// Later parameters may use earlier ones.
void read_parameters(const Json& root, const std::map<std::string, double>& overrides, SceneValues& values, std::map<std::string, std::array<double, 2>>& ranges) {
    const auto list = root.find("parameters");
    std::vector<std::string> names;
    if (list) {
        must_be_object(*list, "an object of named parameters");
        for (const Json& j : list->children()) {
            const std::string& name = j.key();
            if (!Expression::valid_name(name)) j.fail_at_key("found the name " + quoted(name) + ", expected letters, digits and _ only, not beginning with a digit");
            if (Expression::reserved(name)) j.fail_at_key("found the name " + quoted(name) + ", expected one that expressions do not use already");
            Parameter p = read_parameter(j, values);
            if (const auto set = overrides.find(name); set != overrides.end()) {
                p.value = set->second;
                if (!(p.value >= p.least && p.value <= p.most)) {
                    throw Error(ErrorKind::usage, "--set " + name + "=" + to_text(p.value) + ": expected a value from " + to_text(p.least) + " to " + to_text(p.most));
                }
            }
            values.parameters[name] = p.value;
            ranges[name] = {p.least, p.most};
            names.push_back(name);
        }
    }
    for (const auto& set : overrides) {
        if (values.parameters.count(set.first)) continue;
        throw Error(ErrorKind::usage, "--set " + set.first + ": " + root.file() + " has no such parameter (has: " + listed(names) + ")" + did_you_mean(set.first, names));
    }
}

// ---- objects --------------------------------------------------------------------------------------------------------

/// What a scene without objects shows: the surfaces that no other is made of; if there are none, its curves.
std::vector<SceneObject> default_objects(const Scene& scene, const std::set<std::string>& used) {
    std::vector<SceneObject> objects;
    const auto add = [&](SceneObject::Kind kind, const std::string& name) {
        objects.emplace_back();
        objects.back().kind = kind;
        objects.back().name = name;
    };
    for (const Surface& s : scene.surfaces)
        if (!used.count(s.name)) add(SceneObject::Kind::surface, s.name);
    if (objects.empty())
        for (const auto& c : scene.curves) add(SceneObject::Kind::curve, c.first);
    return objects;
}

// ---- image, tolerance ---------------------------------------------------------------------------------------

ImageSettings read_image(const Json& j, const SceneValues& values) {
    must_be_object(j, "an image {\"width\": ..., \"height\": ...}");
    j.allow_keys({"width", "height", "samples", "noise", "background"});
    ImageSettings image;
    if (const auto width = j.find("width")) image.width = values.integer(*width, 1, 32768, "a width in pixels");
    if (const auto height = j.find("height")) image.height = values.integer(*height, 1, 32768, "a height in pixels");
    if (const auto samples = j.find("samples")) image.samples = values.integer(*samples, 1, 65536, "a number of samples a pixel");
    if (const auto noise = j.find("noise")) image.noise = values.in_range(*noise, 1e-5, 1, "the noise to reach, 1e-5 to 1; a grey level of 255 is 0.004");
    if (const auto background = j.find("background")) {
        if (!(background->is(Kind::string) && lower_case(background->string()) == "transparent")) image.background = values.color(*background, " or \"transparent\"");
    } else {
        image.background = Color{1, 1, 1};
    }
    return image;
}

Tolerance read_tolerance(const Json& j, const SceneValues& values) {
    must_be_object(j, "{\"tolerance\": ...}");
    j.allow_keys({"tolerance"});
    const Json t = j.at("tolerance", "the tolerance: a number, {\"pixels\": p} or {\"relative\": r}");
    if (!t.is(Kind::object)) return {Tolerance::Unit::absolute, values.positive(t, "a positive tolerance")};
    t.allow_keys({"pixels", "relative"});
    const auto pixels = t.find("pixels"), relative = t.find("relative");
    if (!!pixels + !!relative != 1) t.expected("{\"pixels\": p} or {\"relative\": r}");
    if (pixels) return {Tolerance::Unit::pixels, values.positive(*pixels, "a positive number of pixels")};
    return {Tolerance::Unit::relative, values.positive(*relative, "a positive fraction of the bounding-box diagonal")};
}

/// Materials without traced light: a note, not an error, as "lighting" is often taken out for a quick look.
void note_idle_materials(const Json& root, SceneBuilder& builder) {
    if (root.find("lighting")) return;
    const auto look = [&](const Json& holder) {
        if (const auto objects = holder.find("objects"))
            for (const Json& o : objects->children())
                if (const auto material = o.find("material")) builder.note(*material, "a material says nothing without \"lighting\" in the scene");
    };
    look(root);
    if (const auto panels = root.find("panels"))
        for (const Json& p : panels->children()) look(p);
}

// ---- the whole ------------------------------------------------------------------------------------------------------

void check_version(const Json& root) {
    const Json version = root.at("isoparm", "\"isoparm\": 1, the version of the format");
    if (!version.is(Kind::number) || version.number() != 1) version.expected("1, the version of the format that this program reads");
}

/// A single patch takes the name of its surface.
Surface finished(const std::string& name, const std::string& type, BuiltSurface built) {
    for (Member& m : built.patches)
        if (m.name.empty()) m.name = name;
    return {name, type, std::move(built.patches), built.detail, built.examine};
}

Scene read_scene(const Json& root, const std::map<std::string, double>& overrides) {
    root.allow_keys({"$schema", "isoparm", "title", "source", "parameters", "curves", "surfaces", "objects", "panels", "layout", "marks", "insets", "camera", "image", "lighting", "ground", "tessellation"});
    check_version(root);
    SceneValues values;
    Scene scene;
    read_parameters(root, overrides, values, scene.ranges);
    scene.path = root.file();
    scene.place = root.place();
    scene.parameters = values.parameters;
    if (const auto schema = root.find("$schema")) values.text(*schema, "the place of the schema");
    if (const auto title = root.find("title")) scene.title = values.text(*title, "a text");
    if (const auto source = root.find("source")) scene.source = values.text(*source, "a text");

    SceneBuilder builder(root, values);
    for (const char* key : {"curves", "surfaces"}) {
        const auto list = root.find(key);
        if (!list) continue;
        const bool curves = key[0] == 'c';
        for (const Json& definition : list->children()) {
            const std::string& name = definition.key();
            if (curves) {
                scene.curves.emplace_back(name, builder.named_curve(definition).curve);
                continue;
            }
            BuiltSurface surface = builder.named_surface(definition);  // which refuses a definition without a type
            scene.surfaces.push_back(finished(name, definition.find("type")->string(), std::move(surface)));
        }
    }
    if (const auto objects = root.find("objects")) {
        if (!objects->is(Kind::array)) objects->expected("an array of objects to draw");
        scene.place = objects->place();
        for (const Json& o : objects->children()) scene.objects.push_back(read_object(o, builder));
    }
    read_panels(root, builder, scene);
    note_idle_materials(root, builder);
    scene.notes = builder.notes();
    scene.included.assign(builder.included_paths().begin(), builder.included_paths().end());
    if (scene.objects.empty()) scene.objects = default_objects(scene, builder.used_surfaces());
    scene.image.background = Color{1, 1, 1};
    if (const auto camera = root.find("camera")) scene.camera = read_camera(*camera, values);
    if (const auto image = root.find("image")) scene.image = read_image(*image, values);
    if (const auto lighting = root.find("lighting")) scene.lighting = read_lighting(*lighting, values);
    if (const auto ground = root.find("ground")) scene.ground = read_ground(*ground, values);
    if (scene.lighting)
        for (const Light& l : scene.lighting->lights)
            if (!l.image.empty()) scene.included.push_back(l.image);
    if (const auto tessellation = root.find("tessellation")) scene.tolerance = read_tolerance(*tessellation, values);
    return scene;
}

}  // namespace

CameraSettings load_camera(const std::string& path) {
    const Json root = Json::parse(read_text_file(path), path);
    return read_camera(root, {});
}

Scene parse_scene(const std::string& text, const std::string& path, const std::map<std::string, double>& overrides) {
    return read_scene(Json::parse(text, path), overrides);
}

Scene load_scene(const std::string& path, const std::map<std::string, double>& overrides) { return parse_scene(read_text_file(path), path, overrides); }

}  // namespace isoparm
