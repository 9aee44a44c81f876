#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <sstream>

#include "commands/options.h"
#include "error.h"
#include "io/atomic_file.h"
#include "io/cage_obj.h"
#include "json.h"
#include "json_text.h"
#include "limit_compare.h"

namespace isoparm {
namespace {

constexpr const char* kHelp = R"(usage: isoparm limit CAGE.obj [--scheme S] [--json] [-o DIR] [--samples N]

Builds composite Coons surfaces on the limit surface of a subdivision cage and measures how far they are from
OpenSubdiv's own evaluation of it. Over regular faces (a single bicubic patch, also at boundaries and infinitely sharp
creases) the composite of Hermite Coons patches, made of the knot-line curves, cross derivatives and twists alone, must
equal the limit surface up to rounding; bilinear Coons patches on the same curves, the negative control, need not.
Irregular faces are counted and named; they are not compared yet.

CAGE.obj       v and f lines, and OpenSubdiv's tags (indices from 0): t crease 2/1/0 V0 V1 SHARPNESS,
               t corner 1/1/0 V SHARPNESS, t hole 1/0/0 FACE, t interpolateboundary 1/0/0 N
               (N: 0 none, 1 edge and corner, 2 edge only; 1 where the file does not say)
--scheme S     catmull-clark (default), bilinear, or loop (triangles; faces are counted, not compared yet)
--json         the report as JSON on standard output
-o DIR         the report as JSON in DIR/limit.json as well
--samples N    samples each way over a face and along an edge, 2 to 1025 (default 17)

exit codes     0 the identity holds on every regular face
               2 it does not: beyond 200 eps max|P|, P the vertices of the cage
               3 nothing can be compared yet with this scheme
               4, 64, 65 a file cannot be read or written, usage, bad cage
)";

const std::vector<std::string> kSchemes = {"catmull-clark", "loop", "bilinear"};  // in the order of Scheme
std::string scheme_name(Scheme scheme) { return kSchemes[static_cast<int>(scheme)]; }
Scheme scheme_named(const std::string& name) {
    return static_cast<Scheme>(std::find(kSchemes.begin(), kSchemes.end(), name) - kSchemes.begin());
}

std::string to_json(const LimitReport& r) {
    std::ostringstream out;
    out << "{\"scheme\": \"" << scheme_name(r.scheme) << "\", \"faces\": " << r.faces << ", \"regular\": " << r.regular
        << ", \"irregular\": " << r.irregular << ", \"without_limit\": " << r.without_limit << ",\n"
        << " \"max_deviation\": {\"regular\": " << json_text(r.deviation) << ", \"irregular\": null},\n"
        << " \"max_normal_degrees\": {\"regular\": " << json_text(r.normal_degrees) << ", \"irregular\": null},\n"
        << " \"max_network_gap\": " << json_text(r.network_gap) << ",\n"
        << " \"control\": {\"bilinear_coons\": " << json_text(r.bilinear_coons) << "},\n"
        << " \"max_abs\": " << to_text(r.size) << ", \"tolerance\": " << to_text(r.tolerance)
        << ", \"identity\": " << (r.deviation ? (r.identity_holds() ? "true" : "false") : "null") << ",\n";
    if (r.worst_face >= 0) out << " \"worst\": {\"face\": " << r.worst_face << ", \"at\": [" << to_text(r.worst_u) << ", " << to_text(r.worst_v) << "]},\n";
    out << " \"edges\": {\"max_g1_degrees\": " << json_text(r.edges.g1_degrees) << ", \"max_c1\": " << json_text(r.edges.c1)
        << ", \"max_c0\": " << json_text(r.edges.c0) << ", \"compared\": " << r.edges.compared << ", \"creases\": " << r.edges.creases << "},\n"
        << " \"measured\": \"sampled\", \"samples\": " << r.samples << ", \"by_level\": [],\n \"not_compared\": [";
    for (std::size_t k = 0; k < r.not_compared.size(); ++k)
        out << (k ? ",\n  " : "\n  ") << "{\"face\": " << r.not_compared[k].face << ", \"reason\": \"" << r.not_compared[k].reason << "\"}";
    out << "]}\n";
    return out.str();
}

/// Three digits are enough for a reader; --json has them all.
std::string brief(const std::optional<double>& x) {
    std::ostringstream out;
    out.precision(3);
    if (x) out << *x;
    else out << "none";
    return out.str();
}

