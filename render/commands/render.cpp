#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>

#include "commands/frame_list.h"
#include "commands/frames.h"
#include "commands/interruption.h"
#include "commands/output.h"
#include "commands/picture_key.h"
#include "commands/render_options.h"
#include "commands/turntable.h"
#include "drawing/drawn.h"
#include "drawing/paper.h"
#include "image/video.h"
#include "picture/progress.h"
#include "scene/suggest.h"
#include "scratch_folder.h"
#include "text/short_text.h"

namespace isoparm {

namespace {

constexpr const char* kHelp = R"(usage: isoparm render SCENE -o IMAGE [--size WxH] [--samples N] [--tolerance T] [--crop x0,y0,x1,y1] ...

Ray-traces a scene from meshes whose error is proved; positions and normals that are shaded are those of the exact
surfaces. The same scene gives the same bytes, for every number of threads and at any time.

-o IMAGE          .exr (linear), .png (sRGB) and other formats of OpenImageIO; scene, tolerance and certified error are
                  in the metadata. .pdf, .svg, .tex (TikZ): the raster with lines and letters over it as vectors and text
                  (docs/paper.md)
--size WxH        width and height in pixels; otherwise the scene's
--width 84mm      width on paper instead (mm, cm, in, pt), and --dpi N pixels an inch, 300 when not given
--font-size 8pt   of letters for which the scene says no size
--text fonts|outlines   of .pdf and .svg: letters as text (the default), or as outlines
--camera FILE     the camera of a file, as isoparm camera print writes it
--samples N       samples a pixel; otherwise the scene's
--noise X         as many samples as a noise of X takes, in blocks of 8 x 8 pixels, at most those of --samples: the standard error of
                  pixels as they are shown (sRGB, white is 1; 0.004 is a grey level). Exit code 1 when some blocks
                  do not come to it. 0: not even when the scene asks
--preview         writes a coarse picture at once, and a finer one in its place now and then
--resume FILE     goes on where a run that was ended or killed has left FILE, to the same pixels; begins anew where there is no
                  FILE, writes it now and then, and removes it when the picture is written
--checkpoint-every S  seconds from one writing of FILE to the next, 0.1 to 86400; 60 when not given
--tolerance T     1e-3 in scene units, 1e-4rel of the bounding-box diagonal, 0.25px of the picture; otherwise the scene's
--crop x0,y0,x1,y1  only these pixels, x0 <= x < x1, y0 <= y < y1, y down; .exr and .png say where they lie in the whole
--aov LIST        further channels in the same .exr, of the ray through the middle of each pixel: all, or some of
                  N,Ng,P,uv,albedo,Z,patch,triangle,curvature,error,variance,sample_variance,samples (docs/rendering.md)
--exact           rays meet the surfaces themselves, not meshes: hits are proved (docs/exact.md); slower. Curves and points are
                  as they were, and --tolerance is for them only
--reproducible    no dates or host names in the file, which is the case anyway
--set p=NUMBER    another value of a parameter of the scene; may be repeated
--frames N        N pictures, 2 to 10000; IMAGE then holds %d or %04d, which is replaced by 0, 1, ... N-1. An IMAGE that ends in
                  .mp4, .webm or .gif is a film of them (ffmpeg makes it), --fps F frames a second, 25 when not given.
                  With --resume FILE, a folder that is made, the same command goes on with the first frame that is missing
--animate p=A:B   the parameter p goes from A in the first frame to B in the last, evenly; --animate p goes from its min
                  to its max. May be repeated. Cameras that fit have all frames in the picture
--turntable D     the camera goes round its target, D degrees from first to last (360: all the way, without the first
                  view again at the end), counter-clockwise seen from above
--quiet           no messages; --threads N  at most N threads

SIGINT (Ctrl-C) and SIGTERM end a picture early: it is written as it is, whole, with fewer samples (isoparm:unfinished and
isoparm:samples tell how many), and the exit code is 130 or 143. Once more ends at once. Frames of a film end without the
one that was being made, and without the film.
)";

constexpr int kUnfinished = -1;
constexpr double kSmallest = 1e-8;  // scene units across: from 1e-9 on down products of three lengths are no normal numbers

void check_size(const Scene& scene, double size, bool exact) {
    if (exact || !(size > 0) || size >= kSmallest) return;
    throw_input(scene.path + ": found a scene " + to_text(size) + " units across, so small that products of lengths vanish in single precision, in which rays meet triangles, expected at least " +
                to_text(kSmallest) + "; choose a smaller unit of length, or --exact");
}

bool blank(const Picture& picture, const std::optional<Color>& background) {
    const auto same = [&](const float* pixel) {
        if (!background) return pixel[3] == 0;
        return pixel[0] == static_cast<float>(background->x) && pixel[1] == static_cast<float>(background->y) && pixel[2] == static_cast<float>(background->z);
    };
    for (int y = 0; y < picture.image.height; ++y)
        for (int x = 0; x < picture.image.width; ++x)
            if (!same(picture.image.at(x, y))) return false;
    return std::all_of(picture.drawn.begin(), picture.drawn.end(), [](const DrawnPart& part) { return part.drawing.empty(); });
}
/// Parts of pictures may well show nothing.
void tell_if_blank(const Scene& scene, const Picture& picture, const std::string& name, bool part) {
    if (drawn_objects(scene).empty()) std::fprintf(stderr, "isoparm: note: %s: there is nothing to draw in %s, neither objects nor surfaces nor curves\n", name.c_str(), quoted(scene.path).c_str());
    else if (!part && blank(picture, scene.image.background)) std::fprintf(stderr, "isoparm: note: %s shows the background and nothing else: see where the camera looks, and whether the objects have an opacity of 0\n", name.c_str());
}

/// Whether the picture is as good as was asked for, as an exit code; or kUnfinished, and then `one_of_many`, a frame, is not written. `name`: in messages.
int render_one(const Scene& scene, const std::string& output, const std::string& name, RenderOptions how, const Options& options, bool one_of_many) {
    const bool quiet = options.quiet();
    check_size(scene, finite_diagonal(scene, bounding_box(scene)), how.exact);
    how = rendering_of(std::move(how), output);
    const Picture picture = [&] {
        ProgressBar bar("rendering", quiet);
        how.progress = std::ref(bar);
        if (bar.enabled()) how.tell_noise = [&](double noise) { bar.note("noise " + short_text(noise, 3)); };
        return render(scene, how);
    }();
    if (!picture.whole && one_of_many) return kUnfinished;
    write_picture(options, output, scene, how, picture);
    if (!quiet && !one_of_many) tell_if_blank(scene, picture, name, how.crop.has_value());
    if (!quiet) std::fprintf(stderr, "%s: %s\n", name.c_str(), summary_of(picture).c_str());
    const SampleCount& n = picture.samples;
    if (!picture.whole) return kUnfinished;
    if (!(n.missed > 0)) return kSuccess;
    std::fprintf(stderr, "isoparm: %s: %s %% of the picture did not come to a noise of %s within %d samples a pixel; --samples allows for more\n", name.c_str(), short_text(100 * n.missed, 3).c_str(),
                 short_text(n.target, 3).c_str(), n.most_asked);
    return kWarning;
}

/// One that may take long.
int render_long(const Scene& scene, const std::string& output, RenderOptions how, const Options& options) {
    how = rendering_of(std::move(how), output);
    how.checkpoint.path = options.value("--resume").value_or("");
    if (!how.checkpoint.path.empty()) how.checkpoint.key = picture_key(scene, how, options);
    if (const auto seconds = options.number("--checkpoint-every")) {
        if (how.checkpoint.path.empty()) options.fail("--checkpoint-every: found no --resume, expected --resume FILE");
        if (!(*seconds >= 0.1 && *seconds <= 86400)) options.fail("--checkpoint-every: found " + quoted(*options.value("--checkpoint-every")) + ", expected 0.1 to 86400 seconds");
        how.checkpoint.seconds = *seconds;
    }
    if (options.has("--preview")) how.preview = [&](const Picture& picture) { write_picture(options, output, scene, how, picture); };
    const Interruption interruption(options.quiet());
    how.stop = [&] { return interruption.signal() != 0; };
    const int code = render_one(scene, output, output, how, options, false);
    if (code == kUnfinished) {
        if (!options.quiet())
            std::fprintf(stderr, "isoparm: %s was written before it was finished%s\n", output.c_str(), how.checkpoint.path.empty() ? "" : (", the same command goes on with it (" + how.checkpoint.path + ")").c_str());
        return 128 + interruption.signal();
    }
    std::error_code none;
    if (!how.checkpoint.path.empty()) std::filesystem::remove(how.checkpoint.path, none);
    return code;
}

/// With the camera of --camera instead of its own.
Scene scene_of(const Options& options, const std::map<std::string, double>& parameters = {}) {
    Scene scene = options.scene(parameters);
    if (const auto camera = options.value("--camera")) {
        scene.camera = load_camera(*camera);
        for (Panel& p : scene.panels) p.camera.reset();
    }
    return scene;
}

/// Everything that the frames depend on.
std::string film_key(const std::vector<Frame>& frames, const RenderOptions& how, const Options& options) {
    std::string key = picture_key(scene_of(options, frames.front().parameters), how, options) + "frames " + std::to_string(frames.size()) + "\nturntable " + to_text(options.number("--turntable").value_or(0)) + "\n";
    for (const auto& text : options.values("--animate")) key += "animate " + text + "\n";
    for (const Aov a : how.aovs) key += "aov " + std::to_string(static_cast<int>(a)) + "\n";
    return key;
}

/// Frames, each in its file, and the film of them where `output` is one.
int render_frames(const std::string& output, RenderOptions how, const Options& options) {
    for (const char* one : {"--preview", "--checkpoint-every"})
        if (options.has(one)) options.fail(std::string(one) + ": found --frames, expected a single picture");
    const bool film = is_video(output);
    const double rate = options.number("--fps").value_or(25);
    if (options.has("--fps") && !film) options.fail("--fps: found " + quoted(output) + ", expected a film (.mp4, .webm, .gif)");
    if (!(rate >= 0.1 && rate <= 240)) options.fail("--fps: found " + quoted(*options.value("--fps")) + ", expected 0.1 to 240 frames a second");
    const Scene scene = options.scene();
    std::vector<NamedFile> inputs = inputs_of(scene);
    if (const auto camera = options.value("--camera")) inputs.push_back({"--camera", *camera});
    const bool transparent = !scene.image.background;
    if (film) {
        if (transparent && !holds_transparency(output)) options.fail("-o: found " + quoted(output) + ", which holds nothing transparent, expected .webm or .gif, or a scene with a background");
        check_outputs(options, {{"-o", output}}, inputs);
        find_encoder(output);
    }
    const auto kept = options.value("--resume");
    std::optional<ScratchFolder> scratch;
    if (kept && kept->find('%') != std::string::npos) options.fail("--resume: found " + quoted(*kept) + ", expected a name without %");
    if (kept) check_outputs_in(options, *kept, {"frames"}, inputs);
    else if (film) scratch.emplace();
    const std::string folder = kept ? *kept : film ? scratch->path() : "";
    const auto frames = frames_of(options, film ? folder + "/%05d.png" : output);
    how.also_fit = points_of(frames, options);
    std::optional<Turntable> table;
    if (options.has("--turntable")) {
        std::vector<double> degrees;
        for (const Frame& f : frames) degrees.push_back(f.degrees);
        table.emplace(scene_of(options, frames.front().parameters), how, degrees);
    }
    std::optional<FrameList> list;
    if (!folder.empty()) list.emplace(folder, film_key(frames, how, options));

    const Interruption interruption(true);
    how.stop = [&] { return interruption.signal() != 0; };
    int code = kSuccess, done = 0;
    for (const Frame& f : frames) {
        const int k = done++;
        if (list && list->has(k, f.path)) continue;
        Scene now = scene_of(options, f.parameters);
        if (table) table->turn(now, f.degrees);
        const std::string name = film ? output + ", frame " + std::to_string(done) + " of " + std::to_string(frames.size()) : f.path;
        const int good = interruption.signal() ? kUnfinished : render_one(now, f.path, name, how, options, true);
        if (good == kUnfinished) {
            if (!options.quiet())
                std::fprintf(stderr, "isoparm: ended after %d of %zu frames%s\n", k, frames.size(), kept ? (", the same command goes on with them (" + *kept + ")").c_str() : "");
            return 128 + interruption.signal();
        }
        code = std::max(code, good);
        if (list) list->add(k, f.path);
    }
    if (film) {
        write_video(output, list->pattern(), rate, transparent);
        if (!options.quiet()) std::fprintf(stderr, "%s: %zu frames, %s s\n", output.c_str(), frames.size(), short_text(static_cast<double>(frames.size()) / rate, 3).c_str());
    }
    if (list) list->remove(film ? done : 0);
    return code;
}

int run(const std::vector<std::string>& arguments) {
    std::vector<Options::Known> known = paper_options();
    known.insert(known.end(),
                          {{"-o", true}, {"--size", true}, {"--samples", true}, {"--tolerance", true}, {"--crop", true}, {"--set", true}, {"--reproducible", false}, {"--frames", true}, {"--animate", true}, {"--turntable", true}, {"--fps", true},
                           {"--camera", true}, {"--exact", false}, {"--aov", true}, {"--noise", true}, {"--preview", false}, {"--resume", true}, {"--checkpoint-every", true}});
    const Options options("render", arguments, known);
    const std::string output = options.required("-o", "the image file to write");
    RenderOptions how = read_render_options(options);
    how.aovs = read_aovs(options, output);
    how.exact = options.has("--exact");
    if (options.has("--frames") || options.has("--animate") || options.has("--turntable")) return render_frames(output, std::move(how), options);
    if (is_video(output) && std::filesystem::path(output).extension() != ".gif") options.fail("-o: found " + quoted(output) + ", a film, expected --frames N too, and --turntable or --animate");
    if (options.has("--fps")) options.fail("--fps: found a single picture, expected --frames N");
    check_picture_path(options, output);
    std::vector<NamedFile> files;
    for (const std::string& file : paper_files(output)) files.push_back({"-o", file});
    if (const auto checkpoint = options.value("--resume")) files.push_back({"--resume", *checkpoint});
    const Scene scene = scene_of(options);
    std::vector<NamedFile> inputs = inputs_of(scene);
    if (const auto camera = options.value("--camera")) inputs.push_back({"--camera", *camera});
    check_outputs(options, files, inputs);
    return render_long(scene, output, how, options);
}

}  // namespace

const Command render_command = {"render", "a ray-traced picture", kHelp, run};

}  // namespace isoparm
