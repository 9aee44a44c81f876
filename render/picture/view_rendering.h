// view_rendering.h -- one view of a picture: what is seen in it, the light, and the samples so far.
#pragma once
#include "light/path_lighting.h"
#include "picture/layout.h"
#include "picture/picture.h"
#include "picture/tracer.h"

namespace isoparm {

struct Quality {
    int samples;
    double noise;
    bool statistics;  // of the samples of each pixel
    Tolerance tolerance;
    double pixel;  // pixels of this picture to one of the scene's
    bool exact, vectors;
    double most_halved;
    int grid;
};

/// The part `area` of a view, in the view's own pixels, ready to be traced. Refers to scene and view.
class ViewRendering {
public:
    /// Tessellates; throws what that does, and Error(input) where the tolerance comes to nothing.
    ViewRendering(const Scene& scene, const View& view, const Area& area, const Quality& how, const EnvironmentImages& environments, const std::function<void(double)>& progress);

    const View& view() const { return view_; }
    const Area& area() const { return area_; }
    const TracedScene& traced() const { return traced_; }
    const Tracer& tracer() const { return tracer_; }
    /// Of the area, or more.
    Film& film() { return film_; }
    const Film& film() const { return film_; }
    /// As far as it is traced.
    Picture picture(const std::vector<Aov>& aovs) const;

private:
    const Scene& scene_;
    const View& view_;
    Area area_;
    Quality how_;
    Camera camera_;
    double tolerance_;
    bool lines_;  // parameter lines are vectors
    bool spread_;  // fireflies
    TracedScene traced_;
    std::optional<Ground> ground_;
    std::unique_ptr<const Lighting> lighting_;
    Film film_;
    Tracer tracer_;
};

}  // namespace isoparm
