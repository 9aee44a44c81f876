#include "commands/limit_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diff/diff.h"
#include "picture/palette.h"
#include "picture/picture.h"
#include "subdivision/limit_composite.h"

namespace isoparm {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kTriangles = 5e5;  // of each surface, about
constexpr int kChannels = 4;  // of the layers: a normal, and the depth

/// Two panels with one camera, which has both surfaces in the picture.
Scene scene_of(LimitComposite&& surfaces) {
    Scene scene;
    scene.surfaces.push_back({"limit", "subdivision", std::move(surfaces.limit), "", {}});
    scene.surfaces.push_back({"composite", "composite", std::move(surfaces.composite), "", {}});
    for (const Surface& s : scene.surfaces) {
        SceneObject o;
        o.name = s.name, o.color = surface_color(1);
        scene.objects.push_back(o);
    }
    scene.panels.resize(2);
    for (std::size_t i = 0; i < 2; ++i) scene.panels[i].first = i, scene.panels[i].last = i + 1;
    scene.panel_columns = 2;
    scene.camera.fit = true;
    scene.image.samples = 16, scene.image.background = Color{1, 1, 1};
    return scene;
}

/// The left or the right half of a picture.
Image half_of(const Image& image, int first) {
    Image r{image.width / 2, image.height, {}};
    for (int y = 0; y < r.height; ++y) r.pixels.insert(r.pixels.end(), image.at(first, y), image.at(first, y) + 4 * std::size_t(r.width));
    return r;
}

void compare_colors(LimitView& v) {
    ImagePart part;
    part.data = part.display = {0, 0, v.width, v.height};
    part.channels = {"R", "G", "B", "A"}, part.types.assign(4, "float");
    const DiffLimits limits;
    const DiffMask mask;
    DiffMeter meter(part, part, limits, mask);
    const auto &a = v.pictures.limit.pixels, &b = v.pictures.composite.pixels;
    meter.add(a.data(), b.data(), v.height);
    const PartDiff diff = meter.result();
    double squares = 0;
    for (int k = 0; k < 3; ++k) v.color_max = std::max(v.color_max, diff.channels[k].max), squares += diff.channels[k].squares;
    v.color_rms = std::sqrt(squares / (3.0 * v.width * v.height));
    for (std::size_t i = 0; i < a.size(); i += 4) v.pictures.color.push_back(std::max({std::fabs(a[i] - b[i]), std::fabs(a[i + 1] - b[i + 1]), std::fabs(a[i + 2] - b[i + 2])}));
}


void compare_normals(const Layers& layers, LimitView& v) {
    double sum = 0;
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x) {
            const float* a = &layers.values[kChannels * (std::size_t(y) * 2 * v.width + x)];
            const float* b = a + kChannels * std::size_t(v.width);
            const int inside = (a[3] < kAovFar ? 1 : 0) + (b[3] < kAovFar ? 2 : 0);
            v.pictures.inside.push_back(char(inside));
            v.pictures.degrees.push_back(kNaN);
            if (inside == 1 || inside == 2) ++v.silhouette_differing;
            if (inside != 3) continue;
            const double angle = degrees_between({a[0], a[1], a[2]}, {b[0], b[1], b[2]});
            ++v.both, sum += angle;
            v.normal_max_degrees = std::max(v.normal_max_degrees, angle);
            v.pictures.degrees.back() = float(angle);
        }
    if (v.both > 0) v.normal_mean_degrees = sum / v.both;
}

/// Of pixels that only `mine` covers (1: the limit, 2: the composite) from the nearest that the other one does.
double farthest(const LimitView& v, int mine) {
    const auto& inside = v.pictures.inside;
    const auto at = [&](int x, int y) { return inside[std::size_t(y) * v.width + x]; };
    std::vector<double> up(inside.size(), HUGE_VAL);  // to the nearest pixel of the other one in the same column
    for (int x = 0; x < v.width; ++x)
        for (const bool down : {false, true}) {
            double d = HUGE_VAL;
            for (int k = 0; k < v.height; ++k) {
                const int y = down ? v.height - 1 - k : k;
                d = at(x, y) & (3 - mine) ? 0 : d + 1;
                double& least = up[std::size_t(y) * v.width + x];
                least = std::min(least, d);
            }
        }
    double most = 0;
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x) {
            if (at(x, y) != mine) continue;
            double least = HUGE_VAL;
            for (int k = 0; k < v.width; ++k) least = std::min(least, std::hypot(double(k - x), up[std::size_t(y) * v.width + k]));
            most = std::max(most, least);
        }
    return most;
}

}  // namespace

std::optional<LimitView> view_limit(const LimitSurface& limit, const LimitFaces& faces, int width, int height) {
    LimitComposite surfaces = make_limit_composite(limit, faces);
    if (surfaces.limit.empty()) return {};
    LimitView v;
    v.width = width, v.height = height, v.patches = int(surfaces.limit.size()), v.left_out = surfaces.left_out;
    const Scene scene = scene_of(std::move(surfaces));
    RenderOptions how;
    // A grid finer than pixels: certificates of patches with rational twists would take minutes, and a picture shows no more.
    how.grid = std::clamp(static_cast<int>(std::sqrt(kTriangles / (2.0 * v.patches))), 4, 48);
    how.width = 2 * width, how.height = height, how.aovs = {Aov::n, Aov::z};
    const Picture picture = render(scene, how);
    v.pictures.limit = half_of(picture.image, 0), v.pictures.composite = half_of(picture.image, width);
    compare_colors(v);
    compare_normals(picture.layers, v);
    if (v.both + v.silhouette_differing == 0) return {};  // so small (some 1e-20) that single precision, in which rays meet triangles, sees nothing
    v.silhouette_distance = std::max(farthest(v, 1), farthest(v, 2));
    return v;
}

}  // namespace isoparm
