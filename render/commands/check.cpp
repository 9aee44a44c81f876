#include <algorithm>
#include <cmath>
#include <iostream>

#include <tbb/parallel_for.h>

#include "commands/selection.h"
#include "continuity.h"
#include "promises.h"
#include "text/json_text.h"
#include "text/short_text.h"

namespace isoparm {
namespace {

constexpr const char* kHelp = R"(usage: isoparm check SCENE [--surface S] [--tolerance T] [--angle DEGREES] [--json] ...

How do the patches of a scene join? For every edge that two patches share, for the seams of closed patches and the lines
between the cells of splines and networks: how far positions (c0), first and second derivatives across the edge (c1, c2),
normals (g1, degrees) and normal curvatures across the edge (g2) jump, as bounds that are proved for the whole edge, with
every rounding error counted; and the order that they prove: C2, C1, G2, G1, C0, or that the edge is not joined.
docs/continuity.md explains what is measured.

--surface S       one surface; otherwise all surfaces that the scene draws
--set p=NUMBER    another value of a parameter of the scene; may be repeated

--tolerance T     of positions and derivatives, in scene units (1e-6) or relative to the bounding-box diagonal (1e-9rel, the
                  default); of curvatures the same number per unit of length squared: T / diagonal^2
--angle DEGREES   of normals (1e-6)
--capture D       edges of one surface that stay nearer than D to each other, and do not meet, are reported as a joint with
                  a gap; as --tolerance (1e-2rel); 0: none
--halvings N      the budget: how often an edge is cut for one measure (4000); what is left is a wider interval, proved as well

--json            all numbers as JSON
--quiet           no messages; --threads N  at most N threads: the result is the same for every N

exit codes        0, 1 a promise of a surface is neither proved nor disproved within the budget, 2 edges of one surface do not
                  meet, or a surface does not keep what it promises, 4 a file cannot be read, 64 usage, 65 bad scene or curves
                  that do not fit together
)";

/// A surface that is built from curves: what its data must fulfil, and what it promises of them.
struct Examined {
    std::string name;
    DataReport data;
    std::vector<JumpBound> residuals;  // one a promise
    bool compatible() const {
        return std::all_of(data.conditions.begin(), data.conditions.end(), [](const Condition& c) { return c.gap <= c.tolerance; });
    }
};

struct Report {
    Selection selection;
    std::vector<Examined> surfaces;
    ContinuityOptions options;
    Continuity continuity;
    std::vector<std::string> failed, unproved;  // sentences
    double allowed(const Promise& p) const { return p.derivative == kNormal ? options.angle : std::max(options.tolerance, p.allowed); }
    void judge(const std::string& what, double lower, double upper) { judge(what, lower, upper, options.tolerance); }
    void judge(const std::string& what, double lower, double upper, double tolerance) {
        if (upper <= tolerance) return;
        const bool fails = lower > tolerance;
        (fails ? failed : unproved).push_back(what + (fails ? ": no, by at least " + to_text(lower) : ": proved within " + to_text(upper) + " only") + ", expected at most " + to_text(tolerance));
    }
};

constexpr const char* kNames[] = {"c0", "c1", "c2", "g1_degrees", "g2"};
constexpr const char* kKinds[] = {"shared", "seam", "t-joint", "gap", "line"};

std::string text_of(const Report& r, const Joint& j, const Joint::Side& s) { return r.selection.patches[s.member].name + " " + edge_text(r.selection.patches, j, s); }
bool same_surface(const Report& r, const Joint& j) { return r.selection.surface[j.a.member] == r.selection.surface[j.b.member]; }

/// Patches of one surface promise to meet.
void judge_joints(Report& r) {
    for (const auto* list : {&r.continuity.joints, &r.continuity.lines})
        for (const Joint& j : *list) {
            if (same_surface(r, j)) r.judge(text_of(r, j, j.a) + " meets " + text_of(r, j, j.b), j.jumps[kC0].lower, j.jumps[kC0].upper);
        }
}

/// Of the surfaces that are checked as a whole; their promises are measured in parallel.
void examine_surfaces(const Scene& scene, Report& r) {
    for (const std::string& name : r.selection.surface) {
        if (!r.surfaces.empty() && r.surfaces.back().name == name) continue;
        const Surface* s = scene.find_surface(name);
        r.surfaces.push_back({name, s && s->examine ? s->examine() : DataReport{}, {}});
        Examined& e = r.surfaces.back();
        e.residuals.resize(e.data.promises.size());
        tbb::parallel_for(std::size_t(0), e.residuals.size(), [&](std::size_t k) {
            const Promise& p = e.data.promises[k];
            e.residuals[k] = bound_residual(s->patches[p.patch].patch, p, r.allowed(p));
        });
    }
}

void judge_promises(Report& r) {
    std::size_t first = 0;  // of the surface's patches among those selected
    for (const Examined& e : r.surfaces) {
        for (std::size_t k = 0; k < e.residuals.size(); ++k) {
            r.judge(e.name + ": " + e.data.promises[k].what, e.residuals[k].lower, e.residuals[k].inside, r.allowed(e.data.promises[k]));
        }
        for (const Joint& j : r.continuity.lines) {
            if (j.a.member < first || std::find(e.data.smooth.begin(), e.data.smooth.end(), j.a.member - first) == e.data.smooth.end() || r.selection.surface[j.a.member] != e.name) continue;
            r.judge(text_of(r, j, j.a) + ": the derivative does not jump", j.jumps[kC1].lower, j.jumps[kC1].upper);
        }
        first += std::size_t(std::count(r.selection.surface.begin(), r.selection.surface.end(), e.name));
    }
}

// ---- JSON

std::string pair_text(const Vec2& at) { return "[" + json_text(at.x) + ", " + json_text(at.y) + "]"; }

std::string json_of(const JumpBound& b) {
    std::string text = "{\"lower\": " + json_text(b.lower) + ", \"upper\": " + json_text(b.upper) + ", \"at\": " + pair_text(b.at);
    if (!b.singular.empty()) {
        text += ", \"inside\": " + json_text(b.inside) + ", \"singular\": [";
        for (std::size_t k = 0; k < b.singular.size(); ++k) text += (k ? ", " : "") + pair_text(b.singular[k]);
        text += "]";
    }
    return text + "}";
}

std::string json_of(const Report& r, const Joint& j, const Joint::Side& s) {
    return "{\"surface\": " + json_text(r.selection.patches[s.member].name) + ", \"edge\": " + json_text(edge_text(r.selection.patches, j, s)) + ", \"of\": " + json_text(r.selection.surface[s.member]) + ", \"part\": [" +
           json_text(s.t0) + ", " + json_text(s.t1) + "]}";
}

std::string json_of(const Report& r, const Joint& j) {
    const JointOrder order = order_of(j, r.options);
    std::string text = "{\"a\": " + json_of(r, j, j.a) + ", \"b\": " + json_of(r, j, j.b);
    for (int m = 0; m < kMeasures; ++m) text += std::string(m == kC0 ? ",\n   \"" : ", \"") + kNames[m] + "\": " + json_of(j.jumps[std::size_t(m)]);
    text += ",\n   \"order\": " + json_text(order.text) + ", \"geometric\": " + (order.geometric.empty() ? "null" : json_text(order.geometric)) + ", \"inside\": " + (order.inside.empty() ? "null" : json_text(order.inside)) + ", \"undecided\": [";
    for (std::size_t k = 0; k < order.undecided.size(); ++k) text += (k ? ", " : "") + json_text(order.undecided[k]);
    return text + "], \"kind\": " + json_text(kKinds[int(j.kind)]) + ", \"in_step\": " + (j.affine ? "true" : "false") + "}";
}

std::string json_of(const Report& r, const Examined& e) {
    std::string conditions;
    const auto add = [&](const std::string& text) { conditions += (conditions.empty() ? "\n    {" : ",\n    {") + text + "}"; };
    for (const Condition& c : e.data.conditions)
        add("\"what\": " + json_text(c.what) + ", \"gap\": " + json_text(c.gap) + ", \"tolerance\": " + json_text(c.tolerance) + ", \"holds\": " + (c.gap <= c.tolerance ? "true" : "false") + ", \"remedy\": " +
            (c.remedy.empty() ? "null" : json_text(c.remedy)));
    for (std::size_t k = 0; k < e.residuals.size(); ++k) {
        const JumpBound& b = e.residuals[k];
        const double tolerance = r.allowed(e.data.promises[k]);
        add("\"what\": " + json_text(e.data.promises[k].what) + ", \"gap\": " + json_text(b.upper) + ", \"tolerance\": " + json_text(tolerance) + ", \"holds\": " + (b.inside <= tolerance ? "true" : "false") +
            ", \"residual\": " + json_of(b));
    }
    return "{\"name\": " + json_text(e.name) + ", \"compatible\": " + (e.compatible() ? "true" : "false") + ", \"conditions\": [" + conditions + "]}";
}

void print_json(std::ostream& out, const Report& r) {
    out << "{\"surfaces\": " << json_list(r.surfaces, [&](const Examined& e) { return json_of(r, e); })
        << ",\n \"edges\": " << json_list(r.continuity.joints, [&](const Joint& j) { return json_of(r, j); })
        << ",\n \"lines\": " << json_list(r.continuity.lines, [&](const Joint& j) { return json_of(r, j); })
        << ",\n \"poles\": " << json_list(r.continuity.poles, [&](const Pole& p) {
               const Member& m = r.selection.patches[p.member];
               return "{\"surface\": " + json_text(m.name) + ", \"edge\": " + json_text(m.patch.edge_name(p.edge)) + ", \"at\": " + json_text(p.at) + "}";
           })
        << ",\n \"open\": " << json_list(r.continuity.open, [&](const Joint::Side& s) { return json_of(r, Joint{}, s); })
        << ",\n \"tolerance\": " << json_text(r.options.tolerance) << ", \"angle\": " << json_text(r.options.angle) << ", \"curvature\": " << json_text(r.options.curvature)
        << ",\n \"failed\": " << json_list(r.failed, [](const std::string& s) { return json_text(s); }) << ", \"unproved\": " << json_list(r.unproved, [](const std::string& s) { return json_text(s); }) << "}\n";
}

// ---- text

std::string brief(double x, bool up) { return std::isfinite(x) ? bound_text(x, 3, up) : "?"; }

/// "0.00123" where the bounds agree on it, else "< 1e-15".
std::string cell(const JumpBound& b) {
    std::string text = (b.lower >= 0.9 * b.inside ? "" : "<") + brief(b.inside, true) + (b.singular.empty() ? "" : "*");
    text.insert(0, text.size() < 10 ? 10 - text.size() : 0, ' ');
    return text;
}

void print_joints(std::ostream& out, const Report& r, const std::vector<Joint>& joints) {
    static const std::vector<std::string> ranks{"not joined", "undecided", "C0", "G1", "G2", "C1", "C2"};
    std::vector<std::pair<std::size_t, const Joint*>> sorted;
    for (const Joint& j : joints) sorted.push_back({std::find(ranks.begin(), ranks.end(), order_of(j, r.options).text) - ranks.begin(), &j});
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::size_t wide = 6;
    for (const Joint& j : joints) wide = std::max({wide, text_of(r, j, j.a).size(), text_of(r, j, j.b).size()});
    const auto padded = [&](std::string s) { return s + std::string(wide + 2 - std::min(wide, s.size()), ' '); };
    out << "  " << padded("edge") << padded("meets") << "        c0        c1        c2   g1 (deg)        g2  order\n";
    for (const auto& [rank, j] : sorted) {
        const JointOrder order = order_of(*j, r.options);
        out << "  " << padded(text_of(r, *j, j->a)) << padded(j->kind == Joint::Kind::line ? "itself" : text_of(r, *j, j->b));
        for (const int m : {kC0, kC1, kC2, kG1, kG2}) out << (m == kG1 ? " " : "") << cell(j->jumps[std::size_t(m)]);
        out << "  " << order.text << (order.geometric.empty() || order.geometric == order.text ? "" : ", " + order.geometric);
        for (const std::string& u : order.undecided) out << (u == "C0" ? "" : "; " + u + " undecided");
        if (!order.inside.empty()) out << "; " << order.inside << " but for the ends*";
        if (j->kind == Joint::Kind::seam || j->kind == Joint::Kind::t_joint || j->kind == Joint::Kind::gap) out << " (" << kKinds[int(j->kind)] << ")";
        out << (j->affine ? "" : " (other parametrisation)") << "\n";
    }
}

void print_surface(std::ostream& out, const Report& r, const Examined& e) {
    if (e.data.conditions.empty() && e.residuals.empty()) return;
    out << "\n" << e.name << ": its data are " << (e.compatible() ? "compatible" : "not compatible") << "\n";
    for (const Condition& c : e.data.conditions) {
        out << "  " << c.what << ": gap " << brief(c.gap, true);
        if (c.gap > c.tolerance) out << ", above " << brief(c.tolerance, true) << (c.remedy.empty() ? "" : "; remedy: " + c.remedy);
        out << "\n";
    }
    for (std::size_t k = 0; k < e.residuals.size(); ++k) {
        const JumpBound& b = e.residuals[k];
        out << "  " << e.data.promises[k].what << ", proved within " << brief(b.inside, true) << (e.data.promises[k].derivative == kNormal ? " degrees" : "") << (b.singular.empty() ? "" : " (but for 1/4096 of the edge at singular ends)") << (b.inside <= r.allowed(e.data.promises[k]) ? "" : " at worst, at least " + brief(b.lower, false)) << "\n";
    }
}

void print_text(std::ostream& out, const Report& r) {
    const Continuity& c = r.continuity;
    out << r.selection.patches.size() << (r.selection.patches.size() == 1 ? " patch, " : " patches, ") << c.joints.size() << " joined edges, " << c.open.size() << " open, " << c.poles.size()
        << " collapsed to a point; tolerance " << brief(r.options.tolerance, true) << ", " << brief(r.options.angle, true) << " degrees\n";
    for (const Examined& e : r.surfaces) print_surface(out, r, e);
    if (!c.joints.empty()) out << "\nEdges: largest jumps, proved for the whole edge\n", print_joints(out, r, c.joints);
    if (!c.lines.empty()) out << "\nLines between the cells of a patch\n", print_joints(out, r, c.lines);
    for (const auto* list : {&c.joints, &c.lines})
        if (std::any_of(list->begin(), list->end(), [](const Joint& j) { return std::any_of(j.jumps.begin(), j.jumps.end(), [](const JumpBound& b) { return !b.singular.empty(); }); })) {
            out << "\n* without a bound for 1/4096 of the edge, next to an end where the surface is singular (a pole or apex)\n";
            break;
        }
    if (!c.poles.empty()) out << "\nCollapsed edges\n";
    for (const Pole& p : c.poles)
        out << "  " << r.selection.patches[p.member].name << " " << r.selection.patches[p.member].patch.edge_name(p.edge) << " is the point (" << to_text(p.at.x) << ", " << to_text(p.at.y) << ", " << to_text(p.at.z) << ")\n";
    out << "\n";
    for (const std::string& s : r.failed) out << "FAILED: " << s << "\n";
    for (const std::string& s : r.unproved) out << "NOT PROVED: " << s << "\n";
    if (r.failed.empty() && r.unproved.empty()) out << "All that these surfaces promise is proved; edges of one surface that are near each other meet.\n";
}

/// Why nothing below some size can be proved, where that is above the tolerance: coordinates have rounding of their own, and bounds are some hundred times it.
std::string rounding_note(const Bounds& box, double tolerance) {
    double reach = 0;
    for (int k = 0; k < 3; ++k) reach = std::max({reach, std::fabs(box.low[k]), std::fabs(box.high[k])});
    const double rounding = 0x1p-53 * reach;
    if (!(1000 * rounding > tolerance)) return {};
    return "the surfaces reach " + bound_text(reach, 3, true) + " from the origin, where coordinates are rounded by " + bound_text(rounding, 3, true) + "; bounds some hundred times that cannot decide at the tolerance " +
           bound_text(tolerance, 3, true) + ": move the surfaces to the origin, or give a larger --tolerance";
}

int run(const std::vector<std::string>& arguments) {
    const Options options("check", arguments,
                          {{"--surface", true}, {"--set", true}, {"--tolerance", true}, {"--angle", true}, {"--capture", true}, {"--halvings", true}, {"--json", false}});
    const auto tolerance = options.tolerance();
    const auto angle = options.number("--angle");
    if (angle && !(*angle > 0 && *angle <= 180)) options.fail("--angle: found " + to_text(*angle) + ", expected degrees above 0, at most 180");
    const auto capture = options.value("--capture");
    const auto halvings = options.integer("--halvings", 0, 1'000'000);
    const Scene scene = options.scene();
    Report r;
    r.selection = select_patches(scene, options);
    ContinuityOptions& how = r.options;
    const Bounds box = bounding_box(r.selection.patches);
    how.size = finite_diagonal(scene, box);
    if (how.size == 0) throw_input(scene.place + ": found surfaces of size 0, expected some that have edges to check");
    how.tolerance = tolerance ? absolute_tolerance(*tolerance, how.size, options) : 1e-9 * how.size;
    how.capture = !capture ? 1e-2 * how.size : *capture == "0" ? 0 : absolute_tolerance(parse_tolerance(*capture), how.size, options);
    how.curvature = how.tolerance / (how.size * how.size);
    if (angle) how.angle = *angle;
    if (halvings) how.max_halvings = *halvings;
    how.surface = r.selection.surface;
    r.continuity = find_continuity(r.selection.patches, how);
    examine_surfaces(scene, r);
    judge_joints(r);
    judge_promises(r);
    (options.has("--json") ? print_json : print_text)(std::cout, r);
    const std::string note = r.unproved.empty() ? "" : rounding_note(box, how.tolerance);
    if (!note.empty() && !options.quiet()) std::cerr << "isoparm check: " << note << "\n";
    return !r.failed.empty() ? kCheckFailed : !r.unproved.empty() ? kWarning : kSuccess;
}

}  // namespace

const Command check_command = {"check", "how the patches join: C0, C1, C2, G1, G2, proved along every edge", kHelp, run};

}  // namespace isoparm
