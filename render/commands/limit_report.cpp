#include "commands/limit_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <map>
#include <ostream>
#include <sstream>

#include "text/json_text.h"

namespace isoparm {
namespace {

using Measure = std::optional<double>;

Measure larger(const Measure& a, const Measure& b) { return !a ? b : !b || *a > *b ? a : b; }

const LimitValence& theory(const LimitLevels& levels, int valence) {
    return *std::find_if(levels.valences.begin(), levels.valences.end(), [&](const auto& v) { return v.valence == valence; });
}

std::string ratios(const Measure& deviation, const Measure& normal, const Measure& g1) {
    return "{\"deviation\": " + json_text(deviation) + ", \"normal_deviation\": " + json_text(normal) + ", \"g1\": " + json_text(g1) + "}";
}
std::string json(const LimitLevel& row, const LimitValence& expected) {
    const LevelMeasures& m = row.measured;
    return "{\"level\": " + std::to_string(row.level) + ", \"valence\": " + std::to_string(row.valence) + ", \"method\": " + json_text(row.method) +
           ", \"vertices\": " + std::to_string(row.vertices) + ", \"deviation\": " + json_text(m.deviation) + ", \"normal_deviation\": " + json_text(m.normal_deviation) +
           ", \"normal_degrees\": " + json_text(m.normal_degrees) + ", \"g1_degrees\": " + json_text(m.g1_degrees) + ", \"c1\": " + json_text(m.c1) +
           ",\n   \"ratios\": " + ratios(row.ratio_deviation, row.ratio_normal, row.ratio_g1) +
           ", \"expected\": " + ratios(expected.lambda, expected.mu, expected.mu / expected.lambda) + "}";
}
std::string json(const LoopLevel& row) {
    return "{\"method\": " + json_text(row.method) + ", \"level\": " + std::to_string(row.level) + ", \"deviation\": " + json_text(row.deviation) +
           ", \"ratio\": " + json_text(row.ratio) + ", \"expected\": " + std::to_string(1 << row.order) + "}";
}
std::string json_edges(const Measure& g1, const Measure& c1) { return "\"max_g1_degrees\": " + json_text(g1) + ", \"max_c1\": " + json_text(c1); }

/// Three digits are enough for a reader; --json has them all.
std::string brief(const Measure& x, int digits = 3) {
    std::ostringstream out;
    out.precision(digits);
    if (x) out << *x;
    else out << "-";
    return out.str();
}
std::string in_eps(const Measure& x, double size) {
    return brief(x) + " = " + brief(x && size > 0 ? *x / (std::numeric_limits<double>::epsilon() * size) : 0) + " eps max|P|";
}
/// "0.4103", "-".
std::string ratio(const Measure& x) {
    std::ostringstream out;
    if (x) out << std::fixed << std::setprecision(4) << *x;
    else out << "-";
    return out.str();
}
const char* verdict(const LimitReport& r, bool equal) {
    return r.hidden_by_rounding() ? "says nothing, rounding is more than 1e-6 of the cage" : equal ? "equal up to rounding" : "NOT EQUAL";
}
/// Has anything been measured that must be equal?
bool any_identity(const LimitResult& r) { return r.regular.deviation || r.irregular.subcells.deviation || r.irregular.masks_gap || r.irregular.loop_edges; }
/// Of Loop's scheme: of Nielson's surfaces over whole faces.
Measure deviation_of_regular(const LimitResult& result) {
    for (const LoopLevel& row : result.irregular.loop)
        if (row.level == 0 && row.method == "nielson_c1") return row.deviation;
    return result.regular.deviation;
}
std::string place(const Cage& cage, int face) {
    return "face " + std::to_string(face) + (static_cast<std::size_t>(face) < cage.face_lines.size() ? " (line " + std::to_string(cage.face_lines[face]) + ")" : "");
}

void print_regular(const Cage& cage, const LimitReport& r, std::ostream& out) {
    if (r.deviation) {
        out << "\nHermite Coons composite against the limit surface, regular faces (" << r.samples << "x" << r.samples << " samples each)\n"
            << "  deviation        " << in_eps(r.deviation, r.size) << ", at most 200 allowed: " << verdict(r, r.identity_holds()) << "\n"
            << "  worst            " << place(cage, r.worst_face) << " at " << r.worst_u << "," << r.worst_v << "\n"
            << "  normals          " << brief(r.normal_degrees) << " degrees\n"
            << "  tangents, twists " << brief(r.network_gap) << "\n"
            << "  bilinear Coons   " << brief(r.bilinear_coons) << " (negative control, same curves)\n";
    }
    if (r.edges.compared + r.edges.creases > 0)
        out << "\nEdges between regular faces: " << r.edges.compared << " compared, " << r.edges.creases << " creases left out (sampled)\n"
            << "  C0 " << brief(r.edges.c0) << ", C1 " << brief(r.edges.c1) << ", G1 " << brief(r.edges.g1_degrees) << " degrees\n";
}

void print_subcells(const LimitResult& result, std::ostream& out) {
    const SubcellReport& s = result.irregular.subcells;
    const double tolerance = result.regular.tolerance;
    if (s.cells > 0)
        out << "\nThe same on regular sub-cells of irregular faces: " << s.cells << " cells in " << s.faces << " faces, down to level " << s.deepest << " (sampled)\n"
            << "  deviation        " << in_eps(s.deviation, result.regular.size) << ": " << verdict(result.regular, *s.deviation <= tolerance) << "\n";
    if (const Measure& gap = result.irregular.masks_gap)
        out << "\nLimit positions of isoparm and of OpenSubdiv's masks, vertices of level 1\n"
            << "  largest gap      " << in_eps(gap, result.regular.size) << ": " << verdict(result.regular, *gap <= tolerance) << "\n";
}

void print_levels(const LimitLevels& levels, std::ostream& out) {
    if (levels.by_level.empty()) return;
    out << "\nAround extraordinary vertices, surfaces on the limit's curves in the cells of each level (sampled)\n"
        << "  whole faces, best method: deviation " << brief(levels.worst.deviation) << ", normals " << brief(levels.worst.normal_degrees) << " degrees; edges: G1 "
        << brief(levels.worst.g1_degrees) << " degrees, C1 " << brief(levels.worst.c1) << "\n";
    std::string method;
    int valence = 0;
    const auto column = [&](const std::string& text, int width) { out << "  " << std::setw(width) << text; };
    for (const LimitLevel& row : levels.by_level) {
        if (row.valence != valence || row.method != method) {
            valence = row.valence, method = row.method;
            const LimitValence& t = theory(levels, valence);
            out << "\n  valence " << valence << " (" << t.vertices << (t.vertices == 1 ? " vertex" : " vertices") << "), " << method
                << "; expected ratios (to the level before): " << ratio(t.lambda) << " lambda, " << ratio(t.mu) << " mu, " << ratio(t.mu / t.lambda) << " mu/lambda\n  level  deviation   ratio  along normal   ratio  G1 degrees   ratio\n";
        }
        column(std::to_string(row.level), 5), column(brief(row.measured.deviation), 9), column(ratio(row.ratio_deviation), 6);
        column(brief(row.measured.normal_deviation), 12), column(ratio(row.ratio_normal), 6);
        column(brief(row.measured.g1_degrees), 10), column(ratio(row.ratio_g1), 6);
        out << "\n";
    }
}

void print_loop(const LimitResult& result, std::ostream& out) {
    const auto& rows = result.irregular.loop;
    if (rows.empty()) return;
    out << "\nRegular faces, triangular Coons surfaces on the limit's curves: deviation over the triangle of 2^-level about the centre (sampled)\n"
        << "  edges and their cross derivatives: " << in_eps(result.irregular.loop_edges, result.regular.size) << "\n"
        << "  method           expected ratio | level: deviation (observed ratio, of the level before to this one)\n";
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (rows[k].level == 0) out << (k ? "\n  " : "  ") << std::left << std::setw(17) << rows[k].method << std::right << std::setw(14) << (1 << rows[k].order) << " |";
        out << " " << rows[k].level << ": " << brief(rows[k].deviation, 2);
        if (rows[k].ratio) out << " (" << brief(rows[k].ratio) << ")";
    }
    out << "\n";
}

void print_faces(const char* title, const Cage& cage, const std::vector<UncomparedFace>& list, std::ostream& out) {
    if (list.empty()) return;
    out << "\n" << title << ": " << list.size() << (list.size() == 1 ? " face\n" : " faces\n");
    std::map<std::string, std::vector<int>> by_reason;
    for (const auto& [face, reason] : list) by_reason[reason].push_back(face);
    for (const auto& [reason, faces] : by_reason) {
        out << "  " << faces.size() << "  " << reason << ": ";
        for (std::size_t k = 0; k < faces.size() && k < 6; ++k) out << (k ? ", " : "") << place(cage, faces[k]);
        out << (faces.size() > 6 ? ", ...\n" : "\n");
    }
}
void print_view(const LimitView& v, std::ostream& out) {
    out << "\nPictures, one camera, " << v.width << "x" << v.height << " pixels: " << v.patches << " patches of the limit surface against the composite of one patch a face";
    if (v.left_out) out << ", " << v.left_out << " without one left out";
    out << "\n  colours          at most " << brief(v.color_max) << ", RMS " << brief(v.color_rms) << " (linear light, 0 to 1)\n"
        << "  normals          at most " << brief(v.normal_max_degrees) << ", on average " << brief(v.normal_mean_degrees) << " degrees, over the " << v.both << " pixels of both\n"
        << "  silhouettes      " << v.silhouette_differing << (v.silhouette_differing == 1 ? " pixel differs" : " pixels differ") << ", by at most " << brief(v.silhouette_distance) << " pixels\n";
}
std::string json(const LimitView& v) {
    return "{\"width\": " + std::to_string(v.width) + ", \"height\": " + std::to_string(v.height) + ", \"patches\": " + std::to_string(v.patches) + ", \"left_out\": " + std::to_string(v.left_out) +
           ", \"color\": {\"max\": " + json_text(v.color_max) + ", \"rms\": " + json_text(v.color_rms) + "}, \"normals\": {\"pixels\": " + std::to_string(v.both) + ", \"max_degrees\": " +
           json_text(v.normal_max_degrees) + ", \"mean_degrees\": " + json_text(v.normal_mean_degrees) + "}, \"silhouette\": {\"differing\": " + std::to_string(v.silhouette_differing) +
           ", \"distance\": " + json_text(v.silhouette_distance) + "}}";
}
std::string json(const UncomparedFace& f) { return "{\"face\": " + std::to_string(f.face) + ", \"reason\": " + json_text(f.reason) + "}"; }

}  // namespace

