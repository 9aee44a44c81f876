// overlay.h -- the vectors over a traced scene: flat lines, axes, labels.
#pragma once
#include "drawing/drawing.h"
#include "picture/panels.h"
#include "rays/sight.h"

namespace isoparm {

/// What a drawing has over it.
struct OverlayPlace {
    bool inset = false;                         // no legends, and no labels of what is outside
    std::vector<std::array<int, 4>> covered{};  // x, y, width, height: labels keep off
};

/// `pixel`: pixels of this picture to one of the scene's; `letter`: size of letters that say nothing else. The same for
/// every number of threads. `isolines`: those of surfaces too, which the tracer otherwise paints.
Drawing overlay(const Scene& scene, const std::vector<SceneObject>& objects, const TracedScene& traced,
                const Camera& camera, double pixel, double letter, bool isolines = false, const OverlayPlace& place = {});

}  // namespace isoparm
