#include "commands/verify_certificate.h"

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "certificate_file.h"
#include "commands/selection.h"
#include "error.h"
#include "glb_reader.h"
#include "picture/progress.h"
#include "scene/json.h"
#include "scene/suggest.h"
#include "sha256.h"
#include "text/json_text.h"

namespace isoparm {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 30;

using Triangle = std::array<Point, 3>;
bool before(const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }

/// Triangles by their corners, whatever their order; those without area left out, which no file holds.
void add_triangle(std::vector<Triangle>& all, Triangle t) {
    std::sort(t.begin(), t.end(), before);
    if (!(t[0] == t[1]) && !(t[1] == t[2])) all.push_back(t);
}
void sort(std::vector<Triangle>& all) {
    std::sort(all.begin(), all.end(), [](const Triangle& a, const Triangle& b) { return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), before); });
}

/// Empty when the mesh has the triangles of the certificate, and no others.
std::string mesh_fault(const Certificate& c, const std::string& path) {
    const MeshFile file = read_mesh_file(path);
    std::vector<Triangle> claimed, found;
    for (const CertifiedPatch& p : c.patches)
        for (const CertifiedTriangle& t : p.triangles) add_triangle(claimed, {c.points[p.vertex[t.corner[0]]], c.points[p.vertex[t.corner[1]]], c.points[p.vertex[t.corner[2]]]});
    for (const auto& t : file.mesh.triangles) add_triangle(found, {file.mesh.points[t[0]], file.mesh.points[t[1]], file.mesh.points[t[2]]});
    sort(claimed), sort(found);
    if (claimed == found) return "";
    return path + ": found a mesh of " + std::to_string(found.size()) + " triangles that is not the certificate's, which has " + std::to_string(claimed.size());
}

/// What the certificate says beside its numbers, and is not so.
std::vector<std::string> claim_faults(const CertificateFile& file, const Selection& selection) {
    std::vector<std::string> faults;
    const Certificate& c = file.certificate;
    for (std::size_t k = 0; k < std::min(c.patches.size(), selection.patches.size()); ++k) {
        const CertifiedPatch& p = c.patches[k];
        if (p.name != selection.patches[k].name) faults.push_back("patch " + std::to_string(k) + ": found the name " + quoted(p.name) + ", expected " + quoted(selection.patches[k].name));
        if (file.measure == "parametric" && std::any_of(p.triangles.begin(), p.triangles.end(), slides)) faults.push_back(p.name + ": found triangles that slide, which proves the geometric measure only, not the parametric one");
    }
    return faults;
}

struct Report {
    std::string path, scene;
    CertificateFile file;
    CertificateCheck check;
    std::optional<double> limit;
    bool holds() const { return check.proved() && !(limit && file.certificate.certified_error > *limit); }
};

std::string where(const Report& r, const CertificateCheck::Failure& f) {
    const CertifiedPatch& p = r.file.certificate.patches[f.patch];
    return p.name + ", triangle " + std::to_string(f.triangle) + ": bound " + to_text(p.triangles[f.triangle].bound) + (f.exceeded ? " EXCEEDED, at least " : " NOT DECIDED within the budget, up to ") +
           to_text(f.distance) + " at (" + to_text(f.uv.x) + ", " + to_text(f.uv.y) + ")";
}

void print_text(const Report& r) {
    const Certificate& c = r.file.certificate;
    std::printf("%s against %s: %zu patches, %zu triangles, certified error %s (tolerance %s)\n", r.path.c_str(), r.scene.c_str(), c.patches.size(), c.triangle_count(), to_text(c.certified_error).c_str(),
                to_text(c.tolerance).c_str());
    for (const std::string& fault : r.check.faults) std::printf("NO CERTIFICATE: %s\n", fault.c_str());
    for (const auto& f : r.check.failures) std::printf("%s\n", where(r, f).c_str());
    if (r.check.failures.size() >= CertificateCheck::most_failures) std::printf("... %zu of %zu triangles were looked at\n", r.check.checked, c.triangle_count());
    if (r.limit) std::printf("Limit tolerance %s: %s\n", to_text(*r.limit).c_str(), c.certified_error <= *r.limit ? "holds" : "EXCEEDED by the certified error");
    if (r.check.proved()) std::printf("PROVED: no point of the mesh or of the surfaces is farther than %s from the other; %zu pieces\n", to_text(c.certified_error).c_str(), r.check.pieces);
    else std::printf("NOT VERIFIED\n");
}

