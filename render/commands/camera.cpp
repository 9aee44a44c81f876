#include <iostream>

#include "commands/render_options.h"
#include "error.h"
#include "picture/layout.h"

namespace isoparm {

namespace {

constexpr const char* kHelp = R"(usage: isoparm camera print SCENE [--size WxH | --width W] [--set p=v] ...

Prints the camera with which isoparm render draws the scene, with everything that "fit" leaves open decided: a JSON
object for the scene's "camera", or a file for render --camera FILE, so that several pictures share it. Of panels, that
of the first without a camera of its own.

--size, --width, --dpi, --font-size, --set   as in isoparm render
--quiet           no messages; --threads N  at most N threads
)";

std::string listed_numbers(const Point& p) { return "[" + to_text(p.x) + ", " + to_text(p.y) + ", " + to_text(p.z) + "]"; }

Camera camera_of(const Scene& scene, const RenderOptions& how) {
    // Insets stand behind the view that they are of.
    const auto views = layout_of(scene, how).views;
    std::vector<std::size_t> panels;
    for (std::size_t i = 0; i < views.size(); ++i)
        if (!views[i].inset) panels.push_back(i);
    std::size_t k = 0;
    while (k + 1 < panels.size() && scene.panels[k].camera) ++k;
    return camera_of(views[panels[k]]);
}

int run(const std::vector<std::string>& arguments) {
    std::vector<Options::Known> known = paper_options();
    known.insert(known.end(), {{"--size", true}, {"--set", true}});
    const Options options("camera", arguments, known);
    if (options.words().size() != 2 || options.words()[0] != "print") options.fail("expected: isoparm camera print SCENE");
    const Scene scene = options.scene_at(options.words()[1]);
    const Bounds box = bounding_box(scene);
    finite_diagonal(scene, box);
    const CameraSettings c = settings_of(camera_of(scene, read_render_options(options)), 0.5 * (box.low + box.high));
    const std::string view = c.orthographic ? "\"orthographic\": " + to_text(*c.orthographic) : "\"fov\": " + to_text(c.fov);
    std::cout << "{ \"eye\": " << listed_numbers(*c.eye) << ", \"target\": " << listed_numbers(*c.target) << ", \"up\": " << listed_numbers(*c.up) << ", " << view << " }\n";
    return kSuccess;
}

}  // namespace

const Command camera_command = {"camera", "the camera of a picture, for others", kHelp, run};

}  // namespace isoparm
