// build_curves.cpp -- curves from their definitions in a scene file.
#include "curves/arc.h"
#include "curves/bezier.h"
#include "curves/bspline.h"
#include "curves/hermite.h"
#include "curves/interpolate.h"
#include "curves/isocurve.h"
#include "curves/line.h"
#include "curves/modify.h"
#include "curves/piecewise_bezier.h"
#include "scene/registry.h"

namespace isoparm {

namespace {
ControlNet polygon(const std::vector<Point>& points) {
    ControlNet net{points, {}, {}};
    for (int k = 0; k + 1 < static_cast<int>(points.size()); ++k) net.rods.push_back({k, k + 1});
    for (std::size_t k = 0; k < points.size(); ++k) net.indices.push_back(std::to_string(k));
    return net;
}
Json points_of(const Json& j) { return j.at("points", "the points of the curve"); }
std::vector<double> weights_of(const Json& j, const SceneValues& values, std::size_t count) {
    const auto weights = j.find("weights");
    return weights ? values.weights(*weights, count) : std::vector<double>{};
}
BuiltCurve with_spline(BuiltCurve c, int degree, std::vector<double> knots, bool rational) {
    if (!rational) c.spline = SplineCurve{degree, std::move(knots), c.net.points};
    return c;
}
std::vector<double> bezier_knots(int degree) {
    std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
    knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, 1.0);
    return knots;
}
}  // namespace

BuiltCurve build_line(const Json& j, SceneBuilder& scene) {
    const auto p = scene.values().points(points_of(j), 2, 2);
    return with_spline({make_line(p[0], p[1]), polygon(p)}, 1, bezier_knots(1), false);
}

BuiltCurve build_bezier_curve(const Json& j, SceneBuilder& scene) {
    const auto p = scene.values().points(points_of(j), 2, max_degree + 1);
    const auto w = weights_of(j, scene.values(), p.size());
    const int degree = static_cast<int>(p.size()) - 1;
    return with_spline({make_bezier(p, w), polygon(p)}, degree, bezier_knots(degree), !w.empty());
}

BuiltCurve build_bspline_curve(const Json& j, SceneBuilder& scene) {
    const SceneValues& values = scene.values();
    const int degree = values.integer(j.at("degree", "the degree"), 1, max_degree, "the degree");
    const auto p = values.points(points_of(j), static_cast<std::size_t>(degree) + 1);
    const auto knots = values.knots(j.at("knots", "the knots"), degree, p.size());
    const auto w = weights_of(j, values, p.size());
    return with_spline({make_bspline(degree, knots, p, w), polygon(p)}, degree, knots, !w.empty());
}

BuiltCurve build_hermite_curve(const Json& j, SceneBuilder& scene) {
    const auto p = scene.values().points(points_of(j), 2);
    return make_hermite(p, scene.values().points(j.at("tangents", "a tangent for every point"), p.size(), p.size()));
}

BuiltCurve build_interpolating_curve(const Json& j, SceneBuilder& scene) {
    static constexpr SplineEnds ends[] = {SplineEnds::natural, SplineEnds::clamped, SplineEnds::catmull_rom};
    const auto p = scene.values().points(points_of(j), 2);
    const auto chosen = j.find("ends");
    const std::size_t k = chosen ? scene.values().word(*chosen, {"natural", "clamped", "catmull_rom"}) : 0;
    return make_interpolate(p, ends[k]);
}

BuiltCurve build_arc(const Json& j, SceneBuilder& scene) {
    const SceneValues& values = scene.values();
    return make_arc(values.point(j.at("center", "the centre [x, y, z]")), values.point(j.at("start", "the start [x, y, z]")),
                    values.point(j.at("end", "the end [x, y, z]")));
}

BuiltCurve build_formula_curve(const Json& j, SceneBuilder& scene) {
    const SceneValues& values = scene.values();
    const auto xyz = values.list(j.at("xyz", "three formulas in t"), 3, 3, "formulas in t");
    const auto domain = values.interval(j.at("domain", "the domain [from, to] of t"));
    return make_formula_curve({values.formula(xyz[0]), values.formula(xyz[1]), values.formula(xyz[2])}, domain[0], domain[1]);
}

BuiltCurve build_isocurve(const Json& j, SceneBuilder& scene) {
    const Json surface = j.at("surface", "the surface that the curve lies on");
    const auto u = j.find("u"), v = j.find("v");
    if (u && v) u->fail_at_key("found both \"u\" and \"v\", expected the one that is constant along the curve");
    if (!u && !v) j.fail("found neither \"u\" nor \"v\", expected the one that is constant along the curve");
    const Patch patch = scene.patch(surface);
    return u ? make_isocurve(patch, Along::v, scene.values().number(*u)) : make_isocurve(patch, Along::u, scene.values().number(*v));
}

BuiltCurve build_file_curve(const Json& j, SceneBuilder& scene) {
    const auto all = scene.curves_of_file(j);
    const auto index = j.find("index");
    if (!index && all.size() != 1) j.fail("found a file of " + std::to_string(all.size()) + " curves and no \"index\", expected which of them, counted from 0");
    const std::size_t k = index ? std::size_t(scene.values().integer(*index, 0, int(all.size()) - 1, "the index of a curve of the file")) : 0;
    if (!all[k].curve) (index ? *index : j).expected("a curve that can be used; this one is " + all[k].unusable);
    return {*all[k].curve, all[k].points.empty() ? ControlNet{} : polygon(all[k].points)};
}

BuiltCurve build_reverse(const Json& j, SceneBuilder& scene) {
    const BuiltCurve c = scene.curve(j.at("curve", "the curve to reverse"));
    return {reversed(c.curve), c.net};
}

BuiltCurve build_segment(const Json& j, SceneBuilder& scene) {
    const Curve c = scene.curve(j.at("curve", "the curve to cut")).curve;
    const Json where = j.at("interval", "the part [from, to] to keep");
    const auto part = scene.values().interval(where);
    if (part[0] < c.begin() || part[1] > c.end()) {
        where.fail("found the interval [" + to_text(part[0]) + ", " + to_text(part[1]) + "], expected a part of the curve's domain [" +
                   to_text(c.begin()) + ", " + to_text(c.end()) + "]");
    }
    return segment(c, part[0], part[1]);
}

BuiltCurve build_transformed_curve(const Json& j, SceneBuilder& scene) {
    BuiltCurve c = scene.curve(j.at("curve", "the curve to move"));
    const Transform m = scene.values().transform(j);
    for (Point& p : c.net.points) p = m.point(p);
    return {transformed(c.curve, m), c.net};
}

}  // namespace isoparm
