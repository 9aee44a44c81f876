#include "picture/aov.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "error.h"
#include "light/surfel.h"

namespace isoparm {
namespace {

constexpr std::size_t kMostNumbers = 1u << 24;  // whole numbers that a float32 holds

float finite_float(double x) {
    constexpr double most = std::numeric_limits<float>::max();
    return std::isnan(x) ? 0 : static_cast<float>(std::clamp(x, -most, most));
}

/// What a pixel shows; `thing` is nullptr where there is nothing, its patch for tubes and balls.
struct Seen {
    const Thing* thing = nullptr;
    Surfel surfel;
    double depth = 0;
    std::uint32_t triangle = 0;
    double error = 0;  // of the hit, where rays meet patches themselves
};

void put(const Point& p, float* out) {
    for (int i = 0; i < 3; ++i) out[i] = finite_float(p[i]);
}

Color albedo(const Surfel& s) { return s.ink_cover * s.ink + (1 - s.ink_cover) * s.color; }

void put_curvature(const Seen& seen, float* out) {
    if (!seen.thing || !seen.thing->patch) return;
    const SurfacePoint p = evaluate(*seen.thing->patch, seen.surfel.at.x, seen.surfel.at.y);
    out[0] = finite_float(p.gaussian.value_or(0));
    out[1] = finite_float(p.mean.value_or(0));
}

/// `out` holds zeros.
void put(Aov aov, const Seen& seen, float patch, const PixelSamples& samples, float* out) {
    const bool some = seen.thing, on_patch = some && seen.thing->patch;
    switch (aov) {
        case Aov::n: return some ? put(seen.surfel.shading, out) : void();
        case Aov::ng: return some ? put(seen.surfel.geometric, out) : void();
        case Aov::p: return some ? put(seen.surfel.position, out) : void();
        case Aov::albedo: return some ? put(albedo(seen.surfel), out) : void();
        case Aov::curvature: return put_curvature(seen, out);
        case Aov::variance: return put(samples.variance, out);
        case Aov::sample_variance: return put(samples.sample_variance, out);
        case Aov::samples: *out = static_cast<float>(samples.count); return;
        case Aov::uv:
            if (on_patch) out[0] = finite_float(seen.surfel.at.x), out[1] = finite_float(seen.surfel.at.y);
            return;
        case Aov::z: *out = some ? finite_float(seen.depth) : kAovFar; return;
        case Aov::patch: *out = patch; return;
        case Aov::triangle: *out = on_patch && seen.thing->mesh ? static_cast<float>(seen.triangle) : kAovNone; return;
        case Aov::error: *out = !on_patch ? 0 : finite_float(seen.thing->mesh ? seen.thing->error : seen.error); return;
    }
}

std::size_t size_of(Aov aov) { return all_aovs()[static_cast<std::size_t>(aov)].channels.size(); }

}  // namespace

const std::vector<AovKind>& all_aovs() {
    static const std::vector<AovKind> all{{Aov::n, "N", {"N.X", "N.Y", "N.Z"}},
                                          {Aov::ng, "Ng", {"Ng.X", "Ng.Y", "Ng.Z"}},
                                          {Aov::p, "P", {"P.X", "P.Y", "P.Z"}},
                                          {Aov::uv, "uv", {"uv.U", "uv.V"}},
                                          {Aov::albedo, "albedo", {"albedo.R", "albedo.G", "albedo.B"}},
                                          {Aov::z, "Z", {"Z"}},
                                          {Aov::patch, "patch", {"patch.I"}},
                                          {Aov::triangle, "triangle", {"triangle.I"}},
                                          {Aov::curvature, "curvature", {"curvature.gaussian", "curvature.mean"}},
                                          {Aov::error, "error", {"error.V"}},
                                          {Aov::variance, "variance", {"variance.R", "variance.G", "variance.B"}},
                                          {Aov::sample_variance, "sample_variance", {"sample_variance.R", "sample_variance.G", "sample_variance.B"}},
                                          {Aov::samples, "samples", {"samples.I"}}};
    return all;
}

bool uses_statistics(const std::vector<Aov>& aovs) {
    return std::any_of(aovs.begin(), aovs.end(), [](Aov a) { return a == Aov::variance || a == Aov::sample_variance; });
}

std::vector<std::string> channels_of(const std::vector<Aov>& aovs) {
    std::vector<std::string> names;
    for (const Aov a : aovs)
        for (const char* channel : all_aovs()[static_cast<std::size_t>(a)].channels) names.push_back(channel);
    return names;
}

std::vector<float> empty_pixel(const std::vector<Aov>& aovs) {
    std::vector<float> values(channels_of(aovs).size(), 0.0f);
    float* out = values.data();
    for (const Aov a : aovs) {
        put(a, {}, kAovNone, {}, out);
        out += size_of(a);
    }
    return values;
}

std::string patch_numbers(const Scene& scene) {
    std::string text;
    std::size_t first = 0;
    for (const Surface& s : scene.surfaces) {
        if (s.patches.empty()) continue;
        if (!text.empty()) text += ", ";
        text.append(s.name).append(" ").append(std::to_string(first));
        if (s.patches.size() > 1) text.append("-").append(std::to_string(first + s.patches.size() - 1));
        first += s.patches.size();
    }
    return text;
}

AovReader::AovReader(const Scene& scene, const TracedScene& traced, const Camera& camera, std::vector<Aov> aovs)
    : traced_(traced), camera_(camera), aovs_(std::move(aovs)), channels_(channels_of(aovs_).size()) {
    for (const Thing& thing : traced.things) {
        patch_.push_back(kAovNone);
        std::size_t number = 0;
        for (const Surface& s : scene.surfaces)
            for (const Member& m : s.patches) {
                if (&m.patch == thing.patch) patch_.back() = static_cast<float>(number);
                ++number;
            }
        const std::size_t triangles = !thing.mesh ? 0 : thing.quads ? thing.quads->triangles() : thing.part->triangles.size();
        const bool many = triangles > kMostNumbers;
        if (many && std::find(aovs_.begin(), aovs_.end(), Aov::triangle) != aovs_.end())
            throw Error(ErrorKind::usage, "--aov triangle: patch " + thing.part->name + " has " + std::to_string(triangles) +
                                              " triangles, expected at most " + std::to_string(kMostNumbers) + "; use a larger --tolerance");
    }
}

void AovReader::read(int x, int y, const PixelSamples& samples, float* out) const {
    std::fill(out, out + channels_, 0.0f);
    const Ray ray = camera_.ray(x + 0.5, y + 0.5);
    const Hit hit = traced_.embree->first(ray);
    Seen seen;
    if (hit.found()) {
        seen.thing = &traced_.things[hit.geometry];
        surfels_at(traced_, camera_, &ray, &hit, 1, &seen.surfel);
        seen.depth = camera_.depth(seen.surfel.position);
        seen.triangle = seen.thing->quads ? seen.thing->quads->triangle(hit.primitive) : hit.primitive;
        seen.error = hit.error;
    }
    for (const Aov a : aovs_) {
        put(a, seen, hit.found() ? patch_[hit.geometry] : kAovNone, samples, out);
        out += size_of(a);
    }
}

}  // namespace isoparm
