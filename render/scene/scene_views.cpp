#include "scene/scene_views.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "scene/scene_objects.h"

namespace isoparm {

namespace {

using Kind = Json::Kind;

/// "2x3": rows by columns, enough for the panels.
void read_layout(const Json& j, const SceneValues& values, Scene& scene) {
    const std::string expected = "rows and columns with room for " + std::to_string(scene.panels.size()) + " panels, such as \"1x" + std::to_string(scene.panels.size()) + "\"";
    const std::string& text = values.text(j, expected);
    int rows = 0, columns = 0, end = 0;
    if (std::sscanf(text.c_str(), "%2dx%2d%n", &rows, &columns, &end) != 2 || end != static_cast<int>(text.size()) || rows < 1 || columns < 1 ||
        static_cast<std::size_t>(rows) * columns < scene.panels.size()) {
        j.expected(expected);
    }
    scene.panel_rows = rows;
    scene.panel_columns = columns;
}

// ---- marks ----------------------------------------------------------------------------------------------------------

/// 1, 2, 3 ... in the manner of `kind`: a, A, 1 or i. After z comes aa.
std::string counted(char kind, int n) {
    if (kind == '1') return std::to_string(n);
    std::string text;
    if (kind == 'i') {
        for (const auto& [value, letters] : {std::pair{50, "l"}, {40, "xl"}, {10, "x"}, {9, "ix"}, {5, "v"}, {4, "iv"}, {1, "i"}})
            for (; n >= value; n -= value) text += letters;
        return text;
    }
    for (; n > 0; n = (n - 1) / 26) text.insert(text.begin(), static_cast<char>(kind + (n - 1) % 26));
    return text;
}

/// Of several panels, (a), (b), (c), unless their titles begin so already.
void read_marks(const Json* j, const Json& panels, const SceneValues& values, Scene& scene) {
    const std::string expected = "true, false, or marks with one of a, A, 1 and i in them, such as \"(a)\", or {\"text\": \"(a)\", \"place\": \"inside\"}";
    std::string text = "(a)";
    bool wanted = scene.panels.size() > 1;
    for (const Json& p : panels.children()) {
        const auto title = p.find("title");
        if (title && title->string().starts_with("(")) wanted = false;
        if (p.find("mark")) wanted = false;
    }
    if (j) {
        if (j->is(Kind::object)) {
            j->allow_keys({"text", "place"});
            if (const auto place = j->find("place")) scene.marks_inside = values.word(*place, {"title", "inside"}) == 1;
        }
        const auto named = j->is(Kind::object) ? j->find("text") : nullptr;
        const Json* own = j->is(Kind::object) ? named.get() : j;
        if (own && own->is(Kind::boolean)) wanted = own->boolean();
        else if (own) text = values.text(*own, expected), wanted = true;
    }
    const auto letter = text.find_first_of("aA1i");
    if (letter == std::string::npos || text.size() > 20) (j->is(Kind::object) ? j->at("text", "") : *j).expected(expected);
    for (std::size_t k = 0; k < scene.panels.size(); ++k)
        if (wanted && scene.panels[k].mark.empty())
            scene.panels[k].mark = parse_math_text(std::string(text).replace(letter, 1, counted(text[letter], static_cast<int>(k) + 1)), true);
}

// ---- insets ---------------------------------------------------------------------------------------------------------

Inset read_inset(const Json& j, const SceneValues& values) {
    must_be_object(j, "an inset {\"around\": point, \"zoom\": 4, \"place\": \"above right\"}");
    j.allow_keys({"place", "size", "region", "around", "zoom", "camera", "lines", "line", "color"});
    const std::string part = "a part of the picture, from 0 to 1";
    Inset inset;
    if (const auto place = j.find("place")) {
        if (place->is(Kind::array)) {
            const auto corner = values.list(*place, 2, 2, "the frame's top left corner, [x, y] in parts of the picture");
            inset.at = Vec2{values.in_range(corner[0], 0, 1, part), values.in_range(corner[1], 0, 1, part)};
        } else {
            inset.side = static_cast<int>(values.word(*place, {"right", "above right", "above", "above left", "left", "below left", "below", "below right", "center"}));
        }
    }
    if (const auto size = j.find("size")) {
        const bool both = size->is(Kind::array);
        const auto sides = both ? values.list(*size, 2, 2, "the frame's [width, height] in parts of the picture") : std::vector<Json>{*size};
        inset.width = values.in_range(sides[0], 0.02, 1, "a width from 0.02 to 1, in parts of the picture's");
        if (both) inset.height = values.in_range(sides[1], 0.02, 1, "a height from 0.02 to 1, in parts of the picture's");
    }
    const auto region = j.find("region"), around = j.find("around"), zoom = j.find("zoom"), camera = j.find("camera");
    j.must_have_one({"region", "around", "camera"});
    if (zoom && !around) zoom->fail_at_key("found \"zoom\" without \"around\", expected the point that is in the middle");
    if (region) {
        const auto r = values.numbers(*region, 4, 4, "numbers x0, y0, x1, y1 in parts of the picture, from its top left corner");
        if (!(r[0] >= 0 && r[1] >= 0 && r[2] <= 1 && r[3] <= 1 && r[2] - r[0] >= 1e-4 && r[3] - r[1] >= 1e-4)) region->expected("[x0, y0, x1, y1] with 0 <= x0 < x1 <= 1 and 0 <= y0 < y1 <= 1");
        inset.region = std::array{r[0], r[1], r[2], r[3]};
    }
    if (around) inset.around = values.point(*around);
    if (zoom) inset.zoom = values.in_range(*zoom, 1, 1000, "a number from 1 to 1000: how many times as large");
    if (camera) inset.camera = read_camera(*camera, values);
    if (const auto lines = j.find("lines")) inset.lines = values.boolean(*lines);
    if (const auto line = j.find("line")) inset.line = read_pixels(*line, values, 1000, "a width");
    if (const auto color = j.find("color")) inset.color = values.color(*color);
    return inset;
}

std::vector<Inset> read_insets(const Json& j, const SceneValues& values) {
    std::vector<Inset> insets;
    for (const Json& inset : values.list(j, 1, 16, "insets {\"around\": point, \"zoom\": 4}")) insets.push_back(read_inset(inset, values));
    return insets;
}

}  // namespace

CameraSettings read_camera(const Json& j, const SceneValues& values) {
    must_be_object(j, "a camera {\"eye\": ..., \"target\": ...}");
    j.allow_keys({"eye", "target", "up", "fov", "orthographic", "fit"});
    CameraSettings camera;
    if (const auto eye = j.find("eye")) camera.eye = values.point(*eye);
    if (const auto target = j.find("target")) camera.target = values.point(*target);
    const auto up = j.find("up"), fov = j.find("fov"), orthographic = j.find("orthographic");
    if (up) camera.up = values.point(*up);
    if (up && !(length(*camera.up) > 0)) up->expected("a direction that is not zero");
    if (fov && orthographic) fov->fail_at_key("found both \"fov\" and \"orthographic\", expected one of them");
    if (fov) camera.fov = values.number(*fov, "an angle in degrees");
    if (!(camera.fov > 0.01 && camera.fov < 179)) fov->fail("found " + to_text(camera.fov) + ", expected an angle from 0.01 to 179 degrees");
    if (orthographic) {
        if (orthographic->is(Kind::boolean)) {
            if (orthographic->boolean()) camera.orthographic = 0;
        } else {
            camera.orthographic = values.positive(*orthographic, "the height of the view in scene units, or true");
        }
    }
    if (const auto fit = j.find("fit")) camera.fit = values.boolean(*fit);
    if (camera.eye && camera.target) {
        const Point view = *camera.target - *camera.eye;
        if (!(length(view) > 0)) j.find("eye")->fail("found the eye at the target, expected different points");
        if (camera.up && !(length(cross(view, *camera.up)) > 1e-12 * length(view) * length(*camera.up))) {
            up->fail("found an up direction along the view, expected another one");
        }
    }
    return camera;
}

void read_panels(const Json& root, SceneBuilder& builder, Scene& scene) {
    const SceneValues& values = builder.values();
    const auto panels = root.find("panels"), layout = root.find("layout"), objects = root.find("objects");
    const auto marks = root.find("marks"), insets = root.find("insets");
    if (insets && panels) insets->fail_at_key("found both \"insets\" and \"panels\", expected the insets in the panels");
    if (insets) scene.insets = read_insets(*insets, values);
    if (marks && !panels) marks->fail_at_key("found \"marks\" without \"panels\", expected panels to mark");
    if (layout && !panels) layout->fail_at_key("found \"layout\" without \"panels\", expected panels to lay out");
    if (!panels) return;
    if (objects) panels->fail_at_key("found both \"objects\" and \"panels\", expected the objects in the panels");
    scene.place = panels->place();
    for (const Json& j : values.list(*panels, 1, 64, "panels {\"objects\": [...]}")) {
        must_be_object(j, "a panel {\"objects\": [...], \"title\": ...}");
        j.allow_keys({"objects", "title", "mark", "camera", "insets"});
        Panel panel;
        panel.first = scene.objects.size();
        for (const Json& o : values.list(j.at("objects", "the objects that the panel draws"), 1, 0, "objects to draw")) scene.objects.push_back(read_object(o, builder));
        panel.last = scene.objects.size();
        if (const auto title = j.find("title")) panel.title = read_math_text(*title, values, true);
        if (const auto camera = j.find("camera")) panel.camera = read_camera(*camera, values);
        if (const auto mark = j.find("mark")) panel.mark = read_math_text(*mark, values, true);
        if (const auto own = j.find("insets")) panel.insets = read_insets(*own, values);
        scene.panels.push_back(std::move(panel));
    }
    const int count = static_cast<int>(scene.panels.size());
    scene.panel_columns = count <= 3 ? count : static_cast<int>(std::ceil(std::sqrt(count)));
    scene.panel_rows = (count + scene.panel_columns - 1) / scene.panel_columns;
    if (layout) read_layout(*layout, values, scene);
    read_marks(marks.get(), *panels, values, scene);
}

}  // namespace isoparm
