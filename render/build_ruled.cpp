// build_ruled.cpp -- surfaces that a scene file gives by curves to move: ruled, cone, translational, discrete Coons nets.
#include "patches/control_net.h"
#include "patches/ruled.h"
#include "patches/translational.h"
#include "registry.h"

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

BuiltSurface build_translational_blend(const Json& j, SceneBuilder& scene) { return make_translational_blend(frame_of(j, scene)); }

BuiltSurface build_translational(const Json& j, SceneBuilder& scene) {
    return make_translational(curve(j, scene, "c", "the curve along u"), curve(j, scene, "d", "the curve along v"));
}

BuiltSurface build_control_net(const Json& j, SceneBuilder& scene) {
    const ControlFrame frame{spline(j, scene, "c0"), spline(j, scene, "c1"), spline(j, scene, "d0"), spline(j, scene, "d1")};
    return {make_control_net(frame), net_of(coons_net(frame))};
}

BuiltSurface build_ruled(const Json& j, SceneBuilder& scene) {
    return make_ruled(curve(j, scene, "c0", "the curve x(u,0)"), curve(j, scene, "c1", "the curve x(u,1)"));
}

BuiltSurface build_cone(const Json& j, SceneBuilder& scene) {
    return make_cone(curve(j, scene, "curve", "the curve x(u,0)"), scene.values().point(j.at("apex", "the apex [x, y, z]")));
}

}  // namespace isoparm
