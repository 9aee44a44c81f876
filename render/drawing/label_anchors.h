// label_anchors.h -- the places in a picture to which labels belong.
#pragma once
#include <vector>

#include "drawing/labels.h"
#include "rays/sight.h"

namespace isoparm {

/// Those of one view. What it is made of has to outlive it. Safe from several threads.
class LabelAnchors {
public:
    /// `pixel`, `letter`: as overlay() has them.
    LabelAnchors(const Scene& scene, const Camera& camera, const Sight& sight, double pixel, double letter, const std::vector<SceneObject>& objects);
    /// Where an object's own label may stand, the best first. `sight`: of points on it.
    std::vector<Anchor> of(const SceneObject& o, const Sight& sight) const;
    /// That of a point in a ball of that radius (scene units), or in a larger one of the objects about the same point. Not finite behind the eye.
    Anchor at(const Point& p, double radius) const { return at(p, radius, sight_); }
    /// Of a ball, or of a flat disc as it is seen; scene units.
    double radius_of_point(const SceneObject& o) const;

private:
    Anchor at(const Point& p, double radius, const Sight& sight) const;
    std::vector<Anchor> of_surface(const SceneObject& o, const Sight& sight) const;
    std::vector<Anchor> in_sight(const Composite& patches, const Sight& sight) const;
    std::vector<Anchor> of_curve(const SceneObject& o) const;
    Anchor beyond(const Arrow& arrow) const;

    const Scene& scene_;
    const Camera& camera_;
    const Sight& sight_;
    double pixel_, letter_, size_;
    Vec2 middle_;
    std::vector<std::pair<Point, double>> balls_;
};

/// Is that place inside the camera's picture?
bool inside(const Camera& camera, const Vec2& p);

}  // namespace isoparm
