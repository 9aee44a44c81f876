#include <charconv>
#include <iostream>

#include "commands/options.h"
#include "error.h"
#include "scene/suggest.h"
#include "text/json_text.h"

namespace isoparm {

namespace {

constexpr const char* kHelp = R"(usage: isoparm eval SCENE --surface S --at u,v [--at u,v ...] [--json] [--set PARAMETER=NUMBER]

Position, first and second derivatives, unit normal and curvatures of a surface. At poles and apexes the normal is the
limit from inside, if there is one; what does not exist is "none" (null in JSON), never NaN.
On a line where derivatives jump (between the cells of a network, at a knot), they are those of the cell with the greater parameters.

--surface S       a surface of the scene, or one patch of it, as in teapot/teapot#7; may be left out when there is one
--at u,v          a point of the domain; on a triangle u,v >= 0, u+v <= 1, and derivatives are along u and v with
                  w = 1-u-v
--json            {"surface", "points": [{"at", "S", "Su", "Sv", "Suu", "Suv", "Svv", "n", "gaussian", "mean"}]}
--set p=NUMBER    another value of a parameter of the scene; may be repeated
)";

Vec2 parse_at(const std::string& text, const Options& options) {
    Vec2 at;
    const char* end = text.data() + text.size();
    const auto u = std::from_chars(text.data(), end, at.x);
    const bool comma = u.ec == std::errc() && u.ptr != end && *u.ptr == ',';
    const auto v = comma ? std::from_chars(u.ptr + 1, end, at.y) : u;
    if (!comma || v.ec != std::errc() || v.ptr != end || !std::isfinite(at.x) || !std::isfinite(at.y)) options.fail("--at: found " + quoted(text) + ", expected u,v");
    return at;
}

void check_inside(const Patch& patch, const Vec2& at, const std::string& surface) {
    const Rect r = patch.rect();
    const bool triangle = patch.domain() == Domain::triangle;
    const bool inside = triangle ? at.x >= 0 && at.y >= 0 && at.x + at.y <= 1 + 0x1p-52 : at.x >= r.u0 && at.x <= r.u1 && at.y >= r.v0 && at.y <= r.v1;
    if (inside) return;
    const std::string domain = triangle ? "u >= 0, v >= 0, u + v <= 1"
                                        : to_text(r.u0) + " <= u <= " + to_text(r.u1) + ", " + to_text(r.v0) + " <= v <= " + to_text(r.v1);
    throw_input("--at: found " + to_text(at.x) + "," + to_text(at.y) + ", expected a point of the domain of " + surface + ": " + domain);
}

Member chosen_patch(const Scene& scene, const Options& options) {
    const auto name = options.value("--surface");
    if (!name && scene.surfaces.size() != 1) {
        std::vector<std::string> names;
        for (const Surface& s : scene.surfaces) names.push_back(s.name);
        options.fail("--surface is missing: the scene has " + std::to_string(names.size()) + " surfaces (" + listed(names) + ")");
    }
    const std::string surface = name ? *name : scene.surfaces.front().name;
    const Composite patches = find_patches(scene, surface);
    if (patches.size() == 1) return {surface, patches.front().patch};
    std::vector<std::string> names;
    for (const Member& m : patches) names.push_back(surface + "/" + m.name);
    options.fail("--surface: found " + quoted(surface) + ", which has " + std::to_string(patches.size()) + " patches, expected one of them: " + listed(names));
}

void print_json(std::ostream& out, const std::string& surface, const std::vector<Vec2>& at, const std::vector<SurfacePoint>& points) {
    out << "{\"surface\": " << json_text(surface) << ", \"points\": [";
    for (std::size_t k = 0; k < at.size(); ++k) {
        const SurfacePoint& p = points[k];
        out << (k ? ",\n  " : "\n  ") << "{\"at\": [" << to_text(at[k].x) << ", " << to_text(at[k].y) << "], \"S\": " << json_text(p.position) << ", \"Su\": " << json_text(p.du)
            << ", \"Sv\": " << json_text(p.dv) << ", \"Suu\": " << json_text(p.duu) << ", \"Suv\": " << json_text(p.duv) << ", \"Svv\": " << json_text(p.dvv)
            << ", \"n\": " << json_text(p.normal) << ", \"gaussian\": " << json_text(p.gaussian) << ", \"mean\": " << json_text(p.mean) << "}";
    }
    out << "\n]}\n";
}

void print_text(std::ostream& out, const std::string& surface, const std::vector<Vec2>& at, const std::vector<SurfacePoint>& points) {
    const auto row = [&](const char* name, const std::optional<Point>& p) {
        out << "  " << name << (p ? to_text(p->x) + " " + to_text(p->y) + " " + to_text(p->z) : "none") << "\n";
    };
    for (std::size_t k = 0; k < at.size(); ++k) {
        const SurfacePoint& p = points[k];
        out << surface << " at " << to_text(at[k].x) << "," << to_text(at[k].y) << "\n";
        row("S         ", p.position);
        row("Su        ", p.du);
        row("Sv        ", p.dv);
        row("Suu       ", p.duu);
        row("Suv       ", p.duv);
        row("Svv       ", p.dvv);
        row("normal    ", p.normal);
        out << "  gaussian  " << (p.gaussian ? to_text(*p.gaussian) : "none") << "\n  mean      " << (p.mean ? to_text(*p.mean) : "none") << "\n";
    }
}

int run(const std::vector<std::string>& arguments) {
    const Options options("eval", arguments, {{"--surface", true}, {"--at", true}, {"--json", false}, {"--set", true}});
    std::vector<Vec2> at;
    for (const std::string& text : options.values("--at")) at.push_back(parse_at(text, options));
    if (at.empty()) options.fail("--at is missing: the point u,v");
    const Scene scene = options.scene();
    const Member member = chosen_patch(scene, options);
    std::vector<SurfacePoint> points;
    for (const Vec2& p : at) {
        check_inside(member.patch, p, member.name);
        points.push_back(evaluate(member.patch, p.x, p.y));
    }
    (options.has("--json") ? print_json : print_text)(std::cout, member.name, at, points);
    return kSuccess;
}

}  // namespace

const Command eval_command = {"eval", "a point of a surface, its derivatives, normal and curvatures", kHelp, run};

}  // namespace isoparm
