#include "registry.h"

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
        {"coons", {"c0", "c1", "d0", "d1", "blend", "part"}, build_coons},
        {"coons_hermite", {"f", "g", "twist", "part"}, build_coons_hermite},
        {"network", {"a", "b", "cross", "twist", "part"}, build_network},
        {"triangle", {"points"}, build_triangle},
        {"bezier_triangle", {"degree", "points", "weights"}, build_bezier_triangle},
        {"coons_triangle", {"edges", "method", "H", "form", "projectors", "cross", "normals", "part"}, build_coons_triangle},
        {"composite", {"members"}, build_composite},
        {"transform", {"surface", "matrix", "mirror", "scale", "rotate", "translate"}, build_transformed_surface},
        {"file", {"path"}, build_file},
        {"hermite", {}, nullptr},
        {"gordon", {}, nullptr},
        {"lagrange", {}, nullptr},
        {"generalized_coons", {}, nullptr},
        {"translational", {}, nullptr},
        {"translational_blend", {}, nullptr},
        {"control_net", {}, nullptr},
        {"ruled", {}, nullptr},
        {"cone", {}, nullptr},
        {"subdivision", {}, nullptr},
    };
    return types;
}

}  // namespace isoparm