void print_not_compared(const Cage& cage, const LimitReport& r) {
    std::map<std::string, std::vector<int>> by_reason;
    for (const auto& [face, reason] : r.not_compared) by_reason[reason].push_back(face);
    for (const auto& [reason, faces] : by_reason) {
        std::cout << "  " << faces.size() << "  " << reason << ": ";
        for (std::size_t k = 0; k < faces.size() && k < 6; ++k)
            std::cout << (k ? ", " : "") << "face " << faces[k] << " (line " << cage.face_lines[faces[k]] << ")";
        std::cout << (faces.size() > 6 ? ", ...\n" : "\n");
    }
}

void print(const std::string& path, const Cage& cage, const LimitReport& r) {
    std::cout << path << ": " << scheme_name(r.scheme) << ", " << r.faces << " faces: " << r.regular << " regular, " << r.irregular << " irregular";
    if (r.without_limit) std::cout << ", " << r.without_limit << " without limit surface";
    std::cout << "\n";
    if (r.deviation) {
        std::cout << "\nHermite Coons composite against the limit surface, regular faces (" << r.samples << "x" << r.samples << " samples each)\n"
                  << "  deviation        " << brief(r.deviation) << " = "
                  << brief(r.size > 0 ? *r.deviation / (std::numeric_limits<double>::epsilon() * r.size) : 0) << " eps max|P|, at most 200 allowed: "
                  << (r.identity_holds() ? "equal up to rounding" : "NOT EQUAL") << "\n"
                  << "  worst            face " << r.worst_face << " (line " << cage.face_lines[r.worst_face] << ") at " << r.worst_u << "," << r.worst_v << "\n"
                  << "  normals          " << brief(r.normal_degrees) << " degrees\n"
                  << "  tangents, twists " << brief(r.network_gap) << "\n"
                  << "  bilinear Coons   " << brief(r.bilinear_coons) << " (negative control, same curves)\n";
    }
    if (r.edges.compared + r.edges.creases > 0)
        std::cout << "\nEdges between regular faces: " << r.edges.compared << " compared, " << r.edges.creases << " creases left out (sampled)\n"
                  << "  C0 " << brief(r.edges.c0) << ", C1 " << brief(r.edges.c1) << ", G1 " << brief(r.edges.g1_degrees) << " degrees\n";
    if (!r.not_compared.empty()) {
        std::cout << "\nNot yet compared: " << r.not_compared.size() << " faces\n";
        print_not_compared(cage, r);
    }
}

void write_report(const std::string& folder, const LimitReport& report) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed) throw Error(ErrorKind::io, folder + ": cannot make this folder: " + failed.message());
    write_atomically((std::filesystem::path(folder) / "limit.json").string(), [&](std::ostream& out) { out << to_json(report); });
}

int run(const std::vector<std::string>& arguments) {
    const Options options("limit", arguments, {{"--scheme", true}, {"--json", false}, {"-o", true}, {"--samples", true}});
    if (options.words().size() != 1) options.fail("found " + std::to_string(options.words().size()) + " file names, expected one cage, CAGE.obj");
    const std::string& path = options.words().front();
    const Scheme scheme = scheme_named(options.word("--scheme", kSchemes));
    LimitOptions how;
    if (const auto samples = options.integer("--samples", 2, 1025)) how.samples = *samples;
    const auto note = [&](const char* text) {
        if (!options.quiet()) std::cerr << "isoparm limit: " << text << "\n";
    };

    const Cage cage = read_cage_obj(read_text_file(path), path);
    const LimitReport report = [&] {
        try {
            return compare_limit(LimitSurface(cage, scheme), how);
        } catch (const Error& e) {
            throw Error(e.kind(), path + ": " + e.what());
        }
    }();
    if (const auto folder = options.value("-o")) write_report(*folder, report);
    if (options.has("--json")) std::cout << to_json(report);
    else print(path, cage, report);
    if (scheme == Scheme::loop) {
        note("faces of Loop's scheme are quartic box splines; they are counted, and not compared yet");
        return kNotComparable;
    }
    if (!report.deviation) note("no face is regular, so nothing was compared");
    return report.identity_holds() ? kSuccess : kCheckFailed;
}

}  // namespace

const Command limit_command = {"limit", "composite Coons surfaces against OpenSubdiv's limit surface", kHelp, run};

}  // namespace isoparm
