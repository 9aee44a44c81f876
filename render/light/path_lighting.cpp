#include "light/path_lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/bsdf.h"
#include "light/surfel.h"

namespace isoparm {
namespace {

constexpr int kSure = 3;  // bounces before a path may end by chance
enum Dimension { kChoices, kPlaceOnLight, kDirection, kChances };

const Color kWhite{1, 1, 1};

/// What the surfel shows, its ink included.
Color reflectance(const Surfel& s) { return (1 - s.ink_cover) * s.color + s.ink_cover * s.ink; }

/// Of light that is lacking, the part of all.
Color part_of(const Color& lacks, const Color& all) {
    const auto part = [](double l, double of) { return of > 0 ? l / of : 0; };
    return {part(lacks.x, all.x), part(lacks.y, all.y), part(lacks.z, all.z)};
}

/// What a sheet or pane does to light that meets it: the part that is scattered there, and what goes straight on.
struct Passage {
    double scattered = 1;
    Color passes;
};
Passage passage(const Thing& thing, const Hit& hit, const Point& along) {
    const double o = thing.opacity;
    if (!thing.pane) return {o, (1 - o) * kWhite};
    const Point n = normal_at(thing, hit);
    const double cosine = dot(n, along) / length(n), mirrored = pane_fresnel(std::fabs(cosine), thing.material.ior);
    // The side that a path meets or a light's ray comes to from the path: of panes of two colours the viewer's, in both.
    const bool front = ((cosine < 0) != thing.flipped) != thing.inside_out;
    return {o * mirrored, o * (1 - mirrored) * (front ? thing.front : thing.back) + (1 - o) * kWhite};
}

/// The part of the light that passes along each active ray.
void reaching(const TracedScene& scene, const Ray* rays, int n, std::uint32_t active, Color* part) {
    if (!scene.panes) {
        double grey[EmbreeScene::packet];
        scene.embree->transmittance(rays, n, active, grey, EmbreeScene::Shadows::physical);
        for (int i = 0; i < n; ++i) part[i] = grey[i] * kWhite;
        return;
    }
    std::vector<Hit> hits;
    for (int i = 0; i < n; ++i) {
        if (!(active >> i & 1)) continue;
        part[i] = scene.embree->crossed(rays[i], hits) ? kWhite : Color{};
        for (std::size_t k = 0; k < hits.size() && part[i] != Color{}; ++k) part[i] = product(part[i], passage(scene.things[hits[k].geometry], hits[k], rays[i].direction).passes);
    }
}

}  // namespace

struct PathLighting::Path {
    Surfel at;
    Color throughput = kWhite, light;
    Color to_lamps;       // throughput for lights but the sky: without caustics, only what is scattered evenly
    Ray ray;              // from `at` on
    std::uint32_t under = Hit::none;  // layers() for it
    double density = 0;   // of its direction; 0: the only one
    bool spread = false;  // was scattered evenly at some point
    bool clear = true;      // has passed through glass and nothing else: the camera looks along the ray
    bool mirrored = false;  // `at` is on a pane, which does nothing else
    bool ended = false;
};

/// The paths of one call that go on.
struct PathLighting::Batch {
    const TracedScene& scene;
    int bounce = 0, n = 0;
    Path paths[EmbreeScene::packet];
    int number[EmbreeScene::packet];  // of the surfel

