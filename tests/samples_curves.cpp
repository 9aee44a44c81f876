// samples_curves.cpp -- the types of curves.
#include "samples_parts.h"

#include "curves/arc.h"
#include "curves/bezier.h"
#include "curves/bspline.h"
#include "curves/hermite.h"
#include "curves/interpolate.h"
#include "curves/isocurve.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "patches/tensor_bezier.h"
#include "scalar/elementary.h"

namespace isoparm::tests {
namespace {

Curve isocurve_of_spline(Random& r) {
    return make_isocurve(
        make_bspline_patch(3, 2, {0, 0, 0, 0, 0.4, 1, 1, 1, 1}, {0, 0, 0, 1, 2, 2, 2}, random_net(r, 5, 4)), Along::u,
        0.7);
}
Curve arc(Random& r, double degrees) {
    const Point center = r.point(), a = r.vector() + Point{2, 0, 0};
    const Transform turn = Transform::rotate(cross(a, r.vector() + Point{0, 3, 0}), degrees);
    return make_arc(center, center + a, center + turn.vector(a));
}
/// A helix: not a spline, so it runs on jets and models only.
struct Helix {
    Point center;
    double begin = -1, end = 2.5;
    template <class S> Vec3<S> operator()(const S& t) const {
        return {cos(t) + center.x, sin(t) + center.y, S(exp(t * 0.3)) + center.z};
    }
};

}  // namespace

Curve nurbs(Random& r) {
    return make_bspline(3, {0, 0, 0, 0, 0.2, 0.5, 0.5, 1.1, 1.1, 1.1, 2, 2, 2, 2}, random_points(r, 10),
                        random_weights(r, 10));
}
Curve cubic_spline(Random& r, const Point& from, const Point& to) {
    return make_interpolate({from, 0.6 * from + 0.4 * to + r.vector(0.3), 0.3 * from + 0.7 * to + r.vector(0.3), to},
                            SplineEnds::natural);
}
Curve rational_cubic(Random& r, const Point& from, const Point& to) {
    return make_bezier({from, 0.7 * from + 0.3 * to + r.vector(0.5), 0.3 * from + 0.7 * to + r.vector(0.5), to},
                       random_weights(r, 4));
}

const std::vector<CurveType>& curve_types() {
    static const std::vector<CurveType> list{
        {"line", [](Random& r) { return make_line(r.point(), r.point()); }},
        {"bezier", [](Random& r) { return make_bezier(random_points(r, 6)); }},
        {"bezier_point", [](Random& r) { return make_bezier({r.point()}); }},
        {"bezier_degree_12", [](Random& r) { return make_bezier(random_points(r, 13)); }},
        {"bezier_rational", [](Random& r) { return make_bezier(random_points(r, 5), random_weights(r, 5)); }},
        {"bspline",
         [](Random& r) {
             return make_bspline(3, {0, 0, 0, 0, 0.3, 1, 1.7, 2, 2, 2, 2}, random_points(r, 7));
         }},
        {"bspline_multiple_knots",
         [](Random& r) {
             return make_bspline(3, {0, 0, 0, 0, 1, 1, 2, 2, 2, 3, 3, 3, 3}, random_points(r, 9));
         }},
        {"bspline_unclamped",
         [](Random& r) {
             return make_bspline(2, {0, 0.5, 1, 1.7, 3, 4, 4.5}, random_points(r, 4));
         }},
        {"nurbs", nurbs},
        {"hermite",
         [](Random& r) {
             return make_hermite(random_points(r, 4), {r.vector(), r.vector(), r.vector(), r.vector()});
         }},
        {"interpolate_natural", [](Random& r) { return make_interpolate(random_points(r, 6), SplineEnds::natural); }},
        {"interpolate_clamped", [](Random& r) { return make_interpolate(random_points(r, 5), SplineEnds::clamped); }},
        {"interpolate_catmull_rom",
         [](Random& r) { return make_interpolate(random_points(r, 5), SplineEnds::catmull_rom); }},
        {"arc_short", [](Random& r) { return arc(r, 47); }},
        {"arc_long", [](Random& r) { return arc(r, 165); }},
        {"formula", [](Random& r) { return make_curve(Helix{r.point()}); }},
        {"isocurve", [](Random& r) { return make_isocurve(bezier_patch(r).patch, Along::v, 0.3); }},
        {"isocurve_of_spline", isocurve_of_spline},
        {"isocurve_with_a_corner", [](Random& r) { return make_isocurve(nurbs_patch(r).patch, Along::u, 3.5); }},
        {"reversed", [](Random& r) { return reversed(nurbs(r)); }},
        {"reversed_formula", [](Random& r) { return reversed(make_curve(Helix{r.point()})); }},
        {"reversed_isocurve", [](Random& r) { return reversed(isocurve_of_spline(r)); }},
        {"segment", [](Random& r) { return segment(nurbs(r), 0.3, 1.6); }},
        {"segment_same_parameter", [](Random& r) { return segment(nurbs(r), 0.3, 1.6, false); }},
        {"segment_formula", [](Random& r) { return segment(make_curve(Helix{r.point()}), -0.5, 1.25); }},
        {"segment_isocurve", [](Random& r) { return segment(isocurve_of_spline(r), 0.1, 0.9); }},
        {"transformed",
         [](Random& r) {
             Random h = r.here();
             const Curve c = nurbs(h);
             return transformed(c, random_map(r));
         }},
        {"transformed_formula",
         [](Random& r) {
             Random h = r.here();
             const Curve c = make_curve(Helix{h.point()});
             return transformed(c, random_map(r));
         }},
        {"reparametrized", [](Random& r) { return reparametrized(nurbs(r), -1, 4); }},
        {"reparametrized_formula", [](Random& r) { return reparametrized(make_curve(Helix{r.point()}), 0, 1); }},
        {"combination",
         [](Random& r) {
             const Curve a = make_interpolate(random_points(r, 4), SplineEnds::natural),
                         b = make_bezier(random_points(r, 5)),
                         c = make_hermite(random_points(r, 3), {r.vector(), r.vector(), r.vector()});
             return linear_combination({-0.5, 2, -0.5}, {a, reparametrized(b, 0, 3), reparametrized(c, 0, 3)});
         }},
        {"combination_rational",
         [](Random& r) {
             const Curve a = nurbs(r), b = make_bezier(random_points(r, 5));
             return linear_combination({0.25, 0.75}, {a, reparametrized(b, 0, 2)});
         }},
    };
    return list;
}

}  // namespace isoparm::tests
