#include "verify.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "commands/selection.h"
#include "commands/verify_certificate.h"
#include "error.h"
#include "glb_reader.h"
#include "meshes/mesh_defects.h"
#include "picture/progress.h"
#include "scene/json.h"
#include "text/json_text.h"
#include "text/short_text.h"

namespace isoparm {
namespace {

constexpr const char* kHelp = R"(usage: isoparm verify MESH --against SCENE [--surface S] [--tolerance T] [--watertight] [--manifold] [--json] ...
       isoparm verify --certificate FILE --against SCENE [MESH] [--tolerance T] [--json]

How far is a mesh, made by any program, from the surfaces of a scene? Tells an interval that holds the largest distance of
a point of the surfaces from the mesh, and one for a point of the mesh from the surfaces; both are proved, with every
rounding error counted. Then what the mesh is like: holes, T-junctions, edges of three triangles, triangles that are upside
down, twice there, flat or thin, and how far their normals are from the surface's (sampled).

MESH              .ply (ascii or binary), .obj, .stl (ascii or binary) or .glb (what its scene shows). Polygons are cut into fans
                  about their first corner. STL shares no vertices, and .glb few: those with exactly equal coordinates become one
--against SCENE   the scene file
--surface S       one surface, or one patch of it, as in teapot/teapot#7; otherwise all surfaces that the scene draws
--set p=NUMBER    another value of a parameter of the scene; may be repeated

limits            exit code 2 when one is exceeded, or cannot be decided within the budget
--tolerance T     on the distance: 1e-3 in scene units, 1e-4rel of the bounding-box diagonal of the surfaces, 0.25px of the finest pixel of
                  the picture that the scene describes
--watertight      no holes and no T-junctions; the surfaces' own border is no hole
--manifold        no edge of more than two triangles, no vertex where fans of triangles meet only there, no two neighbours
                  of opposite orientation

--gap G           how narrow the intervals should be: upper - lower <= G upper (0.05; from 0.001 to 1)
--max-triangles N the budget: the surfaces are compared by a mesh of about N triangles, at most 2 N (2000000);
                  intervals are wider, and still proved, where that is not enough
--weld            vertices with exactly equal coordinates become one in .ply and .obj too
--junctions D     how near a vertex lies to an edge in a T-junction, in scene units (1e-6 of the mesh's size)
--json            all numbers as JSON

--certificate F   checks a file that tessellate --certificate wrote, by little code that has nothing in common with the code that made
                  the proof: that its triangles cover the surfaces once, and that each is within its bound of them; and
                  that MESH, if given, is the mesh it is of. Knows the surface and parameters by itself. Exit code 2 when
                  anything is not proved; what, and where, is listed
--quiet           no messages; --threads N  at most N threads: the result is the same for every N

exit codes        0, 2 (above), 4 a file cannot be read, 64 usage, 65 bad mesh or scene
)";

struct Limit {
    std::string what;
    std::string text;           // what was found
    std::optional<bool> holds;  // nothing: not decided
    double limit = 0;           // 0: none, or none is allowed
};

struct Report {
    std::string path, scene;
    MeshFile file;
    std::size_t welded = 0;
    Selection selection;
    Verification distance;
    MeshDefects defects;
    TriangleShapes shapes;
    std::size_t holes = 0;
    double junction_distance = 0, size = 0;
    std::vector<Limit> limits;
};

double size_of(const TriangleMesh& mesh) {
    Point low = mesh.points[mesh.triangles[0][0]], high = low;
    for (const auto& t : mesh.triangles)
        for (const auto v : t)
            for (int axis = 0; axis < 3; ++axis) low[axis] = std::min(low[axis], mesh.points[v][axis]), high[axis] = std::max(high[axis], mesh.points[v][axis]);
    return distance(low, high);
}

std::vector<Limit> check_limits(const Report& r, const Options& options, std::optional<double> tolerance) {
    std::vector<Limit> limits;
    const auto counted = [&](const char* what, std::initializer_list<std::pair<std::size_t, const char*>> counts) {
        std::string text;
        for (const auto& [n, name] : counts)
            if (n > 0) text += (text.empty() ? "" : ", ") + std::to_string(n) + " " + name;
        limits.push_back({what, text, text.empty(), 0});
    };
    if (tolerance) {
        Limit l{"tolerance", "between " + to_text(r.distance.lower()) + " and " + to_text(r.distance.upper()), {}, *tolerance};
        if (r.distance.upper() <= *tolerance) l.holds = true;
        if (r.distance.lower() > *tolerance) l.holds = false;
        limits.push_back(l);
    }
    if (options.has("--watertight")) counted("watertight", {{r.holes, "holes"}, {r.defects.t_junctions.size(), "T-junctions"}});
    if (options.has("--manifold"))
        counted("manifold", {{r.defects.non_manifold_edges, "non-manifold edges"}, {r.defects.non_manifold_vertices, "non-manifold vertices"}, {r.defects.inconsistent_edges, "inconsistent edges"}});
    return limits;
}

// ---- JSON

std::string json_of(const DirectedDistance& d, const Selection& selection, bool of_surface) {
    std::string text = "{\"lower\": " + json_text(d.lower) + ", \"upper\": " + json_text(d.upper) + ", \"narrowed\": " + (d.narrowed ? "true" : "false") + ", \"at\": " + json_text(d.at);
    if (of_surface) text += ", \"patch\": " + json_text(selection.patches[d.member].name) + ", \"uv\": [" + json_text(d.uv.x) + ", " + json_text(d.uv.y) + "]";
    else text += ", \"triangle\": " + std::to_string(d.triangle);
    return text + "}";
}

void print_json(std::ostream& out, const Report& r) {
    const MeshDefects& d = r.defects;
    const TriangleShapes& s = r.shapes;
    const NormalDeviation& n = r.distance.normals;
    out << "{\"mesh\": " << json_text(r.path) << ", \"format\": " << json_text(r.file.format) << ", \"triangles\": " << r.file.mesh.triangles.size() << ", \"vertices\": " << r.file.mesh.points.size()
        << ", \"polygons\": " << r.file.polygons << ", \"welded\": " << r.welded << ",\n \"scene\": " << json_text(r.scene) << ", \"patches\": " << r.selection.patches.size()
        << ",\n \"distance\": {\"lower\": " << json_text(r.distance.lower()) << ", \"upper\": " << json_text(r.distance.upper()) << "},\n \"surface_to_mesh\": " << json_of(r.distance.surface_to_mesh, r.selection, true)
        << ",\n \"mesh_to_surface\": " << json_of(r.distance.mesh_to_surface, r.selection, false)
        << ",\n \"compared_by\": {\"triangles\": " << r.distance.finer_triangles << ", \"certified_error\": " << json_text(r.distance.finer_error) << ", \"stopped\": " << (r.distance.stopped.empty() ? "null" : json_text(r.distance.stopped))
        << "},\n \"sampled_normals\": {\"max_degrees\": " << json_text(n.most) << ", \"triangle\": " << n.worst << ", \"mean_degrees\": " << json_text(n.mean) << ", \"compared\": " << n.compared << ", \"against\": " << n.against
        << "},\n \"topology\": {\"open_edges\": " << d.open_edges.size() << ", \"boundary_loops\": " << d.boundary_loops << ", \"holes\": " << r.holes << ", \"t_junctions\": " << d.t_junctions.size()
        << ", \"junction_distance\": " << json_text(r.junction_distance) << ", \"non_manifold_edges\": " << d.non_manifold_edges << ", \"non_manifold_vertices\": " << d.non_manifold_vertices
        << ",\n   \"inconsistent_edges\": " << d.inconsistent_edges << ", \"components\": " << d.components << ", \"degenerate_triangles\": " << d.degenerate_triangles << ", \"duplicate_triangles\": " << d.duplicate_triangles
        << ", \"unused_vertices\": " << d.unused_vertices << ", \"equal_vertices\": " << d.equal_vertices << ",\n   \"junctions\": [";
    for (std::size_t k = 0; k < d.t_junctions.size() && k < 100; ++k)
        out << (k ? ", " : "") << "{\"vertex\": " << d.t_junctions[k].vertex << ", \"edge\": [" << d.t_junctions[k].edge[0] << ", " << d.t_junctions[k].edge[1] << "]}";
    out << "]},\n \"shape\": {\"min_angle_degrees\": " << json_text(s.least_angle) << ", \"triangle\": " << s.thinnest << ", \"angle_percentiles\": {\"1\": " << json_text(s.angle_1) << ", \"5\": " << json_text(s.angle_5) << ", \"50\": " << json_text(s.angle_50)
        << "}, \"aspect_percentiles\": {\"50\": " << json_text(s.aspect_50) << ", \"95\": " << json_text(s.aspect_95) << ", \"99\": " << json_text(s.aspect_99) << "}, \"max_aspect\": " << json_text(s.most_aspect)
        << "},\n \"limits\": [";
    for (std::size_t k = 0; k < r.limits.size(); ++k) {
        const Limit& l = r.limits[k];
        out << (k ? ", " : "") << "{\"what\": " << json_text(l.what) << ", \"limit\": " << json_text(l.limit) << ", \"holds\": " << (!l.holds ? "null" : *l.holds ? "true" : "false") << "}";
    }
    out << "]}\n";
}

// ---- text

std::string brief(double x, bool up) { return bound_text(x, 6, up); }
std::string brief(const Point& p) {
    return std::string("(").append(short_text(p.x, 6)) + ", " + short_text(p.y, 6) + ", " + short_text(p.z, 6) + ")";
}
std::string brief(const DirectedDistance& d) { return brief(d.lower, false) + " .. " + brief(d.upper, true) + "  at " + brief(d.at) + ", "; }

void print_text(std::ostream& out, const Report& r) {
    const MeshDefects& d = r.defects;
    const Verification& v = r.distance;
    const DirectedDistance &s = v.surface_to_mesh, &m = v.mesh_to_surface;
    out << r.path << ": " << r.file.format << ", " << r.file.mesh.triangles.size() << " triangles, " << r.file.mesh.points.size() << " vertices";
    if (r.file.polygons) out << "; " << r.file.polygons << " polygons were cut into triangles";
    if (r.welded) out << "; " << r.welded << " vertices with equal coordinates became one with others";
    out << "\nagainst " << r.scene << ": " << r.selection.patches.size() << (r.selection.patches.size() == 1 ? " patch" : " patches") << "\n\nDistance, proved     " << brief(v.lower(), false) << " .. " << brief(v.upper(), true)
        << "\n  surface to mesh    " << brief(s) << r.selection.patches[s.member].name << " at (" << short_text(s.uv.x, 3) << ", " << short_text(s.uv.y, 3) << ")\n  mesh to surface    " << brief(m) << "triangle " << m.triangle
        << "\n\nNormals, sampled     at most " << short_text(v.normals.most, 3) << " degrees (triangle " << v.normals.worst << "), mean " << short_text(v.normals.mean, 3) << "; " << v.normals.against << " of " << v.normals.compared
        << " triangles show the other side\n\nBoundary             " << d.boundary_loops << " loops of " << d.open_edges.size() << " edges; " << r.holes << " are holes, not the surfaces' border\nT-junctions          "
        << d.t_junctions.size() << " (within " << short_text(r.junction_distance, 3) << ")";
    for (std::size_t k = 0; k < d.t_junctions.size() && k < 3; ++k)
        out << (k ? ", " : ": ") << "vertex " << d.t_junctions[k].vertex << " in edge " << d.t_junctions[k].edge[0] << "-" << d.t_junctions[k].edge[1];
    out << "\nNot manifold         " << d.non_manifold_edges << " edges, " << d.non_manifold_vertices << " vertices; " << d.inconsistent_edges << " edges between triangles of opposite orientation; " << d.components
        << (d.components == 1 ? " piece" : " pieces") << "\nTriangles            " << d.degenerate_triangles << " degenerate, " << d.duplicate_triangles << " duplicate\nVertices             " << d.unused_vertices
        << " unused, " << d.equal_vertices << " with the coordinates of another" << (d.equal_vertices ? " (--weld makes them one)" : "") << "\nLeast angles         " << short_text(r.shapes.least_angle, 3) << " degrees (triangle " << r.shapes.thinnest
        << "); 1 % below " << short_text(r.shapes.angle_1, 3) << ", half below " << short_text(r.shapes.angle_50, 3) << "\nAspect ratios        " << short_text(r.shapes.most_aspect, 3) << "; 1 % above " << short_text(r.shapes.aspect_99, 3) << ", half above "
        << short_text(r.shapes.aspect_50, 3) << "\n";
    if (!r.limits.empty()) out << "\n";
    for (const Limit& l : r.limits)
        out << "Limit " << l.what << (l.limit > 0 ? " " + to_text(l.limit) : "") << ": " << (!l.holds ? "NOT DECIDED, " : *l.holds ? "holds" : "EXCEEDED, ") << (l.holds && *l.holds ? "" : l.text) << "\n";
}

int run(const std::vector<std::string>& arguments) {
    const Options options("verify", arguments,
                          {{"--against", true}, {"--surface", true}, {"--set", true}, {"--tolerance", true}, {"--watertight", false}, {"--manifold", false}, {"--gap", true}, {"--max-triangles", true},
                           {"--weld", false}, {"--junctions", true}, {"--json", false}, {"--certificate", true}});
    if (options.has("--certificate")) return verify_certificate(options);
    if (options.words().size() != 1) options.fail("found " + std::to_string(options.words().size()) + " file names, expected one mesh");
    Report r;
    r.path = options.words().front();
    r.scene = options.required("--against", "the scene file to compare with");
    VerifyOptions how;
    if (const auto gap = options.number("--gap")) how.gap = *gap;
    if (!(how.gap >= 1e-3 && how.gap <= 1)) options.fail("--gap: found " + to_text(how.gap) + ", expected a number from 0.001 to 1");
    if (const auto most = options.integer("--max-triangles", 100, 1'000'000'000)) how.max_triangles = static_cast<std::size_t>(*most);
    const auto junctions = options.number("--junctions");
    if (junctions && !(*junctions >= 0)) options.fail("--junctions: found " + to_text(*junctions) + ", expected a number that is not negative");
    const auto tolerance = options.tolerance();

    require_mesh_file(r.path);
    if (std::filesystem::exists(r.path) && !std::filesystem::is_regular_file(r.path) && !std::filesystem::is_directory(r.path))
        throw Error(ErrorKind::io, r.path + ": found a device or pipe, expected a file");
    r.file = read_mesh_file(r.path);
    r.welded = r.file.welded + (options.has("--weld") ? weld_equal_points(r.file.mesh) : 0);
    const Scene scene = options.scene_at(r.scene);
    r.selection = select_patches(scene, options);
    if (tolerance) how.limit = absolute_tolerance(*tolerance, scene, bounding_box(r.selection.patches));
    r.size = size_of(r.file.mesh);
    r.junction_distance = junctions ? *junctions : 1e-6 * r.size;
    {
        ProgressBar bar("verifying", options.quiet());
        how.progress = std::ref(bar);
        r.distance = verify(r.file.mesh, r.selection.patches, how);
    }
    r.defects = find_defects(r.file.mesh, r.junction_distance);
    r.shapes = measure_shapes(r.file.mesh);
    // Ends of its edges are about as far from the border as the mesh is from the surface, but for the few places where something is wrong.
    r.holes = count_holes(r.file.mesh, r.defects, r.distance.border, std::max(4 * r.distance.usual, r.junction_distance) + r.distance.finer_error);
    r.limits = check_limits(r, options, how.limit);
    (options.has("--json") ? print_json : print_text)(std::cout, r);
    if (!r.distance.stopped.empty() && !options.quiet()) std::fprintf(stderr, "isoparm: note: the interval is proved, but wider than %s: %s\n", to_text(how.gap).c_str(), r.distance.stopped.c_str());
    const bool all = std::all_of(r.limits.begin(), r.limits.end(), [](const Limit& l) { return l.holds && *l.holds; });
    return all ? kSuccess : kCheckFailed;
}

}  // namespace

const Command verify_command = {"verify", "how far any mesh is from a surface, proved; and what is wrong with it", kHelp, run};

}  // namespace isoparm
