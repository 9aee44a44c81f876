#include "commands/turntable.h"

#include <algorithm>

#include "picture/layout.h"
#include "transform.h"

namespace isoparm {
namespace {

constexpr std::size_t kMostPlaces = 72;  // of a fitted camera, from which everything is looked at: 5 degrees apart at most in a whole turn

Point turned(const Point& p, const Point& middle, const Point& axis, double degrees) { return middle + Transform::rotate(axis, degrees).vector(p - middle); }

}  // namespace

CameraSettings Turntable::Orbit::at(double degrees) const {
    CameraSettings c = camera;
    c.eye = turned(*camera.eye, middle, axis, degrees);
    c.target = turned(*camera.target, middle, axis, degrees);
    c.up = Transform::rotate(axis, degrees).vector(*camera.up);
    return c;
}

Turntable::Turntable(const Scene& first, const RenderOptions& how, const std::vector<double>& degrees) : own_(first.panels.size()) {
    std::size_t panel = 0;
    for (View& v : layout_of(first, how).views) {
        if (v.inset) continue;
        Point low, high;
        for (std::size_t i = 0; i < v.fitted.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                low[k] = i ? std::min(low[k], v.fitted[i][k]) : v.fitted[i][k];
                high[k] = i ? std::max(high[k], v.fitted[i][k]) : v.fitted[i][k];
            }
        const Point middle = v.camera.target.value_or(0.5 * (low + high)), axis = v.camera.up.value_or(Point{0, 0, 1});
        // A camera that turns sees what a resting one sees of things that turn the other way.
        const std::size_t step = (degrees.size() + kMostPlaces - 1) / kMostPlaces, points = v.fitted.size();
        for (std::size_t k = 0; k < degrees.size(); k += step)
            for (std::size_t i = 0; i < points; ++i) v.fitted.push_back(turned(v.fitted[i], middle, axis, -degrees[k]));
        v.camera.target = middle;
        const Orbit orbit{settings_of(camera_of(v), middle), middle, axis};
        const bool own = panel < first.panels.size() && first.panels[panel].camera;
        if (own) own_[panel] = orbit;
        else if (!shared_) shared_ = orbit;
        ++panel;
    }
}

void Turntable::turn(Scene& scene, double degrees) const {
    if (shared_) scene.camera = shared_->at(degrees);
    for (std::size_t i = 0; i < own_.size() && i < scene.panels.size(); ++i)
        if (own_[i]) scene.panels[i].camera = own_[i]->at(degrees);
}

}  // namespace isoparm
