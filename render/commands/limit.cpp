#include <algorithm>
#include <filesystem>
#include <iostream>

#include "commands/limit_picture.h"
#include "commands/limit_report.h"
#include "commands/limit_scene.h"
#include "commands/options.h"
#include "commands/output.h"
#include "commands/render_options.h"
#include "error.h"
#include "io/atomic_file.h"
#include "io/cage_obj.h"
#include "scene/json.h"

namespace isoparm {
namespace {

constexpr const char* kHelp = R"(usage: isoparm limit CAGE.obj [--scheme S] [--json] [-o DIR] [--image WxH] [--samples N] [--levels K]
       isoparm limit --scene SCENE --surface S [--json] [-o DIR]

Builds composite Coons surfaces on the limit surface of a subdivision cage and measures how far they are from it.

Regular faces (a single bicubic patch, also at boundaries and infinitely sharp creases): the composite of Hermite Coons
patches, made of the knot-line curves, cross derivatives and twists alone, must equal OpenSubdiv's evaluation up to
rounding; bilinear Coons patches on the same curves, the negative control, need not. Of irregular faces the same holds
on sub-cells: at semi-sharp creases of sharpness s on those of level ceil(s).
Extraordinary vertices: bilinear Coons and Gregory patches on the limit's curves and tangents in the cells around the
vertex, level by level: deviation, its part along the normal, and the angle of normals across edges (G1) must fall
by lambda, mu and mu/lambda a level, the eigenvalues of subdivision; the ratios observed ("ratios" of "by_level": this
level divided by the one before, so below 1) stand beside them.
Loop's scheme (triangles): regular faces are quartic box splines, which no Coons triangle here reproduces: deviations of
seven methods over ever smaller triangles, with the ratios that their orders promise ("ratio" of "loop": the level before
divided by this one, so 4, 8 or 16); extraordinary vertices as above. "max_deviation" has Nielson's over whole faces.

With --scene: each patch of a surface on rectangles against the limit of a cage: the control points of the uniform bicubic
B-spline through ever more of its points; the deviation must fall 16 times a halving where the patch is smooth ("ratio":
the one before divided by this one). -o DIR writes DIR/limit.json and the last cages, DIR/cage-0.obj ..., of patches that
could be compared. --scheme, --samples, --levels and --image are for cages.

CAGE.obj       v and f lines, and OpenSubdiv's tags (indices from 0): t crease 2/1/0 V0 V1 SHARPNESS,
               t corner 1/1/0 V SHARPNESS, t hole 1/0/0 FACE, t interpolateboundary 1/0/0 N
               (N: 0 none, 1 edge and corner, 2 edge only; 1 where the file does not say)
--scheme S     catmull-clark (default), loop, or bilinear
--json         the report as JSON on standard output
-o DIR         the report as DIR/limit.json as well, and DIR/limit.png: the surface coloured by how far the composite of
               one patch a face is from it, where the cage has irregular faces that could be compared. Nothing else in
               DIR is touched: files of other runs stay
--image WxH    the image-space form too: the limit surface and the composite of one patch a face, traced with one camera
               in pictures of that size (16 to 4096 pixels each way), and how far colours, normals and silhouettes differ
               ("image" of the report, otherwise null); with -o also DIR/view-limit.png, view-composite.png and
               view-difference.png
--samples N    samples each way over a face and along an edge, 2 to 1025 (default 17); over a cell at a vertex
               65 at most (default 9)
--levels K     the last level around extraordinary vertices, 0 to 12 (default 6)

exit codes     0 what must be equal is
               2 it is not: beyond 200 eps max|P|, P the vertices of the cage's faces
               3 nothing in the cage could be compared, or nothing that says anything, so far from the origin that
                 200 eps max|P| is more than 1e-6 of the cage's diagonal
               4, 64, 65 a file cannot be read or written, usage, bad cage (also one smaller than 1e-70 or larger than 1e70)
)";

void write_report(const std::string& folder, const LimitResult& result) {
    write_atomically((std::filesystem::path(folder) / "limit.json").string(), [&](std::ostream& out) { out << limit_json(result); });
    write_limit_picture((std::filesystem::path(folder) / "limit.png").string(), result);
    if (result.view) write_limit_view(folder, *result.view);
}

/// The image-space form; nothing where there is no exact limit surface to draw, or no size to see.
std::optional<LimitView> view_of(const LimitSurface& limit, const LimitReport& regular, const LimitLevels& irregular, const std::array<int, 2>& size) {
    if (!irregular.refused.empty() || regular.hidden_by_rounding()) return {};
    return view_limit(limit, irregular.faces ? *irregular.faces : LimitFaces(limit.cage(), limit.scheme()), size[0], size[1]);
}

LimitResult measure(const std::string& path, Scheme scheme, const Options& options) {
    LimitOptions how;
    LevelOptions levels;
    if (const auto samples = options.integer("--samples", 2, 1025)) how.samples = *samples, levels.samples = std::min(*samples, 65);
    if (const auto last = options.integer("--levels", 0, 12)) levels.levels = *last;
    const auto size = read_size(options, "--image", 16, 4096);
    const Cage cage = read_cage_obj(read_text_file(path), path);
    try {
        const LimitSurface limit(cage, scheme);
        LimitReport regular = compare_limit(limit, how);
        LimitLevels irregular = measure_levels(limit, levels);
        std::vector<UncomparedFace> nowhere, subcells_only;
        for (const UncomparedFace& f : regular.not_compared)
            if (!irregular.compared[f.face]) (irregular.subcells.compared[f.face] ? subcells_only : nowhere).push_back(f);
        regular.not_compared = std::move(nowhere);
        std::optional<LimitView> view;
        if (size) view = view_of(limit, regular, irregular, *size);
        return {path, cage, std::move(regular), std::move(irregular), std::move(subcells_only), std::move(view)};
    } catch (const Error& e) {
        throw Error(e.kind(), path + ": " + e.what());
    }
}

int run(const std::vector<std::string>& arguments) {
    const Options options("limit", arguments, {{"--scheme", true}, {"--json", false}, {"-o", true}, {"--samples", true}, {"--levels", true}, {"--scene", true}, {"--surface", true}, {"--image", true}});
    if (options.has("--scene")) return run_limit_scene(options);
    if (options.has("--surface")) options.fail("found --surface without --scene, expected the scene that has the surface");
    if (options.words().size() != 1) options.fail("found " + std::to_string(options.words().size()) + " file names, expected one cage, CAGE.obj");
    const std::string word = options.word("--scheme", limit_schemes());
    const auto scheme = static_cast<Scheme>(std::find(limit_schemes().begin(), limit_schemes().end(), word) - limit_schemes().begin());
    if (const auto folder = options.value("-o")) {
        std::vector<std::string> names{"limit.json", "limit.png"};
        if (options.has("--image")) names.insert(names.end(), limit_view_files().begin(), limit_view_files().end());
        check_outputs_in(options, *folder, names, {{"CAGE.obj", options.words().front()}});
    }
    const LimitResult result = measure(options.words().front(), scheme, options);
    if (const auto folder = options.value("-o")) write_report(*folder, result);
    if (options.has("--json")) std::cout << limit_json(result);
    else print_limit(result, std::cout);
    if (!result.something_compared()) {
        if (!options.quiet()) std::cerr << "isoparm limit: no face could be compared" << (result.irregular.refused.empty() ? "" : ": " + result.irregular.refused) << "\n";
        return kNotComparable;
    }
    if (result.regular.hidden_by_rounding()) {
        if (!options.quiet()) std::cerr << "isoparm limit: " << result.rounding_note() << "\n";
        return kNotComparable;
    }
    return result.identity().value_or(true) ? kSuccess : kCheckFailed;
}

}  // namespace

const Command limit_command = {"limit", "composite Coons surfaces against OpenSubdiv's limit surface", kHelp, run};

}  // namespace isoparm
