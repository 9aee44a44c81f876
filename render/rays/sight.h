// sight.h -- how much of a point the camera sees through what lies before it.
#pragma once
#include "picture/camera.h"
#include "rays/traced_scene.h"

namespace isoparm {

class Sight {
public:
    Sight(const TracedScene& scene, const Camera& camera);
    /// 1: nothing before it; 0: something opaque, or the point is behind the eye. What is less than `clear` scene units
    /// before the point does not count: the tube or surface on which it lies.
    double of(const Point& p, double clear = 0) const;
    /// The same for points of a surface, that number among the objects: what lies over it in a plane that both share (EmbreeScene::Plane) hides them, too. Those of its
    /// border are seen where it is seen beside them.
    Sight on(std::size_t object) const;
    /// Radius of the largest ball about p, scene units; 0: there is none.
    double ball_about(const Point& p) const;
    const Camera& camera() const { return camera_; }

private:
    /// Is it the surface in which p lies that the ray meets there? Within what the mesh may be off and a third of a pixel.
    bool in_surface(const Hit& hit, const Ray& ray, const Point& p, double pixel) const;
    /// How much of the surface is seen within half a pixel of p, at least.
    double beside(const Point& p, const Vec2& at, double pixel) const;
    bool own(const Hit& hit) const { return hit.geometry >= first_ && hit.geometry < later_; }
    const TracedScene& scene_;
    const Camera& camera_;
    double least_;  // the mesh may be that far before the surface
    std::uint32_t first_ = Hit::none, later_ = Hit::none;  // geometries first_ <= i < later_ are the surface's, and later ones lie over it
};

}  // namespace isoparm