    /// `sheet`: of those that a ray passes.
    Vec2 random(const Path& p, Dimension d, int sheet = 0) const {
        constexpr int apart = 1 << 16;  // dimensions: more than all layers and bounces of a pixel use
        return (*p.at.sample.sampler)(p.at.sample.number, p.at.dimension + kDimensions * bounce + d + apart * sheet);
    }
    void drop_ended(Color* out) {
        int kept = 0;
        for (int i = 0; i < n; ++i) {
            if (paths[i].ended) {
                out[number[i]] = paths[i].light;
                continue;
            }
            if (kept != i) paths[kept] = paths[i], number[kept] = number[i];
            ++kept;
        }
        n = kept;
    }
};

PathLighting::PathLighting(const LightingSettings& settings, const Camera& camera, const EnvironmentImages& images, const std::optional<Ground>& ground, const Color& page)
    : settings_(settings), camera_(camera), lights_(settings.lights, camera, images), ground_(ground), page_(page), page_is_seen_(!lights_.backdrop({0, 0, 1})) {
    if (ground) sky_on_ground_ = lights_.sky_irradiance(ground->up);
}

void PathLighting::shade(const TracedScene& scene, const Surfel* surfels, int n, Color* out) const {
    Batch batch{scene, 0, n, {}, {}};
    for (int i = 0; i < n; ++i) batch.paths[i].at = surfels[i], batch.number[i] = i;
    for (; batch.n > 0; ++batch.bounce) {
        ask_lights(batch);
        scatter(batch);
        batch.drop_ended(out);
        follow(batch);
        if (batch.bounce == settings_.bounces)
            for (int i = 0; i < batch.n; ++i) batch.paths[i].ended = true;
        batch.drop_ended(out);
    }
    for (int i = 0; i < n; ++i)
        if (surfels[i].ground) out[i] = part_of(out[i], light_on(surfels[i]));  // from what it lacks to the part that it lacks
}

/// What a white plane there would throw back if nothing were on it.
Color PathLighting::light_on(const Surfel& ground) const { return (1 / std::numbers::pi) * (sky_on_ground_ + lights_.irradiance(ground.origin, ground.normal)); }

void PathLighting::ask_lights(Batch& batch) const {
    Ray to_light[EmbreeScene::packet];
    Color arriving[EmbreeScene::packet];
    Color part[EmbreeScene::packet];
    std::uint32_t active = 0;
    for (int i = 0; i < batch.n; ++i) {
        const Path& p = batch.paths[i];
        const LocalFrame frame(p.at.normal);
        const Bsdf bsdf(*p.at.material, reflectance(p.at), !p.at.front);
        to_light[i] = {p.at.origin, p.at.normal};
        if (bsdf.specular()) continue;
        const Lights::Sample l = lights_.sample(p.at.origin, batch.random(p, kChoices).x, batch.random(p, kPlaceOnLight));
        const Point out = frame.to_local(p.at.view), in = frame.to_local(l.direction);
        if (!(in.z > 0)) continue;
        const double chosen = bsdf.density(out, in), both = l.density * l.density + chosen * chosen;
        const double weight = l.density > 0 && !(p.at.ground && !(l.sky > 0)) ? l.density * l.density / both : 1;
        Color scattered = bsdf.value(out, in);
        if (p.spread && !settings_.caustics) scattered = l.sky * scattered + (1 - l.sky) * bsdf.spread(out, in);
        arriving[i] = weight * product(product(p.throughput, scattered), l.radiance);
        to_light[i] = {p.at.origin, l.direction, l.distance};
        if (arriving[i].x + arriving[i].y + arriving[i].z > 0) active |= 1u << i;
    }
    reaching(batch.scene, to_light, batch.n, active, part);
    for (int i = 0; i < batch.n; ++i)
        if (active >> i & 1) batch.paths[i].light += product(batch.paths[i].at.ground ? part[i] - kWhite : part[i], arriving[i]);
}

void PathLighting::scatter(Batch& batch) const {
    for (int i = 0; i < batch.n; ++i) {
        Path& p = batch.paths[i];
        const LocalFrame frame(p.at.normal);
        const Bsdf bsdf(*p.at.material, reflectance(p.at), !p.at.front);
        const Point out = frame.to_local(p.at.view);
        const Bsdf::Sample s = p.mirrored ? Bsdf::mirrored(out) : bsdf.sample(out, batch.random(p, kChoices).y, batch.random(p, kDirection));
        const bool caustic = p.spread && !settings_.caustics;  // what the coat, metal or glass would throw now
        const Color even = s.density > 0 && !bsdf.specular() ? bsdf.spread(out, s.direction) / s.density : Color{};
        const bool through = !(s.direction.z > 0);
        p.clear = p.clear && bsdf.specular() && through;
        p.to_lamps = p.clear && page_is_seen_ ? Color{} : product(p.throughput, caustic ? even : s.weight);  // the camera sees no lamps
        p.throughput = product(p.throughput, s.weight);
        const double most = std::max({p.throughput.x, p.throughput.y, p.throughput.z});
        p.ended = !(most > 0);
        if (p.ended) continue;
        if (batch.bounce >= kSure) {  // the lighter a path, the likelier it ends; what goes on weighs more
            const double goes_on = std::min(1.0, most);
            if (batch.random(p, kChances).x >= goes_on) p.ended = true;
            p.throughput = p.throughput / goes_on, p.to_lamps = p.to_lamps / goes_on;
        }
        p.under = through ? p.at.over : Hit::none;
        p.ray = {through && p.under == Hit::none ? p.at.beneath : p.at.origin, normalized(frame.to_world(s.direction))};
        p.density = bsdf.specular() ? 0 : s.density;
        p.spread = p.spread || s.spread;
    }
}

/// So far on its way the path comes to a pane: what it brings from behind is tinted.
void PathLighting::pass_pane(Path& p, double distance, const Color& tint) const {
    const Color lost = kWhite - tint;
    if (p.at.ground) p.light += -1 * product(product(p.throughput, lost), lights_.sky(p.ray.direction) + lights_.behind(p.ray, p.density));
    else p.light += product(product(p.to_lamps, lost), lights_.met(p.ray, distance, p.density, false));  // lamps before it are not, which follow() does not know
    p.throughput = product(p.throughput, tint), p.to_lamps = product(p.to_lamps, tint);
}

/// Where each ray is scattered: the first hit, or the first sheet or pane that by chance does not let it pass.
void PathLighting::find_points(Batch& batch, Hit* hits) const {
    const EmbreeScene& embree = *batch.scene.embree;
    Ray rays[EmbreeScene::packet];
    for (int i = 0; i < batch.n; ++i) rays[i] = batch.paths[i].ray;
    if (!embree.translucent()) return embree.intersect(rays, batch.n, hits);
    std::vector<Hit> layers;
    for (int i = 0; i < batch.n; ++i) {
        Path& p = batch.paths[i];
        embree.layers(rays[i], layers, p.under);
        hits[i] = Hit{};
        p.mirrored = false;
        for (std::size_t k = 0; k < layers.size() && !hits[i].found(); ++k) {
            const Thing& thing = batch.scene.things[layers[k].geometry];
            const Passage way = passage(thing, layers[k], rays[i].direction);
            if (batch.random(p, kChances, static_cast<int>(k)).y < way.scattered) hits[i] = layers[k], p.mirrored = thing.pane;
            else if (thing.pane) pass_pane(p, layers[k].distance, way.passes / (1 - way.scattered));
        }
    }
}

/// What the camera sees through glass is what it sees beside it: the page, and the shadows on the ground. True: so it is with this path; it has ended, or goes on from the ground.
bool PathLighting::see_page(const TracedScene& scene, Path& p, const Hit& hit) const {
    if (!p.clear || !page_is_seen_) return false;
    const double distance = ground_ ? ground_->meet(p.ray.origin, p.ray.direction) : -1;
    const bool on_ground = distance >= 0 && distance < hit.distance;
    if (hit.found() && !on_ground) return false;
    p.light += product(p.throughput, page_);
    p.ended = !on_ground;
    if (p.ended) return true;
    Surfel ground = ground_surfel(*ground_, p.ray, distance, scene);
    ground.sample = p.at.sample, ground.dimension = p.at.dimension;
    p.at = ground;
    p.throughput = part_of(ground_->shadow * product(p.throughput, page_), light_on(ground));
    return true;
}

void PathLighting::follow(Batch& batch) const {
    Hit hits[EmbreeScene::packet], met[EmbreeScene::packet];
    find_points(batch, hits);
    Ray met_by[EmbreeScene::packet];
    int who[EmbreeScene::packet], count = 0;
    for (int i = 0; i < batch.n; ++i) {
        Path& p = batch.paths[i];
        if (see_page(batch.scene, p, hits[i])) continue;
        p.ended = !hits[i].found();
        if (p.at.ground) {  // lamps were asked for already; what hides the sky takes its light away
            if (!p.ended) p.light += -1 * product(p.throughput, lights_.sky(p.ray.direction) + lights_.behind(p.ray, p.density));
        } else {
            p.light += product(p.to_lamps, lights_.met(p.ray, hits[i].distance, p.density, false));
            if (p.ended) p.light += product(p.throughput, lights_.sky(p.ray.direction) + lights_.met(p.ray, hits[i].distance, p.density, true));
        }
        if (!p.ended) who[count] = i, met_by[count] = p.ray, met[count++] = hits[i];
    }
    Surfel surfels[EmbreeScene::packet];
    surfels_at(batch.scene, camera_, met_by, met, count, surfels);
    for (int k = 0; k < count; ++k) {
        Surfel& at = batch.paths[who[k]].at;
        surfels[k].sample = at.sample, surfels[k].dimension = at.dimension;
        at = surfels[k];
    }
}

}  // namespace isoparm
