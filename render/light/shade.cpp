#include "light/shade.h"

#include <algorithm>

#include "light/shade_kernel.h"
#include "rays/traced_scene.h"

namespace isoparm {

FigureLighting::FigureLighting(const Camera& camera, const std::optional<Ground>& ground) : studio_(camera), key_(studio_.key), kernel_(shade_kernel(chosen_isa())) {
    if (!ground) return;
    constexpr int kSteps = 128;
    const LocalFrame frame(ground->up);
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) sky_on_ground_ += (1.0 / (kSteps * kSteps)) * studio_.sky(frame.to_world(on_hemisphere({(i + 0.5) / kSteps, (k + 0.5) / kSteps})));
}

void FigureLighting::shade(const TracedScene& scene, const Surfel* surfels, int n, Color* out) const {
    static_assert(SurfelPacket::lanes == EmbreeScene::packet && SurfelPacket::lanes == kSamplePacket);
    if (n == 0) return;
    SurfelPacket p;
    SampleOf of[EmbreeScene::packet];
    int key_dimension[EmbreeScene::packet], sky_dimension[EmbreeScene::packet];
    for (int i = 0; i < SurfelPacket::lanes; ++i) {
        const Surfel& s = surfels[i < n ? i : 0];
        of[i] = s.sample, key_dimension[i] = s.dimension, sky_dimension[i] = s.dimension + 1;
        for (int k = 0; k < 3; ++k) p.normal[k][i] = s.normal[k], p.view[k][i] = s.view[k], p.color[k][i] = s.color[k];
    }
    const auto points = [&](const int* dimension, double (*to)[SurfelPacket::lanes]) {
        Vec2 at[EmbreeScene::packet];
        sample_points(of, dimension, SurfelPacket::lanes, at);
        for (int i = 0; i < SurfelPacket::lanes; ++i) to[0][i] = at[i].x, to[1][i] = at[i].y;
    };
    points(key_dimension, p.at_key);
    points(sky_dimension, p.at_sky);
    kernel_.directions(studio_, key_, p);

    RayLanes rays;
    for (int i = 0; i < RayLanes::lanes; ++i)
        for (int k = 0; k < 3; ++k) rays.origin[k][i] = surfels[i < n ? i : 0].origin[k];
    const auto rays_to = [&](const double (&d)[3][SurfelPacket::lanes]) -> const RayLanes& {
        for (int k = 0; k < 3; ++k) std::copy_n(d[k], RayLanes::lanes, rays.direction[k]);
        return rays;
    };
    std::uint32_t lit = 0;
    for (int i = 0; i < n; ++i)
        if (p.cosine[i] > 0) lit |= 1u << i;
    scene.embree->transmittance(rays_to(p.to_key), n, lit, p.key_light);
    scene.embree->transmittance(rays_to(p.to_sky), n, (1u << n) - 1, p.sky_light);
    for (int i = n; i < SurfelPacket::lanes; ++i) p.key_light[i] = p.sky_light[i] = 1;
    kernel_.colors(p);

    for (int i = 0; i < n; ++i) {
        out[i] = {p.out[0][i], p.out[1][i], p.out[2][i]};
        if (!surfels[i].ground) continue;
        // The key light through the middle of its disc, so that the sum has no noise where there is no shadow.
        const double middle = std::max(0.0, dot(surfels[i].normal, studio_.key));
        const Color sky{p.sky[0][i], p.sky[1][i], p.sky[2][i]};
        const Color all = middle * Studio::key_light + sky_on_ground_, lacks = (middle * (1 - p.key_light[i]) * (lit >> i & 1)) * Studio::key_light + ((1 - kBounce) * (1 - p.sky_light[i])) * sky;
        out[i] = {-lacks.x / all.x, -lacks.y / all.y, -lacks.z / all.z};
    }
}

}  // namespace isoparm
