#include <cstdio>
#include <functional>

#include "commands/frames.h"
#include "commands/output.h"
#include "commands/render_options.h"
#include "paper.h"
#include "progress.h"

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
--tolerance T     1e-3 in scene units, 1e-4rel of the bounding-box diagonal, 0.25px of the picture; otherwise the scene's
--crop x0,y0,x1,y1  only these pixels, x0 <= x < x1, y0 <= y < y1, y down
--aov LIST        further channels in the same .exr, of the ray through the middle of each pixel: all, or some of
                  N,Ng,P,uv,albedo,Z,patch,triangle,curvature,error,variance (docs/rendering.md)
--exact           rays meet the surfaces themselves, not meshes: hits are proved (docs/exact.md); slower. Curves and points are
                  as they were, and --tolerance is for them only
--reproducible    no dates or host names in the file, which is the case anyway
--set p=NUMBER    another value of a parameter of the scene; may be repeated
--frames N        N pictures, 2 to 10000; IMAGE then holds %d or %04d, which is replaced by 0, 1, ... N-1
--animate p=A:B   the parameter p goes from A in the first frame to B in the last, evenly; --animate p goes from its min
                  to its max. May be repeated. Cameras that fit have all frames in the picture
--quiet           no messages; --threads N  at most N threads
)";

void render_one(const Scene& scene, const std::string& output, RenderOptions how, const Options& options) {
    const bool quiet = options.quiet();
    finite_diagonal(scene, bounding_box(scene));
    how = rendering_of(std::move(how), output);
    const Picture picture = [&] {
        ProgressBar bar("rendering", quiet);
        how.progress = std::ref(bar);
        return render(scene, how);
    }();
    write_picture(options, output, scene, how, picture);
    if (!quiet) std::fprintf(stderr, "%s: %s\n", output.c_str(), summary_of(picture).c_str());
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

int run(const std::vector<std::string>& arguments) {
    std::vector<Options::Known> known = paper_options();
    known.insert(known.end(),
                          {{"-o", true}, {"--size", true}, {"--samples", true}, {"--tolerance", true}, {"--crop", true}, {"--set", true}, {"--reproducible", false}, {"--frames", true}, {"--animate", true},
                           {"--camera", true}, {"--exact", false}, {"--aov", true}});
    const Options options("render", arguments, known);
    const std::string output = options.required("-o", "the image file to write");
    RenderOptions how = read_render_options(options);
    how.aovs = read_aovs(options, output);
    how.exact = options.has("--exact");
    if (options.has("--frames") || options.has("--animate")) {
        const auto frames = frames_of(options, output);
        how.also_fit = points_of(frames, options);
        for (const Frame& f : frames) render_one(scene_of(options, f.parameters), f.path, how, options);
        return kSuccess;
    }
    check_picture_path(options, output);
    std::vector<NamedFile> files;
    for (const std::string& file : paper_files(output)) files.push_back({"-o", file});
    const Scene scene = scene_of(options);
    std::vector<NamedFile> inputs = inputs_of(scene);
    if (const auto camera = options.value("--camera")) inputs.push_back({"--camera", *camera});
    check_outputs(options, files, inputs);
    render_one(scene, output, how, options);
    return kSuccess;
}

}  // namespace

const Command render_command = {"render", "a ray-traced picture", kHelp, run};

}  // namespace isoparm
