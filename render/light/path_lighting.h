// path_lighting.h -- traced light: from every surfel one path goes on, bounce by bounce, until it leaves the scene or ends by chance;
// at each of its points a light is asked for directly, too. With caustics, the mean over all samples is the solution of the rendering
// equation cut after `bounces`, but for light of one direction that glass bends: no path finds it. Panes, of thin glass, bend none: light goes straight on behind
// them, to lights and from them, as behind sheets.
#pragma once
#include "light/lights.h"
#include "light/shade.h"

namespace isoparm {

/// Immutable; safe to use from every thread. The same light for every number of threads and any order of pixels.
class PathLighting : public Lighting {
public:
    /// `ground`, if there is one: with its height; its `up` is the normal of surfels that are of it. `page`: what the camera sees where nothing is, but for environments that are seen.
    PathLighting(const LightingSettings& settings, const Camera& camera, const EnvironmentImages& images, const std::optional<Ground>& ground, const Color& page);
    int dimensions() const override { return kDimensions * (settings_.bounces + 1); }
    void shade(const TracedScene& scene, const Surfel* surfels, int n, Color* out) const override;
    std::optional<Color> backdrop(const Point& direction) const override { return lights_.backdrop(direction); }

private:
    static constexpr int kDimensions = 4;  // a point: light and lobe; place on the light; direction; end and opacity
    struct Path;
    struct Batch;
    void ask_lights(Batch& batch) const;
    void pass_pane(Path& path, double distance, const Color& tint) const;
    void scatter(Batch& batch) const;
    void find_points(Batch& batch, Hit* hits) const;
    bool see_page(const TracedScene& scene, Path& path, const Hit& hit) const;
    void follow(Batch& batch) const;
    Color light_on(const Surfel& ground) const;

    LightingSettings settings_;
    Camera camera_;
    Lights lights_;
    std::optional<Ground> ground_;
    Color page_;
    bool page_is_seen_;    // no environment is
    Color sky_on_ground_;  // irradiance
};

}  // namespace isoparm
