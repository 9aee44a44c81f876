#include "picture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "camera.h"
#include "error.h"
#include "insets.h"
#include "layout.h"
#include "overlay.h"
#include "paint.h"
#include "path_lighting.h"
#include "sampler.h"
#include "shade.h"
#include "surfel.h"
#include "traced_scene.h"

namespace isoparm {
namespace {

constexpr int kTile = 16;           // pixels a side
constexpr double kMeshShare = 0.2;  // of the progress bar
constexpr int kMostSamples = 1 << 16;

struct Rgba {
    Color color;  // premultiplied
    double alpha = 0;
    /// What lies behind, seen through what is here.
    void add_behind(const Color& c, double opacity) {
        color += ((1 - alpha) * opacity) * c;
        alpha += (1 - alpha) * opacity;
    }
};

/// Variance of colours, about the first of them, so that equal ones have none.
class Spread {
public:
    void add(const Color& c) {
        if (n_++ == 0) first_ = c;
        const Color d = c - first_;
        sum_ += d;
        squares_ += Color{d.x * d.x, d.y * d.y, d.z * d.z};
    }
    Color variance() const {
        const auto one = [&](double sum, double squares) { return n_ < 2 ? 0 : std::max(0.0, (squares - sum * sum / n_) / (n_ - 1)); };
        return {one(sum_.x, squares_.x), one(sum_.y, squares_.y), one(sum_.z, squares_.z)};
    }

private:
    Color first_, sum_, squares_;
    int n_ = 0;
};

/// What the samples of a pixel come to.
struct Samples {
    Rgba sum;
    Spread spread;
};

class Tracer {
public:
    Tracer(const TracedScene& scene, const Camera& camera, const Lighting& lighting, int samples, const std::optional<Color>& background)
        : scene_(scene), camera_(camera), lighting_(lighting), samples_(samples), background_(background) {}

    /// The mean of the samples, and the variance of each.
    Samples pixel(int x, int y) const {
        const PixelSampler sampler(x, y, samples_);
        Samples all;
        for (int first = 0; first < samples_; first += EmbreeScene::packet) {
            Ray rays[EmbreeScene::packet];
            const int n = std::min(EmbreeScene::packet, samples_ - first);
            for (int i = 0; i < n; ++i) {
                const Vec2 at = filter_(sampler(first + i, 0));
                rays[i] = camera_.ray(x + 0.5 + at.x, y + 0.5 + at.y);
            }
            if (scene_.embree->translucent())
                add_layers(sampler, rays, first, n, all);
            else
                add_nearest(sampler, rays, first, n, all);
        }
        all.sum = {all.sum.color / double(samples_), all.sum.alpha / samples_};
        if (background_) all.sum.add_behind(*background_, 1);
        return all;
    }

private:
    /// What a ray of the pixel met, and as which of its layers.
    struct Met {
        Hit hit;
        int ray, layer;
    };
    void add_nearest(const PixelSampler& sampler, const Ray* rays, int first, int n, Samples& all) const {
        Hit hits[EmbreeScene::packet];
        scene_.embree->intersect(rays, n, hits);
        std::vector<Met> met;
        for (int i = 0; i < n; ++i)
            if (hits[i].found()) met.push_back({hits[i], i, 0});
        add_light(sampler, rays, first, n, met, all);
    }
    void add_layers(const PixelSampler& sampler, const Ray* rays, int first, int n, Samples& all) const {
        std::vector<Hit> hits;
        std::vector<Met> met;
        for (int i = 0; i < n; ++i) {
            scene_.embree->layers(rays[i], hits);
            for (std::size_t k = 0; k < hits.size(); ++k) met.push_back({hits[k], i, static_cast<int>(k)});
        }
        add_light(sampler, rays, first, n, met, all);
    }
    /// Layers of a ray come from front to back.
    void add_light(const PixelSampler& sampler, const Ray* rays, int first, int n, const std::vector<Met>& met, Samples& all) const {
        Rgba seen[EmbreeScene::packet];
        for (std::size_t begin = 0; begin < met.size(); begin += EmbreeScene::packet) {
            const int count = static_cast<int>(std::min<std::size_t>(EmbreeScene::packet, met.size() - begin));
            Ray by[EmbreeScene::packet];
            Hit hits[EmbreeScene::packet];
            for (int k = 0; k < count; ++k) by[k] = rays[met[begin + k].ray], hits[k] = met[begin + k].hit;
            Surfel surfels[EmbreeScene::packet];
            surfels_at(scene_, camera_, by, hits, count, surfels);
            for (int k = 0; k < count; ++k) {
                surfels[k].sample = first + met[begin + k].ray;
                surfels[k].dimension = 1 + lighting_.dimensions() * met[begin + k].layer;
            }
            Color light[EmbreeScene::packet];
            lighting_.shade(scene_, sampler, surfels, count, light);
            for (int k = 0; k < count; ++k) add(surfels[k], light[k], seen[met[begin + k].ray]);
        }
        for (int i = 0; i < n; ++i) {
            all.sum.color += seen[i].color;
            all.sum.alpha += seen[i].alpha;
            if (background_) seen[i].add_behind(*background_, 1);
            all.spread.add(seen[i].color);
        }
    }

