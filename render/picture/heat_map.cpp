#include "picture/heat_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "drawing/paint.h"
#include "drawing/plot.h"
#include "drawing/text_cairo.h"
#include "light/sampler.h"
#include "picture/camera.h"
#include "picture/color_map.h"
#include "rays/embree_scene.h"

namespace isoparm {
namespace {

constexpr double kDecades = 2;
constexpr int kSamples = 16;
constexpr double kDark = 0.62;           // of a triangle seen from the side
constexpr double kThin = 5, kWide = 12;  // height of a triangle in pixels, without edges and with all of their ink

/// 0 for a hundredth of the top and less, 1 at the top.
double place(double value, double top) { return value > 0 ? std::clamp(1 + std::log10(value / top) / kDecades, 0.0, 1.0) : 0; }

class Painter {
public:
    Painter(const HeatMap& map, const Camera& camera, const Point& centre) : map_(map), camera_(camera), embree_(centre) {
        embree_.add_mesh(map.mesh, 1);
        embree_.commit();
    }

    Color pixel(int x, int y) const {
        const PixelSampler sampler(x, y, kSamples);
        Ray rays[kSamples];
        Hit hits[kSamples];
        for (int i = 0; i < kSamples; ++i) {
            const Vec2 at = filter_(sampler(i, 0));
            rays[i] = camera_.ray(x + 0.5 + at.x, y + 0.5 + at.y);
        }
        embree_.intersect(rays, kSamples, hits);
        Color sum;
        for (int i = 0; i < kSamples; ++i) sum += hits[i].found() ? color(rays[i], hits[i]) : Color{1, 1, 1};
        return sum / double(kSamples);
    }

private:
    Color color(const Ray& ray, const Hit& hit) const {
        const double cosine = std::fabs(dot(normalized(hit.normal), ray.direction));
        const Color c = (kDark + (1 - kDark) * cosine) * viridis(place(map_.values[hit.geometry][hit.primitive], map_.top));
        return (1 - 0.75 * edge(hit)) * c;
    }
    /// How much ink of an edge is there, by the distance in pixels.
    double edge(const Hit& hit) const {
        const MeshPart& part = map_.mesh.parts[hit.geometry];
        Vec2 p[3];
        for (int k = 0; k < 3; ++k) p[k] = camera_.project(map_.mesh.positions[part.vertex[part.triangles[hit.primitive][k]]]);
        const double area = std::fabs((p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y));
        const double weight[3] = {hit.v, 1 - hit.u - hit.v, hit.u};  // of the corner opposite to edge k
        double ink = 0;
        for (int k = 0; k < 3; ++k) {
            const double height = area / std::hypot(p[(k + 1) % 3].x - p[k].x, p[(k + 1) % 3].y - p[k].y);
            if (weight[k] * height < 0.4) ink = std::max(ink, std::clamp((height - kThin) / (kWide - kThin), 0.0, 1.0));
        }
        return ink;
    }

    const HeatMap& map_;
    const Camera& camera_;
    EmbreeScene embree_;
    PixelFilter filter_;
};

struct Layout {
    int width, height, top, right;
    double letter;
};

Drawing legend(const HeatMap& map, const Layout& l) {
    Drawing drawing;
    const Color ink = ink_color();
    const MathText title = parse_math_text(map.title, true);
    drawing.push_back({Text{{0.5 * (l.width - text_box(title, 1.15 * l.letter).advance), 0.7 * l.top}, 1.15 * l.letter, title}, ink});
    const double x = l.width - l.right + 1.0 * l.letter, w = 1.4 * l.letter, y0 = l.top + 0.06 * l.height, y1 = 0.94 * l.height;
    constexpr int steps = 200;
    for (int i = 0; i < steps; ++i) {
        const double a = y1 + (y0 - y1) * i / steps, b = y1 + (y0 - y1) * std::min(i + 1.3, double(steps)) / steps;
        drawing.push_back({Filled{{{x, a}, {x + w, a}, {x + w, b}, {x, b}}}, viridis((i + 0.5) / steps)});
    }
    drawing.push_back({Polyline{{{x, y0}, {x + w, y0}, {x + w, y1}, {x, y1}, {x, y0}}, 1, {}, true}, ink});
    for (const double part : {1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01}) {
        const double y = y1 + (y0 - y1) * place(part, 1);
        drawing.push_back({Polyline{{{x + w, y}, {x + w + 0.35 * l.letter, y}}, 1, {}, false}, ink});
        drawing.push_back({Text{{x + w + 0.6 * l.letter, y + 0.32 * l.letter}, l.letter, number_text(part, 2)}, ink});
    }
    Text bar{{0, 0}, l.letter, parse_math_text(map.bar, true)};
    bar.turned = true;
    bar.at = {l.width - 0.6 * l.letter, 0.5 * (y0 + y1 + text_box(bar.text, l.letter).advance)};
    drawing.push_back({bar, ink});
    return drawing;
}

}  // namespace

Image draw_heat_map(const HeatMap& map, const CameraSettings& settings, int width, int height) {
    Layout l{width, height, 0, 0, std::max(9.0, height / 32.0)};
    l.top = int(2.4 * l.letter), l.right = int(6.6 * l.letter);
    CameraSettings fitted = settings;
    fitted.fit = true;
    Point low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
    for (const Point& p : map.mesh.positions)
        for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
    const Camera camera = make_camera(fitted, map.mesh.positions, width - l.right, height - l.top);
    const Painter painter(map, camera, 0.5 * (low + high));
    Image image{width, height, std::vector<float>(4 * std::size_t(width) * std::size_t(height), 1.0f)};
    tbb::parallel_for(0, camera.height, [&](int y) {
        for (int x = 0; x < camera.width; ++x) {
            const Color c = painter.pixel(x, y);
            for (int k = 0; k < 3; ++k) image.at(x, y + l.top)[k] = float(c[k]);
        }
    });
    paint(legend(map, l), image.width, image.height, 0, 0, image);
    return image;
}

}  // namespace isoparm
