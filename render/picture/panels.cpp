#include "picture/panels.h"

#include <algorithm>

#include "drawing/drawn.h"
#include "drawing/insets.h"
#include "drawing/legend.h"
#include "drawing/text_cairo.h"
#include "error.h"
#include "picture/palette.h"

namespace isoparm {
namespace {

constexpr double kLetters = 0.036;      // size of letters, of the picture's height, or of three quarters of its width,
constexpr double kMostLetters = 0.055;  // and of its panel's
constexpr double kTitle = 1.9, kBase = 1.15;  // height of a title and place of its base line, in sizes of its letters

std::vector<Point> joined(std::vector<Point> a, const std::vector<Point>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Vec2 room_of(const std::vector<SceneObject>& objects, double letter) {
    Vec2 room;
    for (const SceneObject& o : objects) {
        if (o.kind == SceneObject::Kind::axes)
            room = {std::max(room.x, 2.4 * letter), std::max(room.y, 1.6 * letter)};
        else if (!o.label.text.empty() || !o.net_labels.empty() || o.twists.on)
            room = {std::max(room.x, 0.8 * letter), std::max(room.y, 0.5 * letter)};
    }
    return room;
}

/// What the views leave free; those that share a camera alike, so that they have one scale.
void set_rooms(const Scene& scene, std::vector<View>& views) {
    Vec2 room;
    int legends = 0;
    const auto shares = [&](std::size_t i) { return i >= scene.panels.size() || !scene.panels[i].camera; };
    for (std::size_t i = 0; i < views.size(); ++i) {
        View& v = views[i];
        v.room = room_of(v.objects, v.letter);
        v.legends = legend_room(v.objects, v.letter, v.width).width;
        if (!shares(i)) continue;
        room = {std::max(room.x, v.room.x), std::max(room.y, v.room.y)};
        legends = std::max(legends, v.legends);
    }
    for (std::size_t i = 0; i < views.size(); ++i)
        if (shares(i)) views[i].room = room, views[i].legends = legends;
}

/// With the insets behind each view.
std::vector<View> with_insets(const Scene& scene, std::vector<View> views) {
    std::vector<View> all;
    for (std::size_t i = 0; i < views.size(); ++i) {
        View& v = views[i];
        std::vector<View> insets;
        for (const Inset& inset : scene.panels.empty() ? scene.insets : scene.panels[i].insets) insets.push_back(view_of(inset, v));
        for (const View& inset : insets) v.covered.push_back({inset.x - v.x, inset.y - v.y, inset.width, inset.height});
        all.push_back(std::move(v));
        for (View& inset : insets) all.push_back(std::move(inset));
    }
    return all;
}

}  // namespace

double letter_size(int picture_width, int picture_height, int width, int height) {
    const auto size = [](int w, int h) { return std::min(double(h), 0.75 * w); };
    return std::min(kLetters * size(picture_width, picture_height), kMostLetters * size(width, height));
}

Camera camera_of(const View& view) {
    // Made for the view whose legends are widest, then as wide as this one is: of one scale.
    const int own = legend_room(view.objects, view.letter, view.width).width;
    const auto made = [&](int width, int height, int own_legends, int legends) {
        Camera camera = make_camera(view.camera, view.fitted, std::max(1, width - legends), height, view.room);
        camera.width = std::max(1, width - own_legends);
        return camera;
    };
    if (!view.zoom) return made(view.width, view.height, view.inset ? 0 : own, view.legends);
    const auto& z = *view.zoom;
    const int width = static_cast<int>(z[3]);
    const Camera whole = made(width, static_cast<int>(z[4]), legend_room(view.objects, view.letter, width).width, view.legends);
    return zoomed(whole, z[0], z[1], z[2], view.width, view.height);
}

std::vector<View> views_of(const Scene& scene, int width, int height, const std::vector<Point>& also_fit, std::optional<double> asked) {
    const auto objects = drawn_objects(scene);
    const auto all = joined(drawn_points(scene, objects), also_fit);
    std::vector<View> views;
    if (scene.panels.empty()) {
        views.push_back({objects, scene.camera, all, 0, 0, width, height, asked.value_or(letter_size(width, height, width, height)), {}, 0, {}, {}});
        set_rooms(scene, views);
        return with_insets(scene, std::move(views));
    }

    const int rows = scene.panel_rows, columns = scene.panel_columns, w = width / columns;
    const double letter = asked.value_or(letter_size(width, height, w, height / rows));
    const bool titled =
        std::any_of(scene.panels.begin(), scene.panels.end(), [&](const Panel& p) { return !p.title.empty() || (!p.mark.empty() && !scene.marks_inside); });
    const int title = titled ? static_cast<int>(kTitle * letter + 0.5) : 0, h = height / rows - title;
    if (w < 1 || h < 1)
        throw Error(ErrorKind::usage, "a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                                          " pixels is too small for " + std::to_string(rows) + "x" +
                                          std::to_string(columns) + " panels: expected a larger --size");
    const int left = (width - columns * w) / 2, top = (height - rows * (h + title)) / 2;
    for (std::size_t i = 0; i < scene.panels.size(); ++i) {
        const Panel& p = scene.panels[i];
        std::vector<SceneObject> own(objects.begin() + static_cast<std::ptrdiff_t>(p.first),
                                     objects.begin() + static_cast<std::ptrdiff_t>(p.last));
        const auto fitted = p.camera ? drawn_points(scene, own) : all;
        const int row = static_cast<int>(i) / columns, column = static_cast<int>(i) % columns;
        views.push_back({std::move(own), p.camera.value_or(scene.camera), fitted, left + column * w,
                         top + row * (h + title), w, h, letter, {}, 0, {}, {}});
    }
    set_rooms(scene, views);
    return with_insets(scene, std::move(views));
}

Drawing titles_of(const Scene& scene, const std::vector<View>& views) {
    Drawing titles;
    std::size_t i = 0;
    for (const View& v : views) {
        if (v.inset || i == scene.panels.size()) continue;
        const Panel& panel = scene.panels[i++];
        const auto put = [&](const MathText& text, double x, double y, double halo) {
            if (!text.empty()) titles.push_back({Text{{x, y}, v.letter, text, halo}, ink_color()});
        };
        MathText title = panel.title;
        if (scene.marks_inside) {
            put(panel.mark, v.x + 0.3 * v.letter, v.y + kBase * v.letter, 0.09 * v.letter);
        } else if (!panel.mark.empty()) {
            MathText both = panel.mark;
            if (!title.empty()) both.push_back({"\u2002"});
            both.insert(both.end(), title.begin(), title.end());
            title = both;
        }
        const TextBox box = text_box(title, v.letter);
        put(title, v.x + 0.5 * (v.width - box.left - box.right), v.y + v.height + kBase * v.letter, 0);
    }
    return titles;
}

}  // namespace isoparm
