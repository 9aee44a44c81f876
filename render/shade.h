// shade.h -- how a point of a surface looks: soft plastic under a key light, a fill and a sky that come with the
// camera, so that every figure is lit like the next one. Nothing is ever brighter than white: highlights blend toward
// it.
#pragma once
#include "embree_scene.h"
#include "sampler.h"

namespace isoparm {

/// What a ray sees of a surface, ready to be lit.
struct Surfel {
    Point origin;  // where its shadow rays begin: clear of the mesh
    Point normal;  // unit, toward the viewer
    Point position, shading, geometric;  // where it is; normals of surface and mesh, unit, on the viewer's side
    Vec2 at;                             // parameters, on patches
    Point view;    // unit, toward the viewer
    Color color;   // linear reflectance
    double opacity = 1;
    Color ink;  // of the lines drawn on it, unlit
    double ink_cover = 0;
    int sample = 0, dimension = 0;  // of the sampler: dimension for the light, dimension + 1 for the sky
};

class Lighting {
public:
    explicit Lighting(const Camera& camera);
    /// Light leaving n <= EmbreeScene::packet surfels of one pixel toward the viewer, linear, without the ink.
    void shade(const EmbreeScene& scene, const PixelSampler& sampler, const Surfel* surfels, int n, Color* out) const;

private:
    /// The sky's light from a direction.
    Color sky(const Point& direction) const;
    Point up_, key_, key_x_, key_y_, fill_;
};

}  // namespace isoparm