    static void add(const Surfel& s, const Color& light, Rgba& seen) {
        if (s.ink_cover > 0) seen.add_behind(s.ink, s.ink_cover);
        seen.add_behind(light, s.opacity);
    }

    const TracedScene& scene_;
    const Camera& camera_;
    const Lighting& lighting_;
    PixelFilter filter_;
    int samples_;
    std::optional<Color> background_;
};

struct Area {
    int x0, y0, x1, y1;
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
};

/// Rays against folds and places without area halve boxes again and again: minutes for what others do in a second. Throws Error(budget).
void check_work(const TracedScene& traced, double most, double done) {
    constexpr double kMostEach = 20;  // scenes without such places are below 1
    double halved = 0;
    for (const ExactPatch& p : traced.patches) halved += static_cast<double>(p.halved());
    if (const auto rays = static_cast<double>(traced.embree->count().rays); halved > std::max(most, kMostEach * rays))
        throw Error(ErrorKind::budget, "--exact was given up after " + to_text(std::floor(100 * done)) + " % of the picture: a ray looks at " + to_text(std::round(halved / std::max(1.0, rays))) +
                                           " pieces of the surfaces, as where they are folded or have no area; render without --exact, or a smaller picture with fewer samples");
}

/// Calls `progress` from the calling thread only, which works on tiles like the others.
void trace(const TracedScene& traced, double most_halved, const Tracer& tracer, const AovReader& aovs, const Area& area, const std::function<void(double)>& progress,
           Picture& picture) {
    const int across = (area.width() + kTile - 1) / kTile, tiles = across * ((area.height() + kTile - 1) / kTile);
    const auto caller = std::this_thread::get_id();
    std::atomic<int> done{0};
    tbb::parallel_for(0, tiles, [&](int tile) {
        const int x0 = area.x0 + kTile * (tile % across), y0 = area.y0 + kTile * (tile / across);
        for (int y = y0; y < std::min(y0 + kTile, area.y1); ++y)
            for (int x = x0; x < std::min(x0 + kTile, area.x1); ++x) {
                const Samples p = tracer.pixel(x, y);
                float* out = picture.image.at(x - area.x0, y - area.y0);
                for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(p.sum.color[k]);
                out[3] = static_cast<float>(p.sum.alpha);
                const std::size_t pixel = static_cast<std::size_t>(y - area.y0) * area.width() + (x - area.x0);
                if (aovs.channels() > 0) aovs.read(x, y, p.spread.variance(), &picture.layers.values[pixel * aovs.channels()]);
            }
        const int now = ++done;
        check_work(traced, most_halved, static_cast<double>(now) / tiles);
        if (progress && std::this_thread::get_id() == caller) progress(static_cast<double>(now) / tiles);
    });
}

Area checked_area(const RenderOptions& options, int width, int height) {
    if (!options.crop) return {0, 0, width, height};
    const auto& c = *options.crop;
    const Area a{c[0], c[1], c[2], c[3]};
    if (a.x0 < 0 || a.y0 < 0 || a.x1 > width || a.y1 > height || a.x0 >= a.x1 || a.y0 >= a.y1)
        throw Error(ErrorKind::usage,
                    "the crop " + std::to_string(a.x0) + "," + std::to_string(a.y0) + "," + std::to_string(a.x1) + "," +
                        std::to_string(a.y1) + " is no part of a picture of " + std::to_string(width) + "x" +
                        std::to_string(height) +
                        " pixels: expected x0,y0,x1,y1 with 0 <= x0 < x1 <= width and 0 <= y0 < y1 <= height");
    return a;
}

double in_scene_units(const Tolerance& t, const Camera& camera, const Bounds& box) {
    const double size =
        box.diagonal() > 0 ? box.diagonal() : 1;  // a single ball: nothing to tessellate, but tubes to round
    const double absolute = t.unit == Tolerance::Unit::absolute   ? t.value
                            : t.unit == Tolerance::Unit::relative ? t.value * size
                                                                  : t.value * finest_pixel(camera, box);
    if (!(absolute > 0) || !std::isfinite(absolute))
        throw_input("the tolerance comes to " + to_text(absolute) + " scene units, expected more than 0");
    return absolute;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::unique_ptr<const Lighting> lighting_of(const Scene& scene, const Camera& camera) {
    if (scene.lighting) return std::make_unique<PathLighting>(*scene.lighting, camera);
    return std::make_unique<FigureLighting>(camera);
}

/// All pixels as where nothing is.
Layers blank_layers(int width, int height, const std::vector<Aov>& aovs) {
    Layers layers{channels_of(aovs), {}};
    const auto pixel = empty_pixel(aovs);
    for (std::size_t i = 0; i < static_cast<std::size_t>(width) * height; ++i) layers.values.insert(layers.values.end(), pixel.begin(), pixel.end());
    return layers;
}

Image blank(int width, int height, const std::optional<Color>& background) {
    Image image{width, height, {}};
    image.pixels.resize(4 * static_cast<std::size_t>(width) * height);
    if (background)
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            image.pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>((*background)[static_cast<int>(i % 4)]);
    return image;
}

struct Quality {
    int samples;
    Tolerance tolerance;
    double pixel;  // pixels of this picture to one of the scene's
    std::vector<Aov> aovs;
    bool exact, vectors;
    double most_halved;
    int grid;
};

/// Puts a drawing over a picture; (x,y) is where its pixels begin there.
void put_over(Drawing drawing, int x, int y, int width, int height, bool vectors, Picture& picture) {
    if (vectors)
        picture.drawn.push_back({std::move(drawing), x, y, width, height});
    else
        paint(drawing, -x, -y, picture.image);
}

/// Does anything mirror or bend what is seen? Then parameter lines are traced, so that they are seen in it too.
bool mirrors(const Scene& scene, const std::vector<SceneObject>& objects) {
    return scene.lighting && std::any_of(objects.begin(), objects.end(), [](const SceneObject& o) { return o.material.kind == Material::Kind::metal || o.material.kind == Material::Kind::glass; });
}

/// The part `area` of a view, in the view's own pixels.
Picture render_view(const Scene& scene, const View& view, const Area& area, const Quality& how,
                    const std::function<void(double)>& progress) {
    const auto part_of_progress = [&](double from, double share) -> std::function<void(double)> {
        if (!progress) return {};
        return [&progress, from, share](double fraction) { progress(from + share * fraction); };
    };
    const Camera camera = camera_of(view);
    Picture picture;
    picture.tolerance = in_scene_units(how.tolerance, camera, bounding_box(scene));
    auto start = std::chrono::steady_clock::now();
    TracedScene traced = build_traced_scene(scene, view.objects, picture.tolerance, part_of_progress(0, kMeshShare), how.exact, how.grid);
    const bool lines = how.vectors && !mirrors(scene, view.objects);
    for (Thing& thing : traced.things) thing.isolines.width = lines ? 0 : thing.isolines.width * how.pixel;
    picture.certified_error = traced.certified_error;
    picture.triangles = traced.triangles;
    for (const ExactPatch& p : traced.patches) picture.leaves += p.leaves();
    picture.seconds_mesh = seconds_since(start);

    start = std::chrono::steady_clock::now();
    picture.image = blank(area.width(), area.height(), {});
    picture.layers = blank_layers(area.width(), area.height(), how.aovs);
    const std::unique_ptr<const Lighting> lighting = lighting_of(scene, camera);
    trace(traced, how.most_halved, Tracer(traced, camera, *lighting, how.samples, scene.image.background), AovReader(scene, traced, camera, how.aovs), area,
          part_of_progress(kMeshShare, 1 - kMeshShare), picture);
    picture.rays = traced.embree->count();
    put_over(overlay(scene, view.objects, traced, camera, how.pixel, view.letter, lines, {view.inset.has_value(), view.covered}), -area.x0, -area.y0, view.width, view.height, how.vectors, picture);
    picture.seconds_trace = seconds_since(start);
    return picture;
}

Area common(const Area& a, const Area& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

void paste(const Image& part, int x0, int y0, Image& whole) {
    for (int y = 0; y < part.height; ++y)
        std::copy_n(part.at(0, y), 4 * static_cast<std::size_t>(part.width), whole.at(x0, y0 + y));
}
void paste(const Picture& part, int x0, int y0, Picture& whole) {
    paste(part.image, x0, y0, whole.image);
    const std::size_t channels = part.layers.channels.size(), row = channels * part.image.width;
    for (int y = 0; y < part.image.height; ++y)
        std::copy_n(part.layers.values.data() + y * row, row,
                    whole.layers.values.data() + channels * (static_cast<std::size_t>(y0 + y) * whole.image.width + x0));
}

}  // namespace

Picture render(const Scene& scene, const RenderOptions& options) {
    const Layout layout = layout_of(scene, options);
    const int width = layout.width, height = layout.height;
    const std::vector<View>& views = layout.views;
    const Area area = checked_area(options, width, height);
    const Quality how{checked_size(options.samples ? options.samples : scene.image.samples, "number of samples", kMostSamples), options.tolerance.value_or(scene.tolerance), layout.pixel,
                      options.aovs, options.exact, options.vectors, options.most_halved, options.grid};
    double reached = 0;  // progress never runs backwards, whatever its parts report
    Picture all;
    all.exact = options.exact;
    all.image = blank(area.width(), area.height(), scene.image.background);
    all.layers = blank_layers(area.width(), area.height(), options.aovs);
    for (std::size_t i = 0; i < views.size(); ++i) {
        const View& v = views[i];
        const Area seen = common(area, {v.x, v.y, v.x + v.width, v.y + v.height});
        if (seen.width() <= 0 || seen.height() <= 0) continue;
        std::function<void(double)> progress;
        if (options.progress)
            progress = [&, i](double fraction) {
                options.progress(reached = std::max(
                                     reached, (static_cast<double>(i) + fraction) / static_cast<double>(views.size())));
            };
        const Picture one =
            render_view(scene, v, {seen.x0 - v.x, seen.y0 - v.y, seen.x1 - v.x, seen.y1 - v.y}, how, progress);
        paste(one, seen.x0 - area.x0, seen.y0 - area.y0, all);
        for (DrawnPart part : one.drawn) {
            part.x += seen.x0 - area.x0, part.y += seen.y0 - area.y0;
            part.holes = v.covered;
            all.drawn.push_back(std::move(part));
        }
        all.tolerance = std::max(all.tolerance, one.tolerance);
        all.certified_error = std::max(all.certified_error, one.certified_error);
        all.triangles += one.triangles;
        all.leaves += one.leaves;
        all.rays.rays += one.rays.rays;
        all.rays.undecided += one.rays.undecided;
        all.seconds_mesh += one.seconds_mesh;
        all.seconds_trace += one.seconds_trace;
    }
    put_over(frames_of(views, layout.pixel), -area.x0, -area.y0, width, height, options.vectors, all);
    put_over(titles_of(scene, views), -area.x0, -area.y0, width, height, options.vectors, all);
    return all;
}

}  // namespace isoparm
