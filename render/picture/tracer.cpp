#include "picture/tracer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <limits>
#include <thread>

namespace isoparm {

void Tracer::sample(int x, int y, int to, bool counts, const FilmPixel& film, const std::function<bool()>& stop) const {
    const bool empty = !may_meet(x, y);
    PixelSum& sum = film.sum;
    if (empty && !film.spread && sum.seen < to) {  // sums stay as they are
        if (counts) sum.used += to - sum.seen;
        sum.seen = to;
    }
    const PixelSampler sampler(x, y, samples_);
    while (sum.seen < to && !(stop && stop())) {
        const int first = sum.seen, n = std::min(EmbreeScene::packet, to - first);
        Rgba seen[EmbreeScene::packet];
        if (!empty) {
            RayLanes rays;
            SampleOf of[EmbreeScene::packet];
            Vec2 pixel[EmbreeScene::packet];
            for (int i = 0; i < n; ++i) of[i] = {&sampler, first + i}, pixel[i] = {double(x), double(y)};
            this->rays(pixel, of, n, rays);
            trace(rays, of, n, seen);
        }
        add(seen, n, counts, film);
    }
}

void Tracer::rays(const Vec2* pixel, const SampleOf* of, int n, RayLanes& out) const {
    constexpr int kFirst[EmbreeScene::packet] = {};
    Vec2 at[EmbreeScene::packet];
    sample_points(of, kFirst, n, at);
    for (int i = 0; i < n; ++i) {
        const Vec2 aside = filter_(at[i]);
        at[i] = {pixel[i].x + 0.5 + aside.x, pixel[i].y + 0.5 + aside.y};
    }
    camera_rays(camera_, at, n, out);
}

Tracer::Block Tracer::block() const {
    const int pixels = EmbreeScene::packet / samples_;
    return pixels >= 16 ? Block{4, 4} : pixels >= 8 ? Block{4, 2} : pixels >= 4 ? Block{2, 2} : pixels >= 2 ? Block{2, 1} : Block{1, 1};
}

void Tracer::sample_block(int x, int y, Rgba* seen) const {
    static_assert(Coverage::block % 4 == 0);  // blocks of samples lie within those of the coverage
    if (!may_meet(x, y)) return;
    std::array<std::optional<PixelSampler>, EmbreeScene::packet> samplers;
    RayLanes rays;
    SampleOf of[EmbreeScene::packet];
    Vec2 pixel[EmbreeScene::packet];
    const Block size = block();
    int n = 0;
    for (int k = 0; k < size.width * size.height; ++k) {
        const int px = x + k % size.width, py = y + k / size.width;
        samplers[static_cast<std::size_t>(k)].emplace(px, py, samples_);
        for (int i = 0; i < samples_; ++i, ++n) of[n] = {&*samplers[static_cast<std::size_t>(k)], i}, pixel[n] = {double(px), double(py)};
    }
    this->rays(pixel, of, n, rays);
    trace(rays, of, n, seen);
}

void Tracer::add(Rgba* seen, int n, bool counts, const FilmPixel& film) const {
    PixelSum& sum = film.sum;
    for (int i = 0; i < n; ++i) {
        if (counts) sum.color += seen[i].color, sum.alpha += seen[i].alpha;
        if (counts && film.brightest && brightness(seen[i].color) > brightness(*film.brightest)) *film.brightest = seen[i].color;
        if (!film.spread) continue;
        seen[i].add_behind(background_.value_or(Color{1, 1, 1}), 1);
        film.spread->add(seen[i].color);
    }
    sum.seen += n;
    if (counts) sum.used += n;
}

Rgba Tracer::resolved(const PixelSum& sum) const {
    Rgba mean{sum.color / double(sum.used), sum.alpha / sum.used};
    return finished(mean);
}

Rgba Tracer::finished(Rgba pixel) const {
    if (background_) {
        pixel.add_behind(*background_, 1);
    } else if (ground_) {  // shadows are not quite grey: the same over white, without colours below zero
        const double lift = std::max({0.0, -pixel.alpha, -pixel.color.x, -pixel.color.y, -pixel.color.z});
        pixel.color += Color{lift, lift, lift}, pixel.alpha = std::min(1.0, pixel.alpha + lift);
    }
    return pixel;
}

Rgba Tracer::glance(double x, double y) const {
    const PixelSampler sampler(static_cast<int>(x), static_cast<int>(y), samples_);
    RayLanes rays;
    const Vec2 at{x, y};
    camera_rays(camera_, &at, 1, rays);
    const SampleOf of{&sampler, 0};
    Rgba seen;
    trace(rays, &of, 1, &seen);
    return finished(seen);
}

void Tracer::trace(const RayLanes& rays, const SampleOf* of, int n, Rgba* seen) const {
    Packet met;
    if (scene_.embree->translucent()) {
        std::vector<Hit> hits;
        for (int i = 0; i < n; ++i) {
            scene_.embree->layers(rays[i], hits);
            // What is behind a pane is seen by the light that comes through it.
            const auto last = std::find_if(hits.begin(), hits.end(), [&](const Hit& h) { return scene_.things[h.geometry].opacity == 1; });
            if (last != hits.end()) hits.erase(last + 1, hits.end());
            if (const auto ground = ground_hit(rays[i], std::numeric_limits<double>::infinity())) {
                while (!hits.empty() && hits.back().distance >= ground->distance) hits.pop_back();
                const bool open = hits.empty() || scene_.things[hits.back().geometry].opacity < 1;
                if (open) hits.push_back(*ground);
            }
            for (std::size_t k = 0; k < hits.size(); ++k) {
                met.add(rays[i], hits[k], i, static_cast<int>(k));
                if (met.count == EmbreeScene::packet) add_light(of, met, seen), met.count = 0;
            }
        }
    } else {
        HitLanes hits;
        scene_.embree->intersect(rays, n, hits);
        if (ground_) {
            for (int i = 0; i < n; ++i) {
                const Hit hit = hits[i];
                if (const auto ground = ground_hit(rays[i], hit.distance)) met.add(rays[i], *ground, i, 0);
                else if (hit.found()) met.add(rays[i], hit, i, 0);
            }
        } else {
            for (std::uint32_t m = hits.found; m; m &= m - 1) met.add(rays[std::countr_zero(m)], hits[std::countr_zero(m)], std::countr_zero(m), 0);
        }
    }
    if (met.count > 0) add_light(of, met, seen);
    for (int i = 0; i < n; ++i)
        if (const auto behind = lighting_.backdrop(rays[i].direction)) seen[i].add_behind(*behind, 1);
}

std::optional<Hit> Tracer::ground_hit(const Ray& ray, double end) const {
    if (!ground_) return {};
    Hit hit;
    hit.distance = ground_->meet(ray.origin, ray.direction);
    if (!(hit.distance >= 0 && hit.distance < end)) return {};
    return hit;
}

void Tracer::surfels(const Ray* rays, const Hit* hits, int n, Surfel* out) const {
    Ray by[EmbreeScene::packet];
    Hit found[EmbreeScene::packet];
    Surfel some[EmbreeScene::packet];
    int who[EmbreeScene::packet], count = 0;
    for (int k = 0; k < n; ++k) {
        if (hits[k].found()) who[count] = k, by[count] = rays[k], found[count++] = hits[k];
        else out[k] = ground_surfel(*ground_, rays[k], hits[k].distance, scene_);
    }
    surfels_at(scene_, camera_, by, found, count, some);
    for (int k = 0; k < count; ++k) out[who[k]] = some[k];
}

/// Layers of a ray come from front to back.
void Tracer::add_light(const SampleOf* of, const Packet& met, Rgba* seen) const {
    const int count = std::min(met.count, EmbreeScene::packet);  // which it is, but the compiler does not see that
    Surfel surfels[EmbreeScene::packet];
    if (ground_) this->surfels(met.by, met.hits, count, surfels);
    else surfels_at(scene_, camera_, met.by, met.hits, count, surfels);
    for (int k = 0; k < count; ++k) {
        surfels[k].sample = of[met.ray[k]];
        surfels[k].dimension = 1 + lighting_.dimensions() * met.layer[k];
    }
    Color light[EmbreeScene::packet];
    lighting_.shade(scene_, surfels, count, light);
    for (int k = 0; k < count; ++k) {
        Rgba& pixel = seen[met.ray[k]];
        if (surfels[k].ground) {  // the background, or white, times 1 + light: what is lacking hides, what has a colour is added
            const Color shade = ground_->shadow * light[k];
            const double grey = (shade.x + shade.y + shade.z) / 3, open = 1 - pixel.alpha;
            const Color tint = shade - Color{grey, grey, grey};
            pixel.color += open * (background_ ? product(*background_, tint) : tint), pixel.alpha -= open * grey;
            continue;
        }
        if (surfels[k].ink_cover > 0) pixel.add_behind(surfels[k].ink, surfels[k].ink_cover);
        pixel.add_behind(light[k], surfels[k].opacity);
    }
}

namespace {

/// The round, in one tile; tells how many samples it traced. `stopped` is set where it is not whole.
class Tile {
public:
    Tile(const Tracer& tracer, Film& film, const Area& area, const std::function<bool()>& stop, std::atomic<bool>& stopped)
        : tracer_(tracer), film_(film), area_(area), stop_(stop), stopped_(stopped) {}
    std::int64_t trace() {
        if (film_.samples() > EmbreeScene::packet / 2) pixels();
        else blocks(tracer_.block());
        return traced_;
    }

private:
    bool open(int x, int y) const { return film_.goes_on(x, y) && film_.at(x, y).seen < film_.round(); }
    void pixels() {
        for (int y = area_.y0; y < area_.y1; ++y)
            for (int x = area_.x0; x < area_.x1; ++x) {
                if (!open(x, y)) continue;
                if (stopped_.load(std::memory_order_relaxed)) return;
                const PixelSum& sum = film_.at(x, y);
                const int before = sum.seen;
                tracer_.sample(x, y, film_.round(), film_.counts(x, y), film_.pixel(x, y), stop_);
                traced_ += sum.seen - before;
                if (sum.seen < film_.round()) stopped_ = true;
            }
    }
    /// All samples of a pixel are in one round.
    void blocks(const Tracer::Block& b) {
        const int n = film_.samples();
        for (int y = area_.y0 - area_.y0 % b.height; y < area_.y1; y += b.height)
            for (int x = area_.x0 - area_.x0 % b.width; x < area_.x1; x += b.width) {
                if (stopped_.load(std::memory_order_relaxed)) return;
                const auto each = [&](auto use) {
                    for (int k = 0; k < b.width * b.height; ++k)
                        if (const int px = x + k % b.width, py = y + k / b.width; px >= area_.x0 && px < area_.x1 && py >= area_.y0 && py < area_.y1 && open(px, py)) use(k, px, py);
                };
                bool any = false;
                each([&](int, int, int) { any = true; });
                if (!any) continue;
                if (stop_ && stop_()) {
                    stopped_ = true;
                    return;
                }
                Rgba seen[EmbreeScene::packet];
                tracer_.sample_block(x, y, seen);
                each([&](int k, int px, int py) { tracer_.add(seen + k * n, n, film_.counts(px, py), film_.pixel(px, py)), traced_ += n; });
            }
    }

    const Tracer& tracer_;
    Film& film_;
    Area area_;
    const std::function<bool()>& stop_;
    std::atomic<bool>& stopped_;
    std::int64_t traced_ = 0;
};

}  // namespace

bool trace_round(const Tracer& tracer, Film& film, int side, const std::function<bool()>& stop, const std::function<void(double)>& progress) {
    const Area& area = film.area();
    const int across = (area.width() + side - 1) / side, tiles = across * ((area.height() + side - 1) / side);
    const auto caller = std::this_thread::get_id();
    std::atomic<bool> stopped{false};
    std::atomic<std::int64_t> traced{0};
    tbb::parallel_for(0, tiles, [&](int tile) {
        const int x0 = area.x0 + side * (tile % across), y0 = area.y0 + side * (tile / across);
        const std::int64_t all = traced += Tile(tracer, film, {x0, y0, std::min(x0 + side, area.x1), std::min(y0 + side, area.y1)}, stop, stopped).trace();
        if (progress && std::this_thread::get_id() == caller) progress(static_cast<double>(all));
    });
    return !stopped;
}

}  // namespace isoparm
