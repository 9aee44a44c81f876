// build_translational.cpp -- surfaces that a scene file gives by curves to move or to blend as control polygons.
#include "patches/control_net.h"
#include "patches/translational.h"
#include "promises.h"
#include "scene/registry.h"
#include "scene/repair.h"

namespace isoparm {

namespace {

SplineCurve spline(const Json& j, SceneBuilder& scene, const char* key) {
    const Json reference = j.at(key, "a bezier, bspline or line curve");
    const auto built = scene.curve(reference);
    if (!built.spline) reference.expected("a bezier, bspline or line curve without weights: the net is made of its control points");
    return *built.spline;
}

}  // namespace

BuiltSurface build_translational_blend(const Json& j, SceneBuilder& scene) {
    return fitted(frame_of(j, scene), j, scene, [](const CoonsCurves& c) { return BuiltSurface(make_translational_blend(c)).examined([c] { return examine(c); }); });
}

BuiltSurface build_translational(const Json& j, SceneBuilder& scene) {
    const CommonStart curves{scene.curve(j, "c", "the curve along u"), scene.curve(j, "d", "the curve along v")};
    return fitted(curves, j, scene, [](const CommonStart& s) { return make_translational(s.c, s.d); });
}

BuiltSurface build_control_net(const Json& j, SceneBuilder& scene) {
    const ControlFrame frame{spline(j, scene, "c0"), spline(j, scene, "c1"), spline(j, scene, "d0"), spline(j, scene, "d1")};
    return fitted(frame, j, scene, [](const ControlFrame& f) { return BuiltSurface(make_control_net(f), net_of(coons_net(f))); });
}

}  // namespace isoparm
