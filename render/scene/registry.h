// registry.h -- every `type` of a scene file: its keys and what builds it.
#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "patches/coons.h"
#include "scene/scene_builder.h"

namespace isoparm {

template <class Built> struct SceneType {
    const char* name;
    std::vector<std::string> keys;  // besides "type"
    Built (*build)(const Json& definition, SceneBuilder& scene);
};
std::span<const SceneType<BuiltCurve>> curve_types();
std::span<const SceneType<BuiltSurface>> surface_types();

// build_curves.cpp
BuiltCurve build_line(const Json&, SceneBuilder&);
BuiltCurve build_bezier_curve(const Json&, SceneBuilder&);
BuiltCurve build_bspline_curve(const Json&, SceneBuilder&);
BuiltCurve build_hermite_curve(const Json&, SceneBuilder&);
BuiltCurve build_interpolating_curve(const Json&, SceneBuilder&);
BuiltCurve build_arc(const Json&, SceneBuilder&);
BuiltCurve build_formula_curve(const Json&, SceneBuilder&);
BuiltCurve build_isocurve(const Json&, SceneBuilder&);
BuiltCurve build_file_curve(const Json&, SceneBuilder&);
BuiltCurve build_reverse(const Json&, SceneBuilder&);
BuiltCurve build_segment(const Json&, SceneBuilder&);
BuiltCurve build_transformed_curve(const Json&, SceneBuilder&);

// build_surfaces.cpp: of points
BuiltSurface build_bezier_patch(const Json&, SceneBuilder&);
BuiltSurface build_bspline_patch(const Json&, SceneBuilder&);
BuiltSurface build_hermite_patch(const Json&, SceneBuilder&);
BuiltSurface build_bilinear(const Json&, SceneBuilder&);
BuiltSurface build_triangle(const Json&, SceneBuilder&);
BuiltSurface build_bezier_triangle(const Json&, SceneBuilder&);

ControlNet net_of(const Grid<Point>& points);

// build_coons.cpp: of curves to interpolate
BuiltSurface build_gordon(const Json&, SceneBuilder&);
BuiltSurface build_lagrange(const Json&, SceneBuilder&);
BuiltSurface build_generalized_coons(const Json&, SceneBuilder&);
BuiltSurface build_coons(const Json&, SceneBuilder&);
BuiltSurface build_coons_hermite(const Json&, SceneBuilder&);
BuiltSurface build_network(const Json&, SceneBuilder&);

// build_triangles.cpp: of three edges
BuiltSurface build_coons_triangle(const Json&, SceneBuilder&);
/// Every method of coons_triangle, with its keys besides type and method.
std::map<std::string, std::vector<std::string>> triangle_methods();

/// The keys c0, c1, d0, d1.
CoonsCurves frame_of(const Json&, SceneBuilder&);

// build_subdivision.cpp
BuiltSurface build_subdivision(const Json&, SceneBuilder&);

// build_translational.cpp: of curves to move
BuiltSurface build_translational(const Json&, SceneBuilder&);
BuiltSurface build_translational_blend(const Json&, SceneBuilder&);
BuiltSurface build_control_net(const Json&, SceneBuilder&);

// build_composites.cpp: of surfaces
BuiltSurface build_composite(const Json&, SceneBuilder&);
BuiltSurface build_transformed_surface(const Json&, SceneBuilder&);
BuiltSurface build_file(const Json&, SceneBuilder&);

}  // namespace isoparm
