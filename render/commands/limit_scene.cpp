#include "commands/limit_scene.h"

#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "commands/output.h"
#include "error.h"
#include "io/atomic_file.h"
#include "subdivision/limit_spline.h"
#include "text/json_text.h"

namespace isoparm {
namespace {

using Reports = std::vector<SplineReport>;

std::string json(const SplineLevel& l) {
    return "{\"cells\": [" + std::to_string(l.m) + ", " + std::to_string(l.n) + "], \"deviation\": " + json_text(l.deviation) +
           ", \"normal_degrees\": " + json_text(l.normal_degrees) + ", \"ratio\": " + json_text(l.ratio) + "}";
}
std::string json(const std::string& scene, const std::string& surface, const Reports& reports) {
    std::ostringstream out;
    out << "{\"scene\": " << json_text(scene) << ", \"surface\": " << json_text(surface) << ", \"measured\": \"sampled\", \"expected_ratio\": 16,\n \"patches\": [";
    for (std::size_t k = 0; k < reports.size(); ++k) {
        const SplineReport& r = reports[k];
        out << (k ? ",\n  " : "\n  ") << "{\"name\": " << json_text(r.name) << ", \"refused\": " << (r.refused.empty() ? "null" : json_text(r.refused)) << ", \"levels\": [";
        for (std::size_t i = 0; i < r.levels.size(); ++i) out << (i ? ",\n    " : "\n    ") << json(r.levels[i]);
        out << "]}";
    }
    out << "]}\n";
    return out.str();
}

void print(const std::string& surface, const Reports& reports) {
    std::cout << surface << ": the uniform bicubic B-spline through points of each patch, as the limit of its control points, against the patch (sampled)\n";
    for (const SplineReport& r : reports) {
        std::cout << "\n  " << r.name << "\n";
        if (!r.refused.empty()) std::cout << "    not compared: " << r.refused << "\n";
        if (!r.levels.empty()) std::cout << "      cells  deviation   ratio  normals, degrees   (ratio: of the deviation before to this one)\n";
        for (const SplineLevel& l : r.levels) {
            std::cout << "    " << std::setw(7) << std::to_string(l.m) + "x" + std::to_string(l.n) << std::setprecision(3) << std::setw(11) << l.deviation << std::setw(8);
            if (l.ratio) std::cout << *l.ratio;
            else std::cout << "-";
            std::cout << std::setw(12);
            if (l.normal_degrees) std::cout << *l.normal_degrees << "\n";
            else std::cout << "-" << "\n";
        }
    }
}

/// The cage of the last level, as `isoparm limit` reads it.
void write_cage(std::ostream& out, const Cage& cage) {
    for (const Point& p : cage.positions) out << "v " << to_text(p.x) << " " << to_text(p.y) << " " << to_text(p.z) << "\n";
    for (const auto& f : cage.faces) {
        out << "f";
        for (const int v : f) out << " " << v + 1;
        out << "\n";
    }
    out << "t interpolateboundary 1/0/0 0\n";
}

std::string cage_name(std::size_t k) { return "cage-" + std::to_string(k) + ".obj"; }

void write_files(const std::string& folder, const std::string& text, const Reports& reports) {
    const std::filesystem::path path(folder);
    write_atomically((path / "limit.json").string(), [&](std::ostream& out) { out << text; });
    for (std::size_t k = 0; k < reports.size(); ++k)
        if (!reports[k].levels.empty()) write_atomically((path / cage_name(k)).string(), [&](std::ostream& out) { write_cage(out, reports[k].finest); });
}

}  // namespace

int run_limit_scene(const Options& options) {
    if (!options.words().empty()) options.fail("found " + options.words().front() + " beside --scene, expected a cage or a scene, not both");
    for (const char* flag : {"--scheme", "--samples", "--levels", "--image"})
        if (options.has(flag)) options.fail("found " + std::string(flag) + " beside --scene, expected it with a cage only; leave it out");
    const std::string path = *options.value("--scene"), name = options.required("--surface", "name the surface of the scene to compare");
    const Scene scene = options.scene_at(path);
    const Composite patches = find_patches(scene, name);
    if (const auto folder = options.value("-o")) {
        std::vector<std::string> names{"limit.json"};
        for (std::size_t k = 0; k < patches.size(); ++k) names.push_back(cage_name(k));
        check_outputs_in(options, *folder, names, inputs_of(scene));
    }
    Reports reports;
    for (const Member& m : patches) reports.push_back(compare_with_spline(m));
    const std::string text = json(path, name, reports);
    if (const auto folder = options.value("-o")) write_files(*folder, text, reports);
    if (options.has("--json")) std::cout << text;
    else print(name, reports);
    for (const SplineReport& r : reports)
        if (!r.levels.empty()) return kSuccess;
    if (!options.quiet()) std::cerr << "isoparm limit: no patch of " << name << " could be compared" << (reports.empty() ? "" : ": " + reports[0].refused) << "\n";
    return kNotComparable;
}

}  // namespace isoparm
