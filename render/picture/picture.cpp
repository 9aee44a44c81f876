#include "picture/picture.h"

#include <algorithm>
#include <chrono>

#include "drawing/insets.h"
#include "error.h"
#include "picture/checkpoint.h"
#include "picture/layout.h"
#include "picture/picture_pieces.h"
#include "picture/view_rendering.h"

namespace isoparm {
namespace {

constexpr double kMeshShare = 0.2;  // of the progress bar
constexpr int kMostSamples = 1 << 16;

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

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Rays against folds and places without area halve boxes again and again: minutes for what others do in a second. Throws Error(budget).
void check_work(const TracedScene& traced, double most, double done) {
    constexpr double kMostEach = 20;  // scenes without such places are below 1
    double halved = 0;
    for (const ExactPatch& p : traced.patches) halved += static_cast<double>(p.halved());
    if (const auto rays = static_cast<double>(traced.embree->count().rays); halved > std::max(most, kMostEach * rays))
        throw Error(ErrorKind::budget, "--exact was given up after " + to_text(std::floor(100 * done)) + " % of the picture: a ray looks at " + to_text(std::round(halved / std::max(1.0, rays))) +
                                           " pieces of the surfaces, as where they are folded or have no area; render without --exact, or a smaller picture with fewer samples");
}

/// A picture of one or several views, all of which come to be together, round by round.
class Rendering {
public:
    Rendering(const Scene& scene, const RenderOptions& options) : scene_(scene), options_(options), layout_(layout_of(scene, options)), area_(checked_area(options, layout_.width, layout_.height)) {
        const double noise = options.noise.value_or(scene.image.noise);
        const bool statistics = noise > 0 || options.tell_noise || !options.checkpoint.path.empty() || uses_statistics(options.aovs);
        how_ = {checked_size(options.most_samples(scene.image), "number of samples", kMostSamples), noise, statistics, options.tolerance.value_or(scene.tolerance),
                layout_.pixel, options.exact, options.vectors, options.most_halved, options.grid};
        if (scene.lighting) environments_ = load_environments(scene.lighting->lights);
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t i = 0; i < layout_.views.size(); ++i) add(layout_.views[i], static_cast<double>(i));
        seconds_mesh_ = seconds_since(start);
    }

    Picture run() {
        const auto start = std::chrono::steady_clock::now();
        CheckpointTimer checkpoint(options_.checkpoint, films());
        PauseTimer preview(0, 10);
        const double before = traced();
        while (!done()) {
            if (options_.preview && preview.due()) preview.spend([&] { options_.preview(picture()); });
            if (checkpoint.due()) checkpoint.save();
            if (stopped()) break;
            tell(before, 0);
            if (const bool whole = trace([&] { return stopped() || checkpoint.due() || (options_.preview && preview.due()); }, before); !whole) continue;
            for (auto& part : parts_)
                if (!part.rendering->film().done()) part.rendering->film().next_round();
        }
        if (stopped() && !done()) checkpoint.save();
        Picture all = picture();
        all.seconds_trace = seconds_since(start);
        return all;
    }

private:
    struct Part {
        Area seen;  // in the picture
        std::unique_ptr<ViewRendering> rendering;
    };

