#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "commands/output.h"
#include "commands/render_options.h"
#include "commands/selection.h"
#include "error.h"
#include "picture/heat_map.h"
#include "picture/progress.h"
#include "provenance.h"
#include "scene/json.h"
#include "scene/suggest.h"
#include "sha256.h"
#include "study/peer.h"
#include "study/study_output.h"
#include "study/study_plots.h"
#include "text/printable_text.h"

namespace isoparm {
namespace {

constexpr const char* kHelp = R"(usage: isoparm study SCENE -o DIR [--surface S] [--tolerances LIST] [--methods LIST] [--set p=v] ...

Tessellates surfaces by several methods at several tolerances, each mesh with the same certificate of its error, and
compares triangles, proved and sampled error, time and shape. Writes to DIR: index.html, one page that needs nothing
else; study.csv and study.json; diagrams as .svg and .pdf; pictures of the error on the surface in heat/.

A study that was killed goes on where it was: every finished run lies in DIR/runs/, and counts as long as scene, options
and program are the same. Files there that do not are made again, with a note. No file is deleted.

-o DIR            made when it does not exist
--surface S       one surface, or one patch of it, as in teapot/teapot#7; otherwise all surfaces that the scene draws
--tolerances LIST as 1e-2,1e-3 in scene units or 1e-2rel,1e-3rel of the bounding-box diagonal; otherwise 10^-1.5 to 10^-5
                  of the diagonal in half decades. The pictures are of the middle one
--methods LIST    as uniform,fast; otherwise all but the last two, which take a hundred times the time of fast:
                  uniform     every patch on one n x n grid, with the smallest n that is proved
                  quadtree    a restricted quadtree on each patch, refined where the proof fails
                  fast        isoparm tessellate
                  parametric  isoparm tessellate --measure parametric
                  optimal     isoparm tessellate --quality optimal
                  opencascade OpenCASCADE's BRepMesh, with the largest deflection whose mesh is proved to keep the
                              tolerance; where it was found when isoparm was built
--max-triangles N 4000000: a run that would need more is recorded as not reached, and the study goes on
--size WxH        of the pictures, 1000x750
--reproducible    no date in study.json and on the page (times are measured all the same)
--set p=NUMBER    another value of a parameter of the scene; may be repeated
--quiet           no messages; --threads N  at most N threads: the meshes are the same for every N
)";

std::vector<std::string> parts_of(const std::string& list) {
    std::vector<std::string> parts;
    for (std::size_t from = 0; from <= list.size();) {
        const std::size_t to = std::min(list.find(',', from), list.size());
        parts.push_back(list.substr(from, to - from));
        from = to + 1;
    }
    return parts;
}

std::vector<std::string> chosen_methods(const Options& options) {
    std::vector<std::string> names, usual, chosen;
    for (const StudyMethod& m : all_study_methods()) {
        names.push_back(m.name);
        if (!m.slow) usual.push_back(m.name);
    }
    const auto list = options.value("--methods");
    if (!list) return usual;
    for (const std::string& name : parts_of(*list)) {
        if (!find_any_study_method(name))
            options.fail("--methods: found " + quoted(name) + ", expected one of: " + listed(names) + did_you_mean(name, names));
        if (std::find(chosen.begin(), chosen.end(), name) == chosen.end()) chosen.push_back(name);
    }
    return chosen;
}

std::vector<double> chosen_tolerances(const Options& options, double diagonal) {
    std::vector<double> chosen;
    if (const auto list = options.value("--tolerances")) {
        for (const std::string& text : parts_of(*list)) {
            const Tolerance t = [&] {
                try {
                    return parse_tolerance(text);
                } catch (const Error&) {
                    options.fail("--tolerances: found " + quoted(text) +
                                 " in the list, expected positive numbers, as 1e-2,1e-3 (scene units) or 1e-2rel,1e-3rel (of the "
                                 "bounding-box diagonal)");
                }
            }();
            chosen.push_back(absolute_tolerance(t, diagonal, options));
        }
    } else {
        chosen = default_tolerances(diagonal);
    }
    std::sort(chosen.rbegin(), chosen.rend());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    return chosen;
}

/// A digest of the surfaces themselves, whatever files and parameters they come from.
std::string geometry_of(const Composite& patches) {
    constexpr int n = 9;
    std::string all;
    const auto add = [&](double x) { all += to_text(x) + " "; };
    for (const Member& m : patches) {
        all += m.name + "\n";
        const auto us = m.patch.lines_u(), vs = m.patch.lines_v();
        for (std::size_t i = 0; i + 1 < us.size(); ++i)
            for (std::size_t j = 0; j + 1 < vs.size(); ++j)
                for (int k = 0; k < n * n; ++k) {
                    const double u = us[i] + (us[i + 1] - us[i]) * (k / n) / (n - 1), v = vs[j] + (vs[j + 1] - vs[j]) * (k % n) / (n - 1);
                    const Point p = m.patch.domain() == Domain::triangle ? m.patch.point(u, v * (1 - u)) : m.patch.point(u, v);
                    add(u), add(v), add(p.x), add(p.y), add(p.z);
                }
    }
    return sha256(all);
}

/// Names that the study writes at the end must be free, or another study's.
void check_folder(const StudyStore& store, const Study& study, const Options& options) {
    std::vector<NamedFile> outputs;
    for (const char* name : {"study.json", "study.csv", "index.html"}) outputs.push_back({"-o", store.path(name)});
    for (const StudyPlot& p : study_plots({}, study.methods))
        for (const char* extension : {".svg", ".pdf"}) outputs.push_back({"-o", store.path(p.file + extension)});
    check_outputs(options, outputs, inputs_of(study.scene));
    for (const NamedFile& input : inputs_of(study.scene))  // files of all names go to these folders
        for (const char* folder : {"runs", "heat"}) {
            std::error_code code;
            const auto of = std::filesystem::absolute(input.path, code).parent_path();
            if (std::filesystem::equivalent(of, store.path(folder), code) && !code)
                options.fail("-o: found the folder of " + printable(input.path) + ", which " + input.option + " is, expected one whose " + folder + "/ holds no file that is read");
        }
    const std::string json = store.path("study.json");
    bool ours = false;
    try {
        ours = std::filesystem::exists(json) && Json::parse(read_text_file(json), json).find("isoparm_study") != nullptr;
    } catch (const Error&) {
    }
    for (const NamedFile& o : outputs)
        if (!ours && std::filesystem::exists(o.path))
            throw Error(ErrorKind::io, o.path + ": found a file that is not of a study, expected none; choose another folder for -o");
}

class Runner {
public:
    Runner(const Study& study, const StudyStore& store) : study_(study), store_(store), bar_("study", study.quiet) {}

