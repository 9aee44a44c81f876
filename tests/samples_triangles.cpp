// samples_triangles.cpp -- the types of surfaces on a triangle.
#include "samples_parts.h"

#include "curves/bezier.h"
#include "curves/modify.h"
#include "patches/bbg.h"
#include "patches/bezier_triangle.h"
#include "patches/nielson.h"
#include "patches/side_vertex.h"
#include "patches/three_curves.h"
#include "patches/transformed.h"
#include "scalar/elementary.h"

namespace isoparm::tests {
namespace {

PatchSample bezier_triangle(Random& r, int degree, bool rational) {
    std::vector<Point> points;
    std::vector<double> weights;
    std::vector<std::vector<Point>> p(degree + 1);
    std::vector<std::vector<double>> w(degree + 1);
    for (int k = 0; k <= degree; ++k)
        for (int j = 0; j <= degree - k; ++j) {
            const double u = double(degree - j - k) / degree, v = double(j) / degree;
            p[k].push_back(r.point({2 * u, 2 * v, u * v}, 0.3));
            w[k].push_back(rational ? r.number(0.5, 2) : 1);
            points.push_back(p[k][j]), weights.push_back(w[k][j]);
        }
    std::vector<Point> e[3];
    std::vector<double> x[3];
    for (int t = 0; t <= degree; ++t) {
        e[0].push_back(p[t][degree - t]), x[0].push_back(w[t][degree - t]);
        e[1].push_back(p[degree - t][0]), x[1].push_back(w[degree - t][0]);
        e[2].push_back(p[0][t]), x[2].push_back(w[0][t]);
    }
    PatchSample s{make_bezier_triangle(degree, points, rational ? weights : std::vector<double>{}), {}};
    for (int k = 0; k < 3; ++k) s.boundary.push_back(make_bezier(e[k], rational ? x[k] : std::vector<double>{}));
    return s;
}
PatchSample side_vertex(const std::array<Curve, 3>& e, const Function& h, SideVertexForm form) {
    return {make_side_vertex(e, h, form), {e[0], e[1], e[2]}};
}
template <SideVertexForm form> PatchSample side_vertex(Random& r, std::vector<double> h) {
    return side_vertex(random_triangle(r), Function::polynomial(std::move(h)), form);
}
constexpr auto kDelta = SideVertexForm::delta, kSeed = SideVertexForm::seed;

PatchSample side_vertex_part(Random& r, SideVertexForm form, SideVertexPart part, std::vector<int> free) {
    const auto e = random_triangle(r);
    return {make_side_vertex(e, Function::polynomial({0, 0, 1}), form, part), {e[0], e[1], e[2]}, std::move(free)};
}
PatchSample bbg_over(const std::array<Curve, 3>& e, const BbgForm& form) {
    std::vector<int> free;
    if (form.kind == BbgForm::Kind::projector) free = {form.i - 1};
    return {make_bbg(e, form), {e[0], e[1], e[2]}, free};
}
template <BbgForm::Kind kind, int i = 1, int j = 2> PatchSample bbg(Random& r) { return bbg_over(random_triangle(r), {kind, i, j}); }
PatchSample bbg_c1(const std::array<Curve, 3>& e, const std::array<Curve, 3>& d, int projector = 0) {
    return {make_bbg_c1(e, d, TrianglePart(projector)), {e[0], e[1], e[2]}, projector == 0 ? std::vector<int>{} : std::vector<int>{projector - 1}};
}
PatchSample nielson_c1(const std::array<Curve, 3>& e, const std::array<Curve, 3>& d, int ray = 0) {
    return {make_nielson_c1(e, d, TrianglePart(ray)), {e[0], e[1], e[2]}, ray == 0 ? std::vector<int>{} : std::vector<int>{ray % 3, (ray + 1) % 3}};
}
PatchSample with_cross(Random& r, PatchSample (*make)(const std::array<Curve, 3>&, const std::array<Curve, 3>&, int), int part = 0,
                       Curve (*between)(Random&, const Point&, const Point&) = random_cubic) {
    const auto e = random_triangle(r, between);
    return make(e, random_cross(r, e), part);
}
PatchSample nielson_g1(Random& r) {
    const auto e = random_triangle(r);
    return {make_nielson_g1(e, normals_of(e, random_cross(r, e, 0.2))), {e[0], e[1], e[2]}};
}
/// Edges that are no splines: sines, so that all runs on jets.
struct Wave {
    Point from, to, bend;
    double begin = 0, end = 1;
    template <class S> Vec3<S> operator()(const S& t) const {
        const S wave = sin(t * 3.0);
        const auto bump = t * (1.0 - t) * wave;
        const auto at = [&](int axis) -> S { return from[axis] + t * (to[axis] - from[axis]) + bump * bend[axis]; };
        return {at(0), at(1), at(2)};
    }
};
Curve wave(Random& r, const Point& from, const Point& to) { return make_curve(Wave{from, to, r.vector(2)}); }

/// A rational cubic with weights of 1/30 to 30 (1e3 would take a million triangles); a narrow bump beside the far end; a corner that no break tells of.
Curve heavy(Random& r, const Point& from, const Point& to) {
    return make_bezier({from, 0.7 * from + 0.3 * to + r.vector(0.5), 0.3 * from + 0.7 * to + r.vector(0.5), to}, {1, 30, 1 / 30.0, 1});
}
struct Bump {
    Point from, to;
    bool corner;
    double begin = 0, end = 1;
    template <class S> Vec3<S> operator()(const S& t) const {
        const S high = corner ? S(absolute(S(t - 0.9)) - 0.9 + t * 0.8) : S(t * (1.0 - t) * exp(S(-square(S((t - 0.9) * 50.0)))));
        return {S(from.x + t * (to.x - from.x)), S(from.y + t * (to.y - from.y)), S(from.z + t * (to.z - from.z) + high)};
    }
};
Curve bump(Random&, const Point& from, const Point& to) { return make_curve(Bump{from, to, false}); }
Curve corner(Random&, const Point& from, const Point& to) { return make_curve(Bump{from, to, true}); }
/// H = t from 0 on, with a kink or a switch there.
struct FromZero {
    bool larger_of;
    template <class S> S operator()(const S& t) const { return larger_of ? larger(S(0.0), t) : choose(Comparison::less_equal, t, S(0.0), S(0.0), t, true); }
};

const std::vector<double> kT{0, 1}, kT2{0, 0, 1}, kT3{0, 0, 0, 1}, kQuartic{0, 0, 0, 2, -1}, kSmooth{0, 0, 3, -2};

}  // namespace

const std::vector<PatchType>& triangle_types() {
    static const std::vector<PatchType> list{
        {"bezier_triangle", [](Random& r) { return bezier_triangle(r, 4, false); }},
        {"bezier_triangle_rational", [](Random& r) { return bezier_triangle(r, 3, true); }},
        {"side_vertex_t", [](Random& r) { return side_vertex<kDelta>(r, kT); }, true, false},
        {"side_vertex_t2", [](Random& r) { return side_vertex<kDelta>(r, kT2); }},
        {"side_vertex_quartic", [](Random& r) { return side_vertex<kDelta>(r, kQuartic); }},
        {"side_vertex_smooth", [](Random& r) { return side_vertex<kDelta>(r, kSmooth); }},
        {"side_vertex_t3", [](Random& r) { return side_vertex<kDelta>(r, kT3); }},
        {"side_vertex_max_0_t", [](Random& r) { return side_vertex(random_triangle(r), make_function(FromZero{true}), kDelta); }, true, false},
        {"side_vertex_if_t", [](Random& r) { return side_vertex(random_triangle(r), make_function(FromZero{false}), kDelta); }, true, false},
        {"side_vertex_rational",
         [](Random& r) { return side_vertex(random_triangle(r, rational_cubic), Function::polynomial(kT2), kDelta); }},
        {"side_vertex_seed_t", [](Random& r) { return side_vertex<kSeed>(r, kT); }, true, false},
        {"side_vertex_seed_t2", [](Random& r) { return side_vertex<kSeed>(r, kT2); }},
        {"side_vertex_seed_quartic", [](Random& r) { return side_vertex<kSeed>(r, kQuartic); }},
        {"side_vertex_seed_smooth", [](Random& r) { return side_vertex<kSeed>(r, kSmooth); }, false},
        {"side_vertex_seed_t3", [](Random& r) { return side_vertex<kSeed>(r, kT3); }, false},
        {"side_vertex_s1", [](Random& r) { return side_vertex_part(r, kDelta, SideVertexPart::s1, {0, 2}); }},
        {"side_vertex_s2", [](Random& r) { return side_vertex_part(r, kDelta, SideVertexPart::s2, {0, 1}); }},
        {"side_vertex_s3", [](Random& r) { return side_vertex_part(r, kDelta, SideVertexPart::s3, {1, 2}); }},
        {"side_vertex_s4", [](Random& r) { return side_vertex_part(r, kDelta, SideVertexPart::s4, {0, 1, 2}); }},
        {"three_curves", [](Random& r) { auto e = random_triangle(r); return PatchSample{make_three_curves(e), {e[0], e[1], e[2]}}; }},
        {"three_curves_rational", [](Random& r) { auto e = random_triangle(r, rational_cubic); return PatchSample{make_three_curves(e), {e[0], e[1], e[2]}}; }},
        {"bbg_P1", bbg<BbgForm::Kind::projector, 1>},
        {"bbg_P2", bbg<BbgForm::Kind::projector, 2>},
        {"bbg_P3", bbg<BbgForm::Kind::projector, 3>},
        {"bbg_convex", bbg<BbgForm::Kind::convex>},
        {"bbg_convex_rational", [](Random& r) { return bbg_over(random_triangle(r, rational_cubic), {BbgForm::Kind::convex}); }},
        {"bbg_boolean", bbg<BbgForm::Kind::boolean>},
        {"bbg_boolean_31", bbg<BbgForm::Kind::boolean, 3, 1>},
        {"bbg_boolean_32_splines", [](Random& r) { return bbg_over(random_triangle(r, cubic_spline), {BbgForm::Kind::boolean, 3, 2}); }},
        {"bbg_symmetric", bbg<BbgForm::Kind::symmetric>},
        {"bbg_symmetric_waves", [](Random& r) { return bbg_over(random_triangle(r, wave), {BbgForm::Kind::symmetric}); }},
        {"bbg_symmetric_heavy", [](Random& r) { return bbg_over(random_triangle(r, heavy), {BbgForm::Kind::symmetric}); }},
        {"bbg_symmetric_bump", [](Random& r) { return bbg_over(random_triangle(r, bump), {BbgForm::Kind::symmetric}); }},
        {"bbg_symmetric_corner", [](Random& r) { return bbg_over(random_triangle(r, corner), {BbgForm::Kind::symmetric}); }},
        {"bbg_c1", [](Random& r) { return with_cross(r, bbg_c1); }},
        {"bbg_c1_P1", [](Random& r) { return with_cross(r, bbg_c1, 1); }},
        {"bbg_c1_P3", [](Random& r) { return with_cross(r, bbg_c1, 3); }},
        {"bbg_c1_rational", [](Random& r) { return with_cross(r, bbg_c1, 0, rational_cubic); }},
        {"nielson_c1", [](Random& r) { return with_cross(r, nielson_c1); }, true, true, false},
        {"nielson_c1_T1", [](Random& r) { return with_cross(r, nielson_c1, 1); }},
        {"nielson_c1_T2", [](Random& r) { return with_cross(r, nielson_c1, 2); }},
        {"nielson_c1_rational", [](Random& r) { return with_cross(r, nielson_c1, 0, rational_cubic); }, true, true, false},
        {"nielson_g1", nielson_g1, true, false},
        {"transformed_triangle",
         [](Random& r) {
             Random h = r.here();
             PatchSample s = side_vertex<kDelta>(h, kT2);
             const Transform map = random_map(r);
             for (auto& c : s.boundary) c = transformed(c, map);
             return PatchSample{transformed(s.patch, map), s.boundary};
         }},
    };
    return list;
}

}  // namespace isoparm::tests