    void add(const View& v, double before) {
        const Area seen = common(area_, {v.x, v.y, v.x + v.width, v.y + v.height});
        if (seen.width() <= 0 || seen.height() <= 0) return;
        std::function<void(double)> progress;
        if (options_.progress) progress = [&, before](double fraction) { report(kMeshShare * (before + fraction) / static_cast<double>(layout_.views.size())); };
        parts_.push_back({seen, std::make_unique<ViewRendering>(scene_, v, Area{seen.x0 - v.x, seen.y0 - v.y, seen.x1 - v.x, seen.y1 - v.y}, how_, environments_, progress)});
    }
    std::vector<Film*> films() const {
        std::vector<Film*> all;
        for (const Part& p : parts_) all.push_back(&p.rendering->film());
        return all;
    }
    bool stopped() const { return options_.stop && options_.stop(); }
    bool done() const {
        return std::all_of(parts_.begin(), parts_.end(), [](const Part& p) { return p.rendering->film().done(); });
    }
    double traced() const {
        double sum = 0;
        for (const Part& p : parts_) sum += p.rendering->film().traced();
        return sum;
    }
    /// Progress never runs backwards, whatever its parts report.
    void report(double fraction) {
        if (options_.progress) options_.progress(reached_ = std::max(reached_, std::min(fraction, 1.0)));
    }
    /// Of what was left to do when it began with `before` samples; `more` were traced since the films were asked.
    void tell(double before, double more) {
        if (!options_.progress) return;
        if (more == 0) {
            now_ = traced(), expected_ = 0;
            for (const Part& p : parts_) expected_ += p.rendering->film().expected();
            if (options_.tell_noise && now_ > 0) options_.tell_noise(noise());
        }
        report(kMeshShare + (1 - kMeshShare) * (now_ + more - before) / std::max(1.0, expected_ - before));
    }
    double noise() const {
        double sum = 0, pixels = 0;
        for (const Part& p : parts_) {
            const double one = p.rendering->film().noise(p.rendering->area()), n = static_cast<double>(p.rendering->area().pixels());
            sum += n * one * one, pixels += n;
        }
        return pixels > 0 ? std::sqrt(sum / pixels) : 0;
    }
    /// False: it paused.
    bool trace(const std::function<bool()>& pause, double before) {
        double others = 0;
        for (const Part& p : parts_) {
            if (p.rendering->film().done()) continue;
            double here = 0;
            const auto progress = [&](double n) {
                check_work(p.rendering->traced(), how_.most_halved, (now_ + others + n) / std::max(1.0, expected_));
                tell(before, others + (here = n));
            };
            Film& film = p.rendering->film();
            const auto first = p.rendering->traced().embree->count();
            const bool whole = trace_round(p.rendering->tracer(), film, options_.tile, pause, progress);
            const auto last = p.rendering->traced().embree->count();
            film.rays.rays += last.rays - first.rays, film.rays.undecided += last.undecided - first.undecided;
            if (!whole) return false;
            others += here;
        }
        return true;
    }

    Picture picture() const {
        Picture all;
        all.exact = options_.exact;
        all.image = blank(area_.width(), area_.height(), scene_.image.background);
        all.layers = blank_layers(area_.width(), area_.height(), options_.aovs);
        all.seconds_mesh = seconds_mesh_;
        double missed = 0, pixels = 0;
        for (const Part& part : parts_) {
            const Picture one = part.rendering->picture(options_.aovs);
            paste(one, part.seen.x0 - area_.x0, part.seen.y0 - area_.y0, all);
            for (DrawnPart d : one.drawn) {
                d.x += part.seen.x0 - area_.x0, d.y += part.seen.y0 - area_.y0;
                d.holes = part.rendering->view().covered;
                all.drawn.push_back(std::move(d));
            }
            all.tolerance = std::max(all.tolerance, one.tolerance);
            all.certified_error = std::max(all.certified_error, one.certified_error);
            all.triangles += one.triangles;
            all.leaves += one.leaves;
            all.rays.rays += one.rays.rays;
            all.rays.undecided += one.rays.undecided;
            const Film& film = part.rendering->film();
            missed += film.missed() * static_cast<double>(part.seen.pixels()), pixels += static_cast<double>(part.seen.pixels());
            count_samples(film, part.rendering->area(), all.samples);
        }
        all.samples.most_asked = how_.samples;
        all.samples.target = how_.noise;
        all.samples.missed = pixels > 0 ? missed / pixels : 0;
        all.samples.noise = how_.statistics ? noise() : 0;
        all.whole = done();
        put_over(frames_of(layout_.views, layout_.pixel), -area_.x0, -area_.y0, layout_.width, layout_.height, options_.vectors, scene_.image.background, all);
        put_over(titles_of(scene_, layout_.views), -area_.x0, -area_.y0, layout_.width, layout_.height, options_.vectors, scene_.image.background, all);
        return all;
    }

    const Scene& scene_;
    const RenderOptions& options_;
    Layout layout_;
    Area area_;
    Quality how_{};
    EnvironmentImages environments_;
    std::vector<Part> parts_;
    double reached_ = 0, now_ = 0, expected_ = 0, seconds_mesh_ = 0;
};

}  // namespace

Picture render(const Scene& scene, const RenderOptions& options) { return Rendering(scene, options).run(); }

}  // namespace isoparm