void print_json(const Report& r) {
    const Certificate& c = r.file.certificate;
    std::ostream& out = std::cout;
    out << "{\"certificate\": " << json_text(r.path) << ", \"scene\": " << json_text(r.scene) << ", \"proved\": " << (r.check.proved() ? "true" : "false") << ", \"certified_error\": " << json_text(c.certified_error)
        << ", \"tolerance\": " << json_text(c.tolerance) << ",\n \"patches\": " << c.patches.size() << ", \"triangles\": " << c.triangle_count() << ", \"checked\": " << r.check.checked << ", \"pieces\": " << r.check.pieces
        << ",\n \"limit\": " << json_text(r.limit) << ", \"holds\": " << (r.holds() ? "true" : "false") << ", \"faults\": [";
    for (std::size_t k = 0; k < r.check.faults.size(); ++k) out << (k ? ", " : "") << json_text(r.check.faults[k]);
    out << "],\n \"failures\": [";
    for (std::size_t k = 0; k < r.check.failures.size(); ++k) {
        const auto& f = r.check.failures[k];
        const CertifiedPatch& p = c.patches[f.patch];
        out << (k ? ",\n  " : "\n  ") << "{\"patch\": " << json_text(p.name) << ", \"triangle\": " << f.triangle << ", \"bound\": " << json_text(p.triangles[f.triangle].bound) << ", \"exceeded\": " << (f.exceeded ? "true" : "false")
            << ", \"uv\": [" << json_text(f.uv.x) << ", " << json_text(f.uv.y) << "], \"distance\": " << json_text(f.distance) << "}";
    }
    out << "]}\n";
}

/// Parameters and surface that the scene does not have are damage of the certificate, not of the command line.
std::pair<Scene, Selection> named_by(const Report& r, const Options& options) {
    try {
        Scene scene = options.scene_at(r.scene, r.file.parameters);
        Selection selection = select_patches(scene, r.file.surface);
        return {std::move(scene), std::move(selection)};
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::usage) throw;
        throw Error(ErrorKind::input, r.path + ": names what " + r.scene + " does not have: " + e.what());
    }
}

}  // namespace

int verify_certificate(const Options& options) {
    for (const char* o : {"--surface", "--set", "--watertight", "--manifold", "--gap", "--max-triangles", "--weld", "--junctions"})
        if (options.has(o)) options.fail(std::string(o) + " does not go with --certificate, which says by itself what it is of");
    if (options.words().size() > 1) options.fail("found " + std::to_string(options.words().size()) + " file names, expected one mesh, or none");
    Report r;
    r.path = *options.value("--certificate");
    r.scene = options.required("--against", "the scene file that the certificate is of");
    const auto tolerance = options.tolerance();
    if (!options.words().empty()) require_mesh_file(options.words().front());
    r.file = read_certificate(read_text_file(r.path, kMostBytes), r.path);
    const Certificate& c = r.file.certificate;
    if (const std::string digest = sha256(read_text_file(r.scene)); digest != r.file.sha256) {
        r.check.faults.push_back(r.scene + " is not the scene that the certificate is of, " + r.file.scene + " of sha256 " + r.file.sha256);
    } else {
        const auto [scene, selection] = named_by(r, options);
        if (tolerance) r.limit = absolute_tolerance(*tolerance, scene, bounding_box(selection.patches));
        ProgressBar bar("checking", options.quiet());
        r.check = check_certificate(selection.patches, c, 5000, std::ref(bar));
        for (const std::string& fault : claim_faults(r.file, selection)) r.check.faults.push_back(fault);
        if (r.check.faults.empty() && !options.words().empty())
            if (const std::string fault = mesh_fault(c, options.words().front()); !fault.empty()) r.check.faults.push_back(fault);
    }
    (options.has("--json") ? print_json : print_text)(r);
    return r.holds() ? kSuccess : kCheckFailed;
}

}  // namespace isoparm
