#include "tessellate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "certificate_file.h"
#include "commands/output.h"
#include "commands/selection.h"
#include "error.h"
#include "io/atomic_file.h"
#include "io/extension.h"
#include "io/glb.h"
#include "io/mesh_files.h"
#include "isoparm_version.h"
#include "picture/palette.h"
#include "picture/progress.h"
#include "scalar/interval.h"
#include "scene/json.h"
#include "scene/suggest.h"
#include "sha256.h"
#include "tessellation/free_vertices.h"
#include "text/json_text.h"

namespace isoparm {

namespace {

constexpr const char* kHelp = R"(usage: isoparm tessellate SCENE -o MESH [--surface S] [--tolerance T] [--report FILE] ...

Triangulates surfaces so that no point of the mesh is farther than the tolerance from the surface, and no point of the
surface farther than that from the mesh. This is proved, with every rounding error counted, for every triangle; edges
that patches share are found and share their vertices.

-o MESH           .ply (binary, every double exact), .obj (exact decimals), .stl or .glb (binary, float32: what its rounding moves
                  points by is counted; a tolerance below that ends with exit code 2). .glb is glTF 2.0, with the
                  surfaces' names, colours and exact normals
--surface S       one surface, or one patch of it, as in teapot/teapot#7; otherwise all surfaces that the scene draws
--tolerance T     1e-3 in scene units, 1e-4rel of the bounding-box diagonal, 0.25px of the finest pixel of the picture that the scene describes:
                  its camera sees the mesh so near to the surface; otherwise the scene's
--measure M       geometric (default): the distance of the two sets, both ways; parametric: of points at equal parameters,
                  |S(u,v)-L(u,v)|, which is never less
--normals DEGREES the largest angle between a triangle and the surface's normals over it, below 90, proved as well; triangles smaller
                  than the tolerance at poles and apexes are left out and counted (exit code 1). Not with parametric, optimal, .stl or .glb
--quality Q       fast (default): bisection only; optimal: then vertices move, edges flip and vertices go, under the same proof, until
                  little is gained: a half to two thirds of the triangles, for a hundred to several hundred times the time
--vertices V      surface (default): vertices lie on the surface; free: they leave it by up to the tolerance where that saves triangles, about
                  half of them on convex surfaces and next to nothing on others, for a hundred to a thousand times the time; proved as
                  certificates are
--max-triangles N the budget, 20000000; beyond it the command ends with exit code 2 and says what was reached
--report FILE     JSON: triangles, vertices, tolerance, measure, quality, vertices_on, certified_error, sampled_error, boundary_loops,
                  t_junctions, non_manifold_edges, normal_deviation (degrees; of all triangles but normals_unproved; null with free, where float32 moves points, and where that is all), seconds,
                  surfaces (with the asymptotic optimum of triangles),
                  format_rounding (how far float32 moves points in .stl and .glb; part of certified_error); - is standard output
--certificate F   a JSON file that lets isoparm verify --certificate prove the error again: parameters, bound and method of every triangle;
                  it is checked before it is written. Some seconds for 100000 triangles, and 250 bytes for each;
                  triangles at poles are proved one by one for it: more of them. - is standard output
--set p=NUMBER    another value of a parameter of the scene; may be repeated
--quiet           no messages; --threads N  at most N threads: the mesh is the same for every N
)";

/// Fails now rather than after the work.
void check_output(const std::string& path, const Scene& scene, const Options& options) {
    const std::string extension = extension_of(path);
    if (extension != ".ply" && extension != ".obj" && extension != ".stl" && extension != ".glb")
        options.fail("-o: found " + quoted(path) + ", expected a name that ends in .ply, .obj, .stl or .glb");
    std::vector<NamedFile> outputs{{"-o", path}};
    if (const auto report = options.value("--report")) outputs.push_back({"--report", *report});
    if (const auto certificate = options.value("--certificate")) outputs.push_back({"--certificate", *certificate});
    if (options.value("--report") == "-" && options.value("--certificate") == "-") options.fail("--report - and --certificate - both go to standard output");
    check_outputs(options, outputs, inputs_of(scene));
}

/// The double that float32 makes of one. Through memory: g++ 12.2 -O3 leaves the conversion out of the last turns of a vectorised loop.
double through_float(double x) {
    volatile float f = static_cast<float>(x);
    return static_cast<double>(f);
}

/// The largest distance by which float32 moves a vertex, which is the farthest that it moves any point of the mesh.
double float_rounding(const Mesh& mesh) {
    double most = 0;
    for (const Point& p : mesh.positions) {
        double moved[3];  // exact: the difference of a double and the float nearest to it
        for (int axis = 0; axis < 3; ++axis) moved[axis] = std::fabs(p[axis] - through_float(p[axis]));
        most = std::max(most, rounding::length_up(moved[0], moved[1], moved[2]));
    }
    return most;
}

/// At least that, before there is a mesh: 2^-24 of each coordinate, and a little for a box that is sampled.
double float_rounding_bound(const Bounds& box) {
    double most[3];
    for (int axis = 0; axis < 3; ++axis) most[axis] = 0x1.0001p-24 * std::max(std::fabs(box.low[axis]), std::fabs(box.high[axis]));
    return rounding::length_up(most[0], most[1], most[2]);
}

void add_rounding(Tessellation& t, double moved) {
    t.certified_error = rounding::up(t.certified_error + moved);
    for (SurfaceReport& s : t.surfaces) s.certified_error = rounding::up(s.certified_error + moved);
}

/// The mesh as a file of float32 has it, and its bounds.
void round_positions(Tessellation& t, double moved) {
    for (Point& p : t.mesh.positions) p = {through_float(p.x), through_float(p.y), through_float(p.z)};
    for (MeshPart& part : t.mesh.parts)
        for (double& bound : part.bounds) bound = rounding::up(bound + moved);
}

/// Made and checked. Throws Error(budget) when the checker cannot follow.
CertificateFile certificate_of(const Scene& scene, const Selection& selection, const Options& options, const Tessellation& t, const std::string& measure) {
    CertificateFile file{std::filesystem::path(scene.path).filename().string(), sha256(read_text_file(scene.path)), options.value("--surface"), scene.parameters, measure, {}};
    file.certificate = make_certificate(selection.patches, t, measure == "geometric");
    if (const std::string lost = lost_fault(file.certificate); !lost.empty())
        throw Error(ErrorKind::budget, scene.path + ": " + lost + "; certificates tell of triangles with area only, so nothing was written; leave out --certificate, or that part of the surface");
    const CertificateCheck check = check_certificate(selection.patches, file.certificate);
    if (!check.faults.empty()) throw std::logic_error("a certificate that is none, " + check.faults.front() + ": please report this scene");
    if (!check.failures.empty()) {
        const auto& f = check.failures.front();
        throw Error(ErrorKind::budget, scene.path + ": the certificate of " + std::to_string(check.failures.size()) + " triangles cannot be checked by sliding along the surface (the first: patch " +
                                           selection.patches[f.patch].name + " at (" + to_text(f.uv.x) + ", " + to_text(f.uv.y) +
                                           ")), so nothing was written; ask for a smaller tolerance or --measure parametric, or leave out --certificate");
    }
    return file;
}

/// Names and colours as in a picture; patches that do not come one after the other are several surfaces.
std::vector<GlbSurface> glb_surfaces(const Scene& scene, const Selection& selection) {
    std::vector<GlbSurface> all;
    for (std::size_t m = 0; m < selection.patches.size(); ++m) {
        if (all.empty() || all.back().name != selection.surface[m]) {
            GlbSurface s{selection.surface[m], surface_color(all.size()), 1, {}};
            std::size_t drawn = 0;
            for (const SceneObject& o : scene.objects) {
                if (o.kind != SceneObject::Kind::surface) continue;
                if (o.name == s.name.substr(0, s.name.find('/'))) {
                    s.color = o.color.value_or(surface_color(drawn)), s.opacity = o.opacity;
                    break;
                }
                ++drawn;
            }
            all.push_back(s);
        }
        all.back().parts.push_back(m);
    }
    return all;
}

struct SurfaceSum {
    std::string name;
    std::size_t triangles = 0;
    double certified_error = 0, optimal_triangles = 0;
    std::string patches;  // JSON
};

/// The reports of the patches, added up by surface.
std::vector<SurfaceSum> sums(const Tessellation& t, const Selection& selection) {
    std::vector<SurfaceSum> all;
    for (std::size_t k = 0; k < t.surfaces.size(); ++k) {
        const SurfaceReport& r = t.surfaces[k];
        const std::string& surface = k < selection.surface.size() ? selection.surface[k] : r.name;
        if (all.empty() || all.back().name != surface) {
            all.emplace_back();
            all.back().name = surface;
        }
        SurfaceSum& s = all.back();
        s.triangles += r.triangles;
        s.certified_error = std::max(s.certified_error, r.certified_error);
        s.optimal_triangles += r.optimal_triangles;
        s.patches += (s.patches.empty() ? "" : ",\n      ") + ("{\"name\": " + json_text(r.name)) + ", \"triangles\": " + std::to_string(r.triangles) +
                     ", \"certified_error\": " + json_text(r.certified_error) + ", \"optimal_triangles\": " + json_text(r.optimal_triangles) + "}";
    }
    return all;
}

void write_report(std::ostream& out, const Tessellation& t, const Selection& selection, const std::string& measure, const std::string& quality, bool free, double format_rounding, double seconds_write) {
    out << "{\"triangles\": " << t.mesh.triangle_count() << ", \"vertices\": " << t.mesh.positions.size() << ",\n \"tolerance\": " << json_text(t.tolerance)
        << ", \"measure\": " << json_text(measure) << ", \"quality\": " << json_text(quality) << ", \"vertices_on\": " << (free ? "\"free\"" : "\"surface\"") << ", \"certified_error\": " << json_text(t.certified_error) << ", \"sampled_error\": " << json_text(t.sampled_error)
        << ", \"format_rounding\": " << json_text(format_rounding)
        << ",\n \"normal_deviation\": " << (measure == "geometric" && !free && format_rounding == 0 && t.normals_unproved < t.mesh.triangle_count() ? json_text(t.normal_deviation) : "null") << ", \"normals_unproved\": " << t.normals_unproved
        << ",\n \"boundary_loops\": " << t.topology.boundary_loops << ", \"boundary_edges\": " << t.topology.boundary_edges << ", \"t_junctions\": " << t.topology.t_junctions
        << ", \"non_manifold_edges\": " << t.topology.non_manifold_edges << ", \"degenerate_triangles\": " << t.topology.degenerate_triangles
        << ",\n \"seconds\": {\"tessellate\": " << json_text(t.seconds_tessellate) << ", \"sample\": " << json_text(t.seconds_sample) << ", \"write\": " << json_text(seconds_write)
        << "},\n \"surfaces\": [";
    bool first = true;
    for (const SurfaceSum& s : sums(t, selection)) {
        out << (first ? "\n  " : ",\n  ") << "{\"name\": " << json_text(s.name) << ", \"triangles\": " << s.triangles << ", \"certified_error\": " << json_text(s.certified_error)
            << ", \"optimal_triangles\": " << json_text(s.optimal_triangles) << ",\n   \"patches\": [\n      " << s.patches << "]}";
        first = false;
    }
    out << "]}\n";
}

std::string mesh_comment(const Scene& scene, const Tessellation& t) {
    return "isoparm " ISOPARM_VERSION "\nscene " + (scene.title.empty() ? std::filesystem::path(scene.path).filename().string() : scene.title) + "\ntolerance " +
           to_text(t.tolerance) + "\ncertified_error " + to_text(t.certified_error);
}

int run(const std::vector<std::string>& arguments) {
    const Options options("tessellate", arguments,
                          {{"-o", true}, {"--surface", true}, {"--tolerance", true}, {"--measure", true}, {"--quality", true}, {"--vertices", true},
                           {"--max-triangles", true}, {"--report", true}, {"--set", true}, {"--normals", true}, {"--certificate", true}});
    const std::string output = options.required("-o", "the mesh file to write");
    const std::string measure = options.word("--measure", {"geometric", "parametric"});
    const std::string quality = options.word("--quality", {"fast", "optimal"});
    const bool free = options.word("--vertices", {"surface", "free"}) == "free";
    const auto given = options.tolerance();

    const Scene scene = options.scene();
    check_output(output, scene, options);
    const Selection selection = select_patches(scene, options);
    const Bounds box = bounding_box(selection.patches);
    const double tolerance = absolute_tolerance(given ? *given : scene.tolerance, scene, box);
    if (!(tolerance > 0)) throw_input(scene.place + ": found surfaces of size 0, expected some that a relative tolerance can be taken of");
    const bool glb = extension_of(output) == ".glb", float32 = glb || extension_of(output) == ".stl";
    const double reserved = float32 ? float_rounding_bound(box) : 0;
    if (!(reserved < tolerance)) {
        throw Error(ErrorKind::budget, scene.path + ": the tolerance " + to_text(tolerance) + " cannot be kept in " + extension_of(output) + ", whose float32 coordinates move points by up to " +
                                           to_text(reserved) + "; write .ply or .obj");
    }
    TessellationOptions how;
    how.tolerance = tolerance - reserved;
    how.bounds = options.has("--certificate");
    how.study = options.has("--report");
    how.fans = !free;
    how.measure = measure == "parametric" ? Measure::parametric : Measure::geometric;
    how.quality = quality == "optimal" ? Quality::optimal : Quality::fast;
    if (const auto degrees = options.number("--normals")) {
        if (!(*degrees > 0 && *degrees < 90)) options.fail("--normals: found " + to_text(*degrees) + ", expected degrees above 0 and below 90");
        if (measure == "parametric" || float32) options.fail("--normals: proved with --measure geometric, of a mesh in .ply or .obj");
        if (free) options.fail("--normals: proved with --vertices surface");
        if (how.quality != Quality::fast) options.fail("--normals: proved with --quality fast");
        how.normal_deviation = *degrees;
    }
    if (const auto most = options.integer("--max-triangles", 1, 2'000'000'000)) how.max_triangles = static_cast<std::size_t>(*most);
    Tessellation result = [&] {
        ProgressBar bar("tessellating", options.quiet());
        how.progress = std::ref(bar);
        return free ? tessellate_free(selection.patches, how) : tessellate(selection.patches, how);
    }();
    const double moved = float32 ? float_rounding(result.mesh) : 0;
    if (float32) add_rounding(result, moved);
    result.tolerance = tolerance;
    std::optional<CertificateFile> certificate;
    if (options.has("--certificate")) {
        if (!float32) certificate = certificate_of(scene, selection, options, result, measure);
        else {
            Tessellation rounded = result;
            round_positions(rounded, moved);
            certificate = certificate_of(scene, selection, options, rounded, measure);
        }
    }
    if (!(result.certified_error <= tolerance) || result.topology.t_junctions > 0 || result.topology.non_manifold_edges > 0) {
        throw Error(ErrorKind::budget, scene.path + ": the mesh is not what was asked for: certified error " + to_text(result.certified_error) + " at tolerance " +
                                           to_text(tolerance) + ", " + std::to_string(result.topology.t_junctions) + " T-junctions, " +
                                           std::to_string(result.topology.non_manifold_edges) + " non-manifold edges; nothing was written");
    }
    // The largest file first: when it cannot be written, the old mesh is left as it was.
    if (certificate) {
        const auto write = [&](std::ostream& out) { write_certificate(out, *certificate); };
        if (options.value("--certificate") == "-") write(std::cout);
        else write_atomically(*options.value("--certificate"), write);
    }
    const auto start = std::chrono::steady_clock::now();
    if (glb) write_atomically(output, [&](std::ostream& out) { write_glb(out, result.mesh, selection.patches, glb_surfaces(scene, selection)); });
    else write_mesh(output, result.mesh, mesh_comment(scene, result));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (const auto report = options.value("--report")) {
        const auto write = [&](std::ostream& out) { write_report(out, result, selection, measure, quality, free, moved, seconds); };
        if (*report == "-") write(std::cout);
        else write_atomically(*report, write);
    }
    if (!options.quiet()) {
        std::fprintf(stderr, "%s: %zu triangles, %zu vertices, certified error %.3g (tolerance %.3g), %.2f s\n", output.c_str(), result.mesh.triangle_count(),
                     result.mesh.positions.size(), result.certified_error, result.tolerance, result.seconds_tessellate + result.seconds_sample + seconds);
    }
    if (how.normal_deviation > 0 && result.normals_unproved > 0) {
        std::fprintf(stderr, "isoparm: warning: nothing is proved about the normals of %zu triangles, all smaller than the tolerance, at singular points\n", result.normals_unproved);
        return kWarning;
    }
    return kSuccess;
}

}  // namespace

const Command tessellate_command = {"tessellate", "a mesh whose error is proved, as PLY, OBJ, STL or glTF", kHelp, run};

}  // namespace isoparm