    std::vector<StudyRow> run() {
        struct Place {
            std::string method;
            double tolerance, weight;
            std::optional<StudyRow> known;
        };
        std::vector<Place> places;
        std::size_t kept = 0;
        for (const std::string& method : study_.methods)
            for (const double tolerance : study_.tolerances) {
                Place p{method, tolerance, study_.diagonal / tolerance + 1000, {}};  // about as its triangles
                std::string note;
                const bool pictures = tolerance == study_.heat_tolerance();
                p.known =
                    store_.find(method, tolerance, key(method, tolerance), pictures ? study_.picture_size : std::array<int, 2>{}, note);
                if (!note.empty()) say("note: " + note);
                kept += p.known.has_value();
                if (!p.known) left_ += p.weight;
                places.push_back(std::move(p));
            }
        if (kept > 0) say(std::to_string(kept) + " of " + std::to_string(places.size()) + " runs were there already");
        std::vector<StudyRow> rows;
        for (Place& p : places) {
            rows.push_back(p.known ? *p.known : make(p.method, p.tolerance, p.weight));
            if (!p.known) done_ += p.weight;
        }
        return rows;
    }

private:
    std::string key(const std::string& method, double tolerance) const {
        return sha256(program_version() + "\n" + study_.geometry_hash + "\n" + method + "\n" + to_text(tolerance) + "\n" +
                      std::to_string(study_.max_triangles) + (method == peer_study_method.name ? "\n" + Peer::version() : ""));
    }

