#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "commands/guard.h"
#include "commands/output.h"
#include "commands/render_options.h"
#include "drawing/paint.h"
#include "error.h"
#include "picture/contact_sheet.h"
#include "picture/progress.h"
#include "scene/suggest.h"

namespace isoparm {

namespace {

namespace fs = std::filesystem;

constexpr const char* kHelp = R"(usage: isoparm figures [NAME ...] -o DIR [--format F] [--size WxH | --width W] [--samples N] [--tolerance T] ...

Renders every scene that comes with the program, or those named, to DIR/NAME.png, and all of them small on
DIR/contact_sheet.png. A figure that fails does not stop the others; its exit code is that of the command.

-o DIR            made when it does not exist
--format F        png (default), exr, or for print pdf, svg, tex (docs/paper.md)
--size, --samples, --tolerance, --width, --dpi, --font-size, --text   as in isoparm render; otherwise as each scene says
--quiet           no messages; --threads N  at most N threads

ISOPARM_SCENES    the folder of the scenes, when it is not the program's own
)";

/// ISOPARM_SCENES, or scenes/ of the clone that the program was built in, or share/isoparm/scenes beside its bin/.
fs::path scenes_folder() {
    if (const char* given = std::getenv("ISOPARM_SCENES"); given && *given) {
        if (!fs::is_directory(given)) throw Error(ErrorKind::io, "ISOPARM_SCENES: " + quoted(given) + " is not a folder");
        return given;
    }
    std::error_code code;
    const fs::path here = fs::read_symlink("/proc/self/exe", code).parent_path();
    for (const char* place : {"../../scenes", "../share/isoparm/scenes", "../scenes"}) {
        const fs::path folder = (here / place).lexically_normal();
        if (fs::is_directory(folder, code)) return folder;
    }
    throw Error(ErrorKind::io, "the folder of the scenes was not found beside " + here.string() + "; name it in ISOPARM_SCENES");
}

/// name -> file, in alphabetical order. The schema is no scene.
std::vector<std::pair<std::string, fs::path>> scenes_in(const fs::path& folder) {
    std::vector<std::pair<std::string, fs::path>> scenes;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const fs::path& p = entry.path();
        if (p.extension() == ".json" && p.stem().extension() != ".schema") scenes.emplace_back(p.stem().string(), p);
    }
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

std::vector<std::pair<std::string, fs::path>> chosen_scenes(const Options& options) {
    const auto all = scenes_in(scenes_folder());
    if (all.empty()) throw Error(ErrorKind::io, scenes_folder().string() + ": found no scenes");
    if (options.words().empty()) return all;
    std::vector<std::pair<std::string, fs::path>> chosen;
    std::vector<std::string> names;
    for (const auto& s : all) names.push_back(s.first);
    for (const std::string& name : options.words()) {
        const auto k = std::find(names.begin(), names.end(), name);
        if (k == names.end()) options.fail("found " + quoted(name) + ", expected one of: " + listed(names) + did_you_mean(name, names));
        chosen.push_back(all[static_cast<std::size_t>(k - names.begin())]);
    }
    return chosen;
}

constexpr int kCellWidth = 384, kCellHeight = 288;

int run(const std::vector<std::string>& arguments) {
    std::vector<Options::Known> known = paper_options();
    known.insert(known.end(), {{"-o", true}, {"--size", true}, {"--samples", true}, {"--tolerance", true}, {"--format", true}});
    const Options options("figures", arguments, known);
    const std::string format = options.word("--format", {"png", "exr", "pdf", "svg", "tex"});
    const fs::path folder = options.required("-o", "the folder to write to");
    const RenderOptions how = read_render_options(options);
    const auto scenes = chosen_scenes(options);
    std::error_code code;
    fs::create_directories(folder, code);
    if (code) throw Error(ErrorKind::io, folder.string() + ": cannot be made: " + code.message());

    check_picture_path(options, (folder / ("contact_sheet." + format)).string());

    // No figure replaces what any of them reads, nor does the contact sheet.
    std::vector<NamedFile> inputs;
    for (const auto& scene : scenes) {
        const fs::path& file = scene.second;
        try {
            for (const NamedFile& input : inputs_of(load_scene(file.string()))) inputs.push_back(input);
        } catch (const std::exception&) {
            inputs.push_back({"SCENE", file.string()});  // what is wrong with it is told when it is its turn
        }
    }
    check_outputs(options, {{"-o", (folder / "contact_sheet.png").string()}}, inputs);

    int result = kSuccess;
    std::vector<Image> thumbnails;
    for (const auto& [name, file] : scenes) {
        const int figure = guarded([&, &name = name, &file = file] {
            const Scene scene = load_scene(file.string());
            if (!options.quiet()) print_notes(scene);
            finite_diagonal(scene, bounding_box(scene));
            const std::string path = (folder / (name + "." + format)).string();
            check_outputs(options, {{"-o", path}}, inputs);
            Picture picture = [&] {
                ProgressBar bar(name, options.quiet());
                RenderOptions with_bar = rendering_of(how, path);
                with_bar.progress = std::ref(bar);
                return render(scene, with_bar);
            }();
            write_picture(options, path, scene, how, picture);
            paint(picture.drawn, picture.image);
            thumbnails.push_back(thumbnail(picture.image, kCellWidth, kCellHeight));
            if (!options.quiet()) std::fprintf(stderr, "%s: %s\n", path.c_str(), summary_of(picture).c_str());
            return kSuccess;
        });
        if (figure != kSuccess && !options.quiet()) std::fprintf(stderr, "%s: failed\n", name.c_str());
        if (result == kSuccess) result = figure;
    }
    if (!thumbnails.empty()) write_image((folder / "contact_sheet.png").string(), contact_sheet(thumbnails, kCellWidth, kCellHeight), {});
    return result;
}

}  // namespace

const Command figures_command = {"figures", "every figure, and a contact sheet", kHelp, run};

}  // namespace isoparm
