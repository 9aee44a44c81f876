#include "panels.h"

#include <algorithm>

#include "drawn.h"
#include "error.h"
#include "overlay.h"
#include "palette.h"
#include "text_cairo.h"

namespace isoparm {
namespace {

constexpr double kTitle = 1.9, kBase = 1.15;  // height of a title and place of its base line, in sizes of its letters

std::vector<Point> joined(std::vector<Point> a, const std::vector<Point>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

}  // namespace

std::vector<View> views_of(const Scene& scene, int width, int height, const std::vector<Point>& also_fit, std::optional<double> asked) {
    const auto objects = drawn_objects(scene);
    const auto all = joined(drawn_points(scene, objects), also_fit);
    if (scene.panels.empty())
        return {{objects, scene.camera, all, 0, 0, width, height, asked.value_or(letter_size(width, height, width, height))}};

    const int rows = scene.panel_rows, columns = scene.panel_columns, w = width / columns;
    const double letter = asked.value_or(letter_size(width, height, w, height / rows));
    const bool titled =
        std::any_of(scene.panels.begin(), scene.panels.end(), [](const Panel& p) { return !p.title.empty(); });
    const int title = titled ? static_cast<int>(kTitle * letter + 0.5) : 0, h = height / rows - title;
    if (w < 1 || h < 1)
        throw Error(ErrorKind::usage, "a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                                          " pixels is too small for " + std::to_string(rows) + "x" +
                                          std::to_string(columns) + " panels: expected a larger --size");
    std::vector<View> views;
    const int left = (width - columns * w) / 2, top = (height - rows * (h + title)) / 2;
    for (std::size_t i = 0; i < scene.panels.size(); ++i) {
        const Panel& p = scene.panels[i];
        std::vector<SceneObject> own(objects.begin() + static_cast<std::ptrdiff_t>(p.first),
                                     objects.begin() + static_cast<std::ptrdiff_t>(p.last));
        const auto fitted = p.camera ? drawn_points(scene, own) : all;
        const int row = static_cast<int>(i) / columns, column = static_cast<int>(i) % columns;
        views.push_back({std::move(own), p.camera.value_or(scene.camera), fitted, left + column * w,
                         top + row * (h + title), w, h, letter});
    }
    return views;
}

Drawing titles_of(const Scene& scene, const std::vector<View>& views) {
    Drawing titles;
    for (std::size_t i = 0; i < scene.panels.size(); ++i) {
        const View& v = views[i];
        if (scene.panels[i].title.empty()) continue;
        const TextBox box = text_box(scene.panels[i].title, v.letter);
        titles.push_back({Text{{v.x + 0.5 * (v.width - box.left - box.right), v.y + v.height + kBase * v.letter},
                               v.letter,
                               scene.panels[i].title,
                               0},
                          ink_color()});
    }
    return titles;
}

}  // namespace isoparm
