// commands/turntable.h -- cameras that go round what they look at.
#pragma once
#include <optional>
#include <vector>

#include "picture/picture.h"

namespace isoparm {

/// The cameras of a scene's first frame, decided where they fit, so that what is drawn stays inside wherever they go.
class Turntable {
public:
    /// `degrees`: where they will go. Throws what layout_of() does.
    Turntable(const Scene& first, const RenderOptions& how, const std::vector<double>& degrees);
    /// Gives the scene these cameras, turned about the axes through their targets (or the middle of what is drawn) along their `up`,
    /// right-handed: seen from above, the eye goes counter-clockwise. Insets with cameras of their own keep them.
    void turn(Scene& scene, double degrees) const;

private:
    struct Orbit {
        CameraSettings camera;
        Point middle, axis;
        CameraSettings at(double degrees) const;
    };
    std::optional<Orbit> shared_;             // by the scene and its panels without cameras
    std::vector<std::optional<Orbit>> own_;  // of each panel
};

}  // namespace isoparm
