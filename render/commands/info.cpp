#include <iostream>
#include <sstream>

#include "commands/options.h"
#include "curves/piecewise_bezier.h"
#include "picture/picture.h"
#include "text/json_text.h"

namespace isoparm {

namespace {

constexpr const char* kHelp = R"(usage: isoparm info SCENE [--json] [--set PARAMETER=NUMBER]

Tells what is in a scene: curves with their degrees and domains, surfaces with their patches, parameters and their
values, what was repaired, the bounding box of what is drawn, and the tolerance.

--json            for programs
--set p=NUMBER    another value of a parameter of the scene; may be repeated
)";

std::string domain_of(const Patch& p) {
    if (p.domain() == Domain::triangle) return "triangle";
    const Rect r = p.rect();
    return "[" + to_text(r.u0) + ", " + to_text(r.u1) + "] x [" + to_text(r.v0) + ", " + to_text(r.v1) + "]";
}

struct CurveFacts {
    std::string form;
    int degree = -1;
    std::size_t pieces = 1;
};
CurveFacts facts_of(const Curve& c) {
    const PiecewiseBezier* b = c.bezier();
    if (!b) return {"formula"};
    int degree = 0;
    for (const BezierPiece& p : b->pieces()) degree = std::max(degree, p.degree());
    return {b->rational() ? "rational" : "polynomial", degree, b->pieces().size()};
}

std::string tolerance_text(const Tolerance& t) {
    const char* unit[] = {"", "rel", "px"};
    return to_text(t.value) + unit[static_cast<int>(t.unit)];
}

void print_text(std::ostream& out, const Scene& scene) {
    out << scene.path << (scene.title.empty() ? "" : ": " + scene.title) << "\n";
    if (!scene.source.empty()) out << "  source: " << scene.source << "\n";
    if (!scene.parameters.empty()) out << "\nparameters\n";
    for (const auto& [name, value] : scene.parameters) out << "  " << name << " = " << to_text(value) << "\n";
    if (!scene.curves.empty()) out << "\ncurves\n";
    for (const auto& [name, c] : scene.curves) {
        const CurveFacts f = facts_of(c);
        out << "  " << name << ": " << f.form;
        if (f.degree >= 0) out << " of degree " << f.degree << (f.pieces > 1 ? ", " + std::to_string(f.pieces) + " pieces" : "");
        out << ", t in [" << to_text(c.begin()) << ", " << to_text(c.end()) << "]\n";
    }
    if (!scene.surfaces.empty()) out << "\nsurfaces\n";
    for (const Surface& s : scene.surfaces) {
        out << "  " << s.name << ": " << s.type << (s.detail.empty() ? "" : ", " + s.detail);
        if (s.patches.size() == 1) out << ", (u,v) in " << domain_of(s.patches[0].patch) << "\n";
        else out << ", " << s.patches.size() << " patches: " << s.patches.front().name << " ... " << s.patches.back().name << "\n";
    }
    if (!scene.notes.empty()) out << "\nnotes\n";
    for (const std::string& note : scene.notes) out << "  " << note << "\n";
    const Bounds box = bounding_box(scene);
    const auto row = [&](const Point& p) { out << "  " << to_text(p.x) << " " << to_text(p.y) << " " << to_text(p.z) << "\n"; };
    out << "\nbounding box of what is drawn (sampled), diagonal " << to_text(box.diagonal()) << "\n";
    row(box.low);
    row(box.high);
    out << "\ndraws " << scene.objects.size() << (scene.objects.size() == 1 ? " object" : " objects") << ", tolerance " << tolerance_text(scene.tolerance)
        << ", picture " << scene.image.width << "x" << scene.image.height << ", " << RenderOptions().most_samples(scene.image) << " samples a pixel" << (scene.image.noise > 0 ? " at most, noise " + to_text(scene.image.noise) : "") << "\n";
}

/// f(x) of all x, with commas between.
template <class List, class F> std::string joined(const List& list, F f) {
    std::string r;
    for (const auto& x : list) r += (r.empty() ? "" : ", ") + f(x);
    return r;
}

void print_json(std::ostream& out, const Scene& scene) {
    const Bounds box = bounding_box(scene);
    out << "{\"scene\": " << json_text(scene.path) << ", \"title\": " << json_text(scene.title) << ", \"source\": " << json_text(scene.source) << ",\n \"parameters\": {"
        << joined(scene.parameters, [](const auto& p) { return json_text(p.first) + ": " + json_text(p.second); }) << "},\n \"curves\": ["
        << joined(scene.curves, [](const auto& c) {
               const CurveFacts f = facts_of(c.second);
               return "{\"name\": " + json_text(c.first) + ", \"form\": " + json_text(f.form) + ", \"degree\": " + (f.degree < 0 ? "null" : std::to_string(f.degree)) +
                      ", \"pieces\": " + std::to_string(f.pieces) + ", \"domain\": [" + json_text(c.second.begin()) + ", " + json_text(c.second.end()) + "]}";
           })
        << "],\n \"surfaces\": ["
        << joined(scene.surfaces, [](const Surface& s) {
               return "{\"name\": " + json_text(s.name) + ", \"type\": " + json_text(s.type) + ", \"detail\": " + json_text(s.detail) + ", \"patches\": [" +
                      joined(s.patches, [](const Member& m) { return "{\"name\": " + json_text(m.name) + ", \"domain\": " + json_text(domain_of(m.patch)) + "}"; }) + "]}";
           })
        << "],\n \"notes\": [" << joined(scene.notes, [](const std::string& note) { return json_text(note); }) << "],\n \"bounding_box\": {\"low\": " << json_text(box.low) << ", \"high\": " << json_text(box.high) << ", \"diagonal\": " << json_text(box.diagonal())
        << "},\n \"objects\": " << scene.objects.size() << ", \"tolerance\": " << json_text(tolerance_text(scene.tolerance)) << "}\n";
}

int run(const std::vector<std::string>& arguments) {
    const Options options("info", arguments, {{"--json", false}, {"--set", true}});
    const Scene scene = options.scene();
    (options.has("--json") ? print_json : print_text)(std::cout, scene);
    return kSuccess;
}

}  // namespace

const Command info_command = {"info", "what is in a scene", kHelp, run};

}  // namespace isoparm
