// build_ruled.cpp -- surfaces that a scene file gives by curves to move: ruled, cone, translational, discrete Coons nets.
#include "patches/control_net.h"
#include "patches/ruled.h"
#include "patches/translational.h"
#include "registry.h"
#include "repair.h"

namespace isoparm {

namespace {

Curve curve(const Json& j, SceneBuilder& scene, const char* key, const char* meaning) { return scene.curve(j.at(key, meaning)).curve; }

SplineCurve spline(const Json& j, SceneBuilder& scene, const char* key) {
    const Json reference = j.at(key, "a bezier, bspline or line curve");
    const auto built = scene.curve(reference);
    if (!built.spline) reference.expected("a bezier, bspline or line curve without weights: the net is made of its control points");
    return *built.spline;
}

}  // namespace

BuiltSurface build_translational_blend(const Json& j, SceneBuilder& scene) {
    return fitted(frame_of(j, scene), j, scene, [](const CoonsCurves& c) { return make_translational_blend(c); });
}

BuiltSurface build_translational(const Json& j, SceneBuilder& scene) {
    const CommonStart curves{curve(j, scene, "c", "the curve along u"), curve(j, scene, "d", "the curve along v")};
    return fitted(curves, j, scene, [](const CommonStart& s) { return make_translational(s.c, s.d); });
}

BuiltSurface build_control_net(const Json& j, SceneBuilder& scene) {
    const ControlFrame frame{spline(j, scene, "c0"), spline(j, scene, "c1"), spline(j, scene, "d0"), spline(j, scene, "d1")};
    return fitted(frame, j, scene, [](const ControlFrame& f) { return BuiltSurface(make_control_net(f), net_of(coons_net(f))); });
}

BuiltSurface build_ruled(const Json& j, SceneBuilder& scene) {
    return make_ruled(curve(j, scene, "c0", "the curve x(u,0)"), curve(j, scene, "c1", "the curve x(u,1)"));
}

BuiltSurface build_cone(const Json& j, SceneBuilder& scene) {
    return make_cone(curve(j, scene, "curve", "the curve x(u,0)"), scene.values().point(j.at("apex", "the apex [x, y, z]")));
}

}  // namespace isoparm
