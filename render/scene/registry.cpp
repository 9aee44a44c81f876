#include "scene/registry.h"

#include "patches/cone.h"
#include "patches/ruled.h"

namespace isoparm {

std::span<const SceneType<BuiltCurve>> curve_types() {
    static const std::vector<SceneType<BuiltCurve>> types{
        {"line", {"points"}, build_line},
        {"bezier", {"points", "weights"}, build_bezier_curve},
        {"bspline", {"degree", "knots", "points", "weights"}, build_bspline_curve},
        {"hermite", {"points", "tangents"}, build_hermite_curve},
        {"interpolate", {"points", "ends"}, build_interpolating_curve},
        {"arc", {"center", "start", "end"}, build_arc},
        {"formula", {"xyz", "domain"}, build_formula_curve},
        {"isocurve", {"surface", "u", "v"}, build_isocurve},
        {"file", {"path", "index"}, build_file_curve},
        {"reverse", {"curve"}, build_reverse},
        {"segment", {"curve", "interval"}, build_segment},
        {"transform", {"curve", "matrix", "mirror", "scale", "rotate", "translate"}, build_transformed_curve},
    };
    return types;
}

std::span<const SceneType<BuiltSurface>> surface_types() {
    static const std::vector<SceneType<BuiltSurface>> types{
        {"bezier", {"points", "weights"}, build_bezier_patch},
        {"bspline", {"degree", "knots", "points", "weights"}, build_bspline_patch},
        {"bilinear", {"points"}, build_bilinear},
        {"coons", {"c0", "c1", "d0", "d1", "loop", "blend", "part", "repair"}, build_coons},
        {"coons_hermite", {"f", "g", "twist", "part", "repair"}, build_coons_hermite},
        {"hermite", {"points", "du", "dv", "duv"}, build_hermite_patch},
        {"gordon", {"u_curves", "v_nodes", "v_curves", "u_nodes", "blend", "part", "repair", "tolerance"}, build_gordon},
        {"lagrange", {"curves", "nodes"}, build_lagrange},
        {"generalized_coons", {"u", "v", "f", "g", "part"}, build_generalized_coons},
        {"translational", {"c", "d", "repair"}, build_translational},
        {"translational_blend", {"c0", "c1", "d0", "d1", "repair"}, build_translational_blend},
        {"control_net", {"c0", "c1", "d0", "d1", "repair"}, build_control_net},
        {"ruled", {"c0", "c1"}, [](const Json& j, SceneBuilder& s) -> BuiltSurface {
             return make_ruled(s.curve(j, "c0", "the curve x(u,0)"), s.curve(j, "c1", "the curve x(u,1)"));
         }},
        {"cone", {"curve", "apex"}, [](const Json& j, SceneBuilder& s) -> BuiltSurface {
             return make_cone(s.curve(j, "curve", "the curve x(u,0)"), s.values().point(j.at("apex", "the apex [x, y, z]")));
         }},
        {"network", {"a", "b", "cross", "twist", "part", "repair"}, build_network},
        {"triangle", {"points"}, build_triangle},
        {"bezier_triangle", {"degree", "points", "weights"}, build_bezier_triangle},
        {"coons_triangle", {"edges", "loop", "method", "H", "form", "projectors", "cross", "normals", "part", "repair"}, build_coons_triangle},
        {"composite", {"members"}, build_composite},
        {"transform", {"surface", "matrix", "mirror", "scale", "rotate", "translate"}, build_transformed_surface},
        {"file", {"path"}, build_file},
        {"subdivision", {"scheme", "cage", "boundary", "vertices", "faces", "creases", "corners"}, build_subdivision},
    };
    return types;
}

}  // namespace isoparm
