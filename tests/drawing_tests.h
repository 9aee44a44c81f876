// drawing_tests.h -- small scenes seen from above, shared by the tests of what is drawn over the traced picture. Header only, test code.
#pragma once
#include <gtest/gtest.h>

#include <cmath>

#include "curves/bezier.h"
#include "drawing/math_text.h"
#include "patches/tensor_bezier.h"
#include "picture/picture.h"
#include "run_program.h"
#include "scene/scene.h"

namespace isoparm::test {

using Kind = SceneObject::Kind;

inline Scene scene_from(const std::string& text) {
    const TemporaryFolder t;
    write_all(t / "scene.json", text);
    return load_scene(t / "scene.json");
}
/// Seen from above, `height` scene units high, transparent, one pixel to a pixel.
inline Scene from_above(double height, int width, int pixels, int samples) {
    Scene scene;
    scene.camera.eye = Point{0, 0, 10};
    scene.camera.target = Point{0, 0, 0};
    scene.camera.up = Point{0, 1, 0};
    scene.camera.orthographic = height;
    scene.image.width = width;
    scene.image.height = pixels;
    scene.image.samples = samples;
    return scene;
}
inline SceneObject& add(Scene& scene, Kind kind) {
    SceneObject& o = scene.objects.emplace_back();
    o.kind = kind;
    return o;
}
inline SceneObject& add_sheet(Scene& scene, double z, double opacity) {
    const std::string name = "sheet" + std::to_string(scene.surfaces.size());
    Surface& s = scene.surfaces.emplace_back();
    s.name = name;
    s.patches = {{name, make_bezier_patch({{{-1, -1, z}, {-1, 1, z}}, {{1, -1, z}, {1, 1, z}}})}};
    SceneObject& o = add(scene, Kind::surface);
    o.name = name;
    o.opacity = opacity;
    return o;
}
inline SceneObject& add_line(Scene& scene, const Point& a, const Point& b, double width) {
    const std::string name = "line" + std::to_string(scene.curves.size());
    scene.curves.push_back({name, make_bezier({a, b})});
    SceneObject& o = add(scene, Kind::curve);
    o.name = name;
    o.line.width = width;
    o.color = Color{1, 0, 0};
    return o;
}
inline double sum(const Image& image, int channel, int x0 = 0, int x1 = 1 << 20) {
    double all = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = x0; x < std::min(x1, image.width); ++x) all += image.at(x, y)[channel];
    return all;
}
inline std::string plain(const MathText& text) {
    std::string all;
    for (const TextRun& r : text) all += r.text;
    return all;
}

}  // namespace isoparm::test