const std::vector<std::string>& limit_schemes() {
    static const std::vector<std::string> names{"catmull-clark", "loop", "bilinear"};
    return names;
}

std::optional<bool> LimitResult::identity() const {
    if (!any_identity(*this) || regular.hidden_by_rounding()) return {};
    return regular.identity_holds() && irregular.identities_hold(regular.tolerance);
}
std::string LimitResult::rounding_note() const {
    return "the cage reaches " + brief(regular.size) + " from the origin, where 200 eps max|P| is " + brief(regular.tolerance) + ", more than 1e-6 of its diagonal " +
           brief(regular.diagonal) + ": nothing measured says anything; move it to the origin";
}
bool LimitResult::something_compared() const {
    return any_identity(*this) || !irregular.by_level.empty() || !irregular.loop.empty();
}

std::string limit_json(const LimitResult& result) {
    const LimitReport& r = result.regular;
    const LimitLevels& i = result.irregular;
    const auto identity = result.identity();
    std::ostringstream out;
    out << "{\"scheme\": \"" << limit_schemes()[static_cast<int>(r.scheme)] << "\", \"faces\": " << r.faces << ", \"regular\": " << r.regular
        << ", \"irregular\": " << r.irregular << ", \"without_limit\": " << r.without_limit << ",\n"
        << " \"max_deviation\": {\"regular\": " << json_text(deviation_of_regular(result)) << ", \"irregular\": " << json_text(larger(i.worst.deviation, i.subcells.deviation)) << "},\n"
        << " \"max_normal_degrees\": {\"regular\": " << json_text(r.normal_degrees) << ", \"irregular\": " << json_text(i.worst.normal_degrees) << "},\n"
        << " \"max_network_gap\": " << json_text(r.network_gap) << ",\n"
        << " \"control\": {\"bilinear_coons\": " << json_text(r.bilinear_coons) << "},\n"
        << " \"max_abs\": " << json_text(r.size) << ", \"tolerance\": " << json_text(r.tolerance)
        << ", \"identity\": " << (identity ? (*identity ? "true" : "false") : "null") << ",\n";
    if (r.worst_face >= 0) out << " \"worst\": {\"face\": " << r.worst_face << ", \"at\": [" << json_text(r.worst_u) << ", " << json_text(r.worst_v) << "]},\n";
    out << " \"edges\": {" << json_edges(larger(r.edges.g1_degrees, i.worst.g1_degrees), larger(r.edges.c1, i.worst.c1)) << ",\n  \"regular\": {"
        << json_edges(r.edges.g1_degrees, r.edges.c1) << ", \"max_c0\": " << json_text(r.edges.c0) << ", \"compared\": " << r.edges.compared
        << ", \"creases\": " << r.edges.creases << "},\n  \"irregular\": {" << json_edges(i.worst.g1_degrees, i.worst.c1) << "}},\n"
        << " \"subcells\": {\"faces\": " << i.subcells.faces << ", \"cells\": " << i.subcells.cells << ", \"level\": " << i.subcells.deepest
        << ", \"deviation\": " << json_text(i.subcells.deviation) << "},\n \"masks_gap\": " << json_text(i.masks_gap) << ",\n"
        << " \"measured\": \"sampled\", \"samples\": " << r.samples << ",\n \"by_level\": "
        << json_list(i.by_level, [&](const LimitLevel& row) { return json(row, theory(i, row.valence)); }) << ",\n \"loop\": "
        << json_list(i.loop, [](const LoopLevel& row) { return json(row); }) << ",\n \"loop_edges\": " << json_text(i.loop_edges) << ",\n \"refused\": "
        << (i.refused.empty() ? "null" : json_text(i.refused)) << ",\n \"subcells_only\": " << json_list(result.subcells_only, [](const UncomparedFace& f) { return json(f); })
        << ",\n \"not_compared\": " << json_list(r.not_compared, [](const UncomparedFace& f) { return json(f); })
        << ",\n \"image\": " << (result.view ? json(*result.view) : "null") << "}\n";
    return out.str();
}

void print_limit(const LimitResult& result, std::ostream& out) {
    const LimitReport& r = result.regular;
    out << result.path << ": " << limit_schemes()[static_cast<int>(r.scheme)] << ", " << r.faces << " faces: " << r.regular << " regular, " << r.irregular << " irregular";
    if (r.without_limit) out << ", " << r.without_limit << " without limit surface";
    out << "\n";
    print_regular(result.cage, r, out);
    print_subcells(result, out);
    print_levels(result.irregular, out);
    print_loop(result, out);
    if (result.view) print_view(*result.view, out);
    if (!result.irregular.refused.empty()) out << (r.irregular ? "\nIrregular faces are not compared: " : "\nFaces are compared one by one only: ") << result.irregular.refused << "\n";
    print_faces("Compared on sub-cells only", result.cage, result.subcells_only, out);
    print_faces("Not compared", result.cage, r.not_compared, out);
}

}  // namespace isoparm
