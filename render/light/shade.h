// shade.h -- how a point of a surface looks. Figures: soft plastic under a studio's light, where nothing is ever brighter than
// white: highlights blend toward it. Traced light: path_lighting.h.
#pragma once
#include "rays/embree_scene.h"
#include "light/local_frame.h"
#include "light/light.h"
#include "light/sample_points.h"
#include "light/studio.h"

namespace isoparm {

/// What a ray sees of a surface, ready to be lit.
struct Surfel {
    Point origin;   // where rays begin that leave it on the viewer's side: clear of the mesh
    Point beneath;  // likewise, on the other side
    Point normal;  // unit, toward the viewer
    Point position, shading, geometric;  // where it is; normals of surface and mesh, unit, on the viewer's side
    Vec2 at;                             // parameters, on patches
    Point view;    // unit, toward the viewer
    Color color;   // linear reflectance
    double opacity = 1;
    bool front = true;  // the viewer sees the outward side
    bool ground = false;  // of the plane that shows only shadows
    const Material* material = nullptr;
    std::uint32_t over = Hit::none;  // the geometry, if it shares a plane: something may lie under it
    Color ink;  // of the lines drawn on it, unlit
    double ink_cover = 0;
    SampleOf sample;    // that it is lit for
    int dimension = 0;  // of its sampler: the first that is its own
};

struct ShadeKernel;
struct TracedScene;

class Lighting {
public:
    virtual ~Lighting() = default;
    /// How many dimensions of the sampler a surfel uses.
    virtual int dimensions() const = 0;
    /// Light leaving n <= EmbreeScene::packet surfels toward the viewer, linear, without the ink. Of the ground: the part of its light by
    /// which it differs from a white one with nothing on it: -1 in full shadow, 0 where nothing changes it.
    virtual void shade(const TracedScene& scene, const Surfel* surfels, int n, Color* out) const = 0;
    /// What the camera sees where nothing is, instead of the background.
    virtual std::optional<Color> backdrop(const Point&) const { return {}; }
};

class FigureLighting : public Lighting {
public:
    /// `ground`: as of PathLighting.
    explicit FigureLighting(const Camera& camera, const std::optional<Ground>& ground = {});
    int dimensions() const override { return 2; }
    void shade(const TracedScene& scene, const Surfel* surfels, int n, Color* out) const override;

private:
    Studio studio_;
    LocalFrame key_;
    const ShadeKernel& kernel_;
    Color sky_on_ground_;  // its mean over directions, weighted with the cosine
};

}  // namespace isoparm
