// tracer.h -- the samples of a picture's pixels: rays through them, what they meet, and the light that comes back.
#pragma once
#include "light/sampler.h"
#include "light/shade.h"
#include "light/surfel.h"
#include "picture/film.h"
#include "rays/coverage.h"
#include "rays/traced_scene.h"

namespace isoparm {

/// A colour, premultiplied, and how much of what is behind it hides.
struct Rgba {
    Color color;
    double alpha = 0;
    /// What lies behind, seen through what is here.
    void add_behind(const Color& c, double opacity) {
        color += ((1 - alpha) * opacity) * c;
        alpha += (1 - alpha) * opacity;
    }
};

/// Immutable; safe to use from every thread. All that it is given must live as long.
class Tracer {
public:
    /// `ground`: with its height, as the lighting knows it.
    Tracer(const TracedScene& scene, const Camera& camera, const Lighting& lighting, int samples, const std::optional<Color>& background, const std::optional<Ground>& ground)
        : scene_(scene), camera_(camera), lighting_(lighting), samples_(samples), background_(background), ground_(ground), coverage_(scene, camera), open_(ground || lighting.backdrop(camera.forward)) {}

    /// Traces samples of the pixel up to number `to`, in packets that begin at multiples of EmbreeScene::packet; between them it may end early when
    /// `stop` says so. `counts`: they are added to the sums.
    void sample(int x, int y, int to, bool counts, const FilmPixel& pixel, const std::function<bool()>& stop) const;
    /// Pixels of pictures of few samples share packets: blocks so wide and high, which begin at multiples of that, whatever part of the picture is rendered.
    struct Block {
        int width, height;
    };
    Block block() const;
    /// Traces all samples of the block at (x,y), into what is empty: those of its pixels, row by row.
    void sample_block(int x, int y, Rgba* seen) const;
    /// Adds traced samples to what is kept of a pixel.
    void add(Rgba* seen, int n, bool counts, const FilmPixel& pixel) const;
    /// Background and all, premultiplied; of a pixel that has samples.
    Rgba resolved(const PixelSum& sum) const;
    /// A single sample through the middle of some pixels, for pictures that are not there yet.
    Rgba glance(double x, double y) const;

private:
    /// What rays met, and as which of their layers; a hit that is none is of the ground, at its distance.
    struct Packet {
        Ray by[EmbreeScene::packet];
        Hit hits[EmbreeScene::packet];
        int ray[EmbreeScene::packet], layer[EmbreeScene::packet], count = 0;
        void add(const Ray& one, const Hit& hit, int number, int of_ray) { by[count] = one, hits[count] = hit, ray[count] = number, layer[count++] = of_ray; }
    };
    /// Through the samples' places in the pixels whose corners are given.
    void rays(const Vec2* pixel, const SampleOf* of, int n, RayLanes& out) const;
    Rgba finished(Rgba pixel) const;
    /// What a ray meets of the ground before `end`.
    std::optional<Hit> ground_hit(const Ray& ray, double end) const;
    void surfels(const Ray* rays, const Hit* hits, int n, Surfel* out) const;
    /// May a sample of the pixel be anything but empty?
    bool may_meet(int x, int y) const { return open_ || coverage_.may_meet(x, y); }
    void trace(const RayLanes& rays, const SampleOf* of, int n, Rgba* seen) const;
    void add_light(const SampleOf* of, const Packet& met, Rgba* seen) const;

    const TracedScene& scene_;
    const Camera& camera_;
    const Lighting& lighting_;
    PixelFilter filter_;
    int samples_;
    std::optional<Color> background_;
    std::optional<Ground> ground_;
    Coverage coverage_;
    bool open_;  // rays that meet nothing of the scene see something else than the background
};

/// Traces the round of the film, tile by tile, until it is made or `stop` says so; `progress` gets the samples traced since, from the calling
/// thread only. `tile`: pixels a side, which changes nothing but the speed. True: the round is made.
bool trace_round(const Tracer& tracer, Film& film, int tile, const std::function<bool()>& stop, const std::function<void(double)>& progress);

}  // namespace isoparm
