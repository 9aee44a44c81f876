#include "tracer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <thread>

namespace isoparm {

void Tracer::sample(int x, int y, int to, bool counts, PixelSum& sum, Spread* spread, const std::function<bool()>& stop) const {
    const PixelSampler sampler(x, y, samples_);
    while (sum.seen < to && !(stop && stop())) {
        const int first = sum.seen, n = std::min(EmbreeScene::packet, to - first);
        Ray rays[EmbreeScene::packet];
        Rgba seen[EmbreeScene::packet];
        for (int i = 0; i < n; ++i) {
            const Vec2 at = filter_(sampler(first + i, 0));
            rays[i] = camera_.ray(x + 0.5 + at.x, y + 0.5 + at.y);
        }
        trace(sampler, rays, first, n, seen);
        for (int i = 0; i < n; ++i) {
            if (counts) sum.color += seen[i].color, sum.alpha += seen[i].alpha;
            if (!spread) continue;
            seen[i].add_behind(background_.value_or(Color{1, 1, 1}), 1);
            spread->add(seen[i].color);
        }
        sum.seen += n;
        if (counts) sum.used += n;
    }
}

Rgba Tracer::resolved(const PixelSum& sum) const {
    Rgba mean{sum.color / double(sum.used), sum.alpha / sum.used};
    if (background_) mean.add_behind(*background_, 1);
    return mean;
}

Rgba Tracer::glance(double x, double y) const {
    const PixelSampler sampler(static_cast<int>(x), static_cast<int>(y), samples_);
    const Ray ray = camera_.ray(x, y);
    Rgba seen;
    trace(sampler, &ray, 0, 1, &seen);
    if (background_) seen.add_behind(*background_, 1);
    return seen;
}

void Tracer::trace(const PixelSampler& sampler, const Ray* rays, int first, int n, Rgba* seen) const {
    std::vector<Met> met;
    if (scene_.embree->translucent()) {
        std::vector<Hit> hits;
        for (int i = 0; i < n; ++i) {
            scene_.embree->layers(rays[i], hits);
            for (std::size_t k = 0; k < hits.size(); ++k) met.push_back({hits[k], i, static_cast<int>(k)});
        }
    } else {
        Hit hits[EmbreeScene::packet];
        scene_.embree->intersect(rays, n, hits);
        for (int i = 0; i < n; ++i)
            if (hits[i].found()) met.push_back({hits[i], i, 0});
    }
    add_light(sampler, rays, first, met, seen);
}

/// Layers of a ray come from front to back.
void Tracer::add_light(const PixelSampler& sampler, const Ray* rays, int first, const std::vector<Met>& met, Rgba* seen) const {
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
        for (int k = 0; k < count; ++k) {
            Rgba& pixel = seen[met[begin + k].ray];
            if (surfels[k].ink_cover > 0) pixel.add_behind(surfels[k].ink, surfels[k].ink_cover);
            pixel.add_behind(light[k], surfels[k].opacity);
        }
    }
}

bool trace_round(const Tracer& tracer, Film& film, int side, const std::function<bool()>& stop, const std::function<void(double)>& progress) {
    const Area& area = film.area();
    const int across = (area.width() + side - 1) / side, tiles = across * ((area.height() + side - 1) / side);
    const auto caller = std::this_thread::get_id();
    std::atomic<bool> stopped{false};
    std::atomic<std::int64_t> traced{0};
    tbb::parallel_for(0, tiles, [&](int tile) {
        std::int64_t here = 0;
        const int x0 = area.x0 + side * (tile % across), y0 = area.y0 + side * (tile / across);
        for (int y = y0; y < std::min(y0 + side, area.y1); ++y)
            for (int x = x0; x < std::min(x0 + side, area.x1); ++x) {
                PixelSum& pixel = film.at(x, y);
                if (!film.goes_on(x, y) || pixel.seen >= film.round()) continue;
                if (stopped.load(std::memory_order_relaxed)) return;
                const int before = pixel.seen;
                tracer.sample(x, y, film.round(), film.counts(x, y), pixel, film.spread(x, y), stop);
                here += pixel.seen - before;
                if (pixel.seen < film.round()) stopped = true;
            }
        const std::int64_t all = traced += here;
        if (progress && std::this_thread::get_id() == caller) progress(static_cast<double>(all));
    });
    return !stopped;
}

}  // namespace isoparm