    StudyRow make(const std::string& method, double tolerance, double weight) {
        StudyInput input{study_.patches, tolerance, study_.max_triangles, {}};
        input.progress = [&](double fraction) { bar_((done_ + weight * fraction) / left_); };
        input.progress(0);
        StudyResult result = run_study(*find_any_study_method(method), input);
        StudyRow row{result.run, key(method, tolerance), study_.threads, {}};
        if (tolerance == study_.heat_tolerance() && result.run.reached) row.heat = draw(result);
        store_.save(row);
        const StudyRun& r = result.run;
        char text[256];
        if (r.reached) {
            std::snprintf(text, sizeof text, "%s at %.3g: %zu triangles, certified error %.3g, %.2f x optimum, %.2f s", method.c_str(),
                          tolerance, r.triangles, r.certified_error, r.ratio(), r.seconds);
            say(text);
        } else {
            say(method + ": " + r.reason);
        }
        return row;
    }

    std::vector<std::string> draw(StudyResult& result) const {
        const StudyRun& r = result.run;
        sharpen_bounds(study_.patches, result);
        std::vector<std::string> names;
        for (const bool certified : {true, false}) {
            const std::string what = certified ? "certified" : "sampled";
            char title[160];
            std::snprintf(title, sizeof title, "%s: %s error at tolerance %.3g, %zu triangles", r.method.c_str(), what.c_str(), r.tolerance,
                          r.triangles);
            const HeatMap map{result.mesh, certified ? result.certified : result.sampled, r.tolerance, title, what + " error / tolerance"};
            names.push_back("heat/" + r.method + "-" + what + ".png");
            write_image(store_.path(names.back()), draw_heat_map(map, study_.scene.camera, study_.picture_size[0], study_.picture_size[1]),
                        {{"Software", "isoparm " + program_version()}, {"Title", title}});
        }
        return names;
    }

    void say(const std::string& text) const {
        if (!study_.quiet) std::fprintf(stderr, "%sisoparm study: %s\n", isatty(STDERR_FILENO) ? "\r\033[K" : "", text.c_str());
    }

    const Study& study_;
    const StudyStore& store_;
    ProgressBar bar_;
    double left_ = 0, done_ = 0;
};

int run(const std::vector<std::string>& arguments) {
    const Options options("study", arguments,
                          {{"-o", true},
                           {"--surface", true},
                           {"--tolerances", true},
                           {"--methods", true},
                           {"--max-triangles", true},
                           {"--size", true},
                           {"--set", true},
                           {"--reproducible", false}});
    Study study;
    const std::string folder = options.required("-o", "the folder to write to");
    study.methods = chosen_methods(options);
    study.quiet = options.quiet();
    study.reproducible = options.has("--reproducible");
    if (const auto most = options.integer("--max-triangles", 1, 200'000'000)) study.max_triangles = std::size_t(*most);
    if (options.has("--size")) {
        const RenderOptions pictures = read_render_options(options);
        study.picture_size = {std::max(pictures.width, 64), std::max(pictures.height, 48)};
    }
    study.scene = options.scene();
    study.patches = select_patches(study.scene, options).patches;
    study.diagonal = finite_diagonal(study.scene, bounding_box(study.patches));
    study.tolerances = chosen_tolerances(options, study.diagonal);
    if (!(study.tolerances.back() > 0))
        throw_input(study.scene.place + ": found surfaces of size 0, expected some that a relative tolerance can be taken of");
    study.threads = std::min(int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)),
                             tbb::this_task_arena::max_concurrency());
    study.scene_hash = sha256(read_text_file(study.scene.path));
    study.geometry_hash = geometry_of(study.patches);
    for (const char* name : {"--surface", "--tolerances", "--methods", "--set"})
        for (const std::string& value : options.values(name))
            study.options += (study.options.empty() ? "" : " ") + std::string(name) + " " + value;

    const StudyStore store(folder);
    check_folder(store, study, options);
    const std::vector<StudyRow> rows = Runner(study, store).run();
    write_results(study, store, rows);
    if (!study.quiet) std::fprintf(stderr, "%s: %zu runs\n", store.path("index.html").c_str(), rows.size());
    return kSuccess;
}

}  // namespace

const Command study_command = {"study", "methods of tessellation compared: tables, diagrams, one page", kHelp, run};

}  // namespace isoparm
