#include "promises.h"

#include "curves/modify.h"
#include "error.h"
#include "patches/compatibility.h"
#include "patches/nielson.h"
#include "patches/triangle_edges.h"

namespace isoparm {
namespace {

Condition condition(const std::string& what, const Point& a, const Point& b, double size, const char* remedy = "") {
    return {what, distance(a, b), compatibility_tolerance * size + rounding_of(a, b), remedy};
}

const char* name_of(Twist twist) { return twist == Twist::gregory ? "gregory" : twist == Twist::average ? "average" : twist == Twist::zero ? "zero" : ""; }

/// The edges of the unit square, or of a rectangle: lines u = const and v = const.
ParameterLine line_u(double u, const Rect& r) { return {{u, r.v0}, {u, r.v1}, {1, 0}}; }
ParameterLine line_v(double v, const Rect& r) { return {{r.u0, v}, {r.u1, v}, {0, 1}}; }

/// Keeps the condition with the largest gap, relative to what it may be.
void keep_worst(std::optional<Condition>& worst, const Condition& c) {
    if (!worst || c.gap * worst->tolerance > worst->gap * c.tolerance) worst = c;
}
std::string numbered(const char* name, std::size_t k) { return std::string(name) + "[" + std::to_string(k) + "]"; }

TwistPair pair_of(const Condition& c, const Point& at, const Point& of_f, const Point& of_g) { return {at, of_f, of_g, c.gap, c.tolerance, c.remedy}; }

bool has_corner(const std::vector<Curve>& curves) {
    for (const Curve& c : curves)
        for (const Break& b : c.breaks())
            if (b.continuity < 1) return true;
    return false;
}

}  // namespace

DataReport examine(const CoonsCurves& given) {
    const Curve c0 = reparametrized(given.c0, 0, 1), c1 = reparametrized(given.c1, 0, 1), d0 = reparametrized(given.d0, 0, 1), d1 = reparametrized(given.d1, 0, 1);
    const double size = size_of({&c0, &c1, &d0, &d1});
    const Rect unit;
    return {{condition("positions at (0,0): c0(0) = d0(0)", c0(0), d0(0), size), condition("positions at (1,0): c0(1) = d1(0)", c0(1), d1(0), size),
             condition("positions at (0,1): c1(0) = d0(1)", c1(0), d0(1), size), condition("positions at (1,1): c1(1) = d1(1)", c1(1), d1(1), size)},
            {{"c0 is interpolated", line_v(0, unit), c0, 0, 0}, {"c1 is interpolated", line_v(1, unit), c1, 0, 0}, {"d0 is interpolated", line_u(0, unit), d0, 0, 0}, {"d1 is interpolated", line_u(1, unit), d1, 0, 0}},
            {}};
}

DataReport examine(const HermiteData& data, Twist twist) {
    static constexpr int value[2] = {0, 3}, slope[2] = {1, 2};
    std::array<Curve, 4> f = data.f, g = data.g;
    for (auto* list : {&f, &g})
        for (Curve& c : *list) c = reparametrized(c, 0, 1);
    const double size = size_of({&f[0], &f[3], &g[0], &g[3]});
    DataReport r;
    const auto name = [](const char* family, int k) { return numbered(family, std::size_t(k)); };
    for (const int i : {0, 1})
        for (const int j : {0, 1}) {
            const int v = value[i], w = value[j], s = slope[i], t = slope[j];
            const std::string at = " at (" + std::to_string(i) + "," + std::to_string(j) + "): ", of_f = "(" + std::to_string(j) + ")", of_g = "(" + std::to_string(i) + ")";
            r.conditions.push_back(condition("positions" + at + name("f", v) + of_f + " = " + name("g", w) + of_g, f[v](j), g[w](i), size));
            const Point fu = g[w].derivative(i), fv = f[v].derivative(j);
            r.conditions.push_back(condition("tangents" + at + name("f", s) + of_f + " = " + name("g", w) + "'" + of_g, f[s](j), fu, size + length(fu)));
            r.conditions.push_back(condition("tangents" + at + name("g", t) + of_g + " = " + name("f", v) + "'" + of_f, g[t](i), fv, size + length(fv)));
            const Point a = f[s].derivative(j), b = g[t].derivative(i);
            r.conditions.push_back(condition("twists" + at + name("f", s) + "'" + of_f + " = " + name("g", t) + "'" + of_g, a, b, size + length(fu) + length(fv) + length(a), name_of(twist)));
            r.twists.push_back(pair_of(r.conditions.back(), f[v](j), a, b));
        }
    const Rect unit;
    std::optional<Patch> along_u, along_v;
    double slack_u = 0, slack_v = 0;
    if (twist == Twist::gregory) along_u = gregory_on_edges(data, true, slack_u), along_v = gregory_on_edges(data, false, slack_v);
    for (const int i : {0, 1}) {
        r.promises.push_back({name("f", value[i]) + " is interpolated", line_u(i, unit), f[value[i]], 0, 0, 0, along_u, slack_u});
        r.promises.push_back({name("g", value[i]) + " is interpolated", line_v(i, unit), g[value[i]], 0, 0, 0, along_v, slack_v});
        if (twist != Twist::compatible && twist != Twist::gregory) continue;  // the others give up cross derivatives near incompatible corners
        r.promises.push_back({name("f", slope[i]) + " is the cross derivative", line_u(i, unit), f[slope[i]], 1, 0, 0, along_u, slack_u});
        r.promises.push_back({name("g", slope[i]) + " is the cross derivative", line_v(i, unit), g[slope[i]], 1, 0, 0, along_v, slack_v});
    }
    return r;
}

DataReport examine(const Network& given, const CrossDerivatives* given_cross, Twist twist) {
    const double m = double(given.a.size() - 1), n = double(given.b.size() - 1);
    CrossDerivatives cross = given_cross ? *given_cross : finite_differences(given);
    std::vector<Curve> a, b;
    for (const Curve& c : given.a) a.push_back(reparametrized(c, 0, n));
    for (const Curve& c : given.b) b.push_back(reparametrized(c, 0, m));
    for (Curve& c : cross.A) c = reparametrized(c, 0, n);
    for (Curve& c : cross.B) c = reparametrized(c, 0, m);
    const double size = std::max(size_of({&a.front(), &a.back()}), size_of({&b.front(), &b.back()}));
    std::optional<Condition> crossing, tangent, twists;
    std::vector<TwistPair> pairs;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j) {
            const double u = double(i), v = double(j);
            const std::string of_u = "(" + std::to_string(i) + ")", of_v = "(" + std::to_string(j) + ")";
            keep_worst(crossing, condition("positions, worst of all: " + numbered("a", i) + of_v + " = " + numbered("b", j) + of_u, a[i](v), b[j](u), size));
            const Point au = b[j].derivative(u), av = a[i].derivative(v), p = cross.A[i].derivative(v), q = cross.B[j].derivative(u);
            const char* differences = given_cross ? "" : "finite differences instead of the curves' own tangents";
            keep_worst(tangent, condition("tangents, worst of all: " + numbered("A", i) + of_v + " = " + numbered("b", j) + "'" + of_u, cross.A[i](v), au, size + length(au), differences));
            keep_worst(tangent, condition("tangents, worst of all: " + numbered("B", j) + of_u + " = " + numbered("a", i) + "'" + of_v, cross.B[j](u), av, size + length(av), differences));
            const Condition of_twist = condition("twists, worst of all: " + numbered("A", i) + "'" + of_v + " = " + numbered("B", j) + "'" + of_u, p, q, size + length(au) + length(av) + length(p), name_of(twist));
            keep_worst(twists, of_twist);
            pairs.push_back(pair_of(of_twist, a[i](v), p, q));
        }
    DataReport r{{*crossing, *tangent, *twists}, {}, {}, std::move(pairs)};
    if (!has_corner(a) && !has_corner(b)) r.smooth.push_back(0);
    const Rect over{0, m, 0, n};
    for (std::size_t i = 0; i < a.size(); ++i) r.promises.push_back({numbered("a", i) + " is interpolated", line_u(double(i), over), a[i], 0, 0});
    for (std::size_t j = 0; j < b.size(); ++j) r.promises.push_back({numbered("b", j) + " is interpolated", line_v(double(j), over), b[j], 0, 0});
    return r;
}

DataReport examine(const GordonNetwork& given, GordonBlend blend, const Rect& domain) {
    auto u = run_over_nodes(given.u_curves, given.u_nodes), v = run_over_nodes(given.v_curves, given.v_nodes);
    std::optional<Condition> crossing;
    double size = 0;
    for (const auto* list : {&u, &v})
        for (const Curve& c : *list) size = std::max(size, size_of({&c}));
    for (std::size_t i = 0; i < v.size(); ++i)
        for (std::size_t j = 0; j < u.size(); ++j)
            keep_worst(crossing, condition("positions, worst of all: " + numbered("u_curves", j) + "(" + to_text(given.u_nodes[i]) + ") = " + numbered("v_curves", i) + "(" + to_text(given.v_nodes[j]) + ")",
                                           u[j](given.u_nodes[i]), v[i](given.v_nodes[j]), size));
    if (given.tolerance > 0 && crossing->gap <= given.tolerance) crossing->remedy = "tolerance: the surface passes midway";
    DataReport r{{*crossing}, {}, {}};
    if (blend == GordonBlend::hermite && !has_corner(u) && !has_corner(v)) r.smooth.push_back(0);
    const auto cut = [](const Curve& c, double from, double to) { return c.begin() < from || c.end() > to ? segment(c, from, to, false) : c; };
    for (std::size_t j = 0; j < u.size(); ++j) r.promises.push_back({numbered("u_curves", j) + " is interpolated", line_v(given.v_nodes[j], domain), cut(u[j], domain.u0, domain.u1), 0, 0});
    for (std::size_t i = 0; i < v.size(); ++i) r.promises.push_back({numbered("v_curves", i) + " is interpolated", line_u(given.u_nodes[i], domain), cut(v[i], domain.v0, domain.v1), 0, 0});
    for (Promise& p : r.promises) p.allowed = given.tolerance;
    return r;
}

DataReport examine_triangle(const std::array<Curve, 3>& edges) {
    const TriangleEdges t(edges);
    const ParameterLine lines[] = {{{0, 1}, {0, 0}, {1, -0.5}}, {{0, 0}, {1, 0}, {-0.5, 1}}, {{1, 0}, {0, 1}, {-0.5, -0.5}}};
    DataReport r{{condition("positions at A: E2(1) = E3(0)", t.E[1](1), t.E[2](0), t.size), condition("positions at B: E3(1) = E1(0)", t.E[2](1), t.E[0](0), t.size),
                  condition("positions at C: E1(1) = E2(0)", t.E[0](1), t.E[1](0), t.size)},
                 {},
                 {}};
    for (std::size_t k = 0; k < 3; ++k) r.promises.push_back({"E" + std::to_string(k + 1) + " is interpolated", lines[k], t.E[k], 0, 0});
    return r;
}

DataReport examine_triangle(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& cross) {
    DataReport r = examine_triangle(edges);
    const TriangleEdges t(edges);
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;  // E_k runs from vertex i to vertex j
        const Curve D = reparametrized(cross[k], 0, 1);
        const std::string d = "D" + std::to_string(k + 1), e = "E" + std::to_string(k + 1), vertex = "ABC";
        const Point first = -1.0 * t.E[j].derivative(1) - 0.5 * t.E[k].derivative(0), last = t.E[i].derivative(0) + 0.5 * t.E[k].derivative(1);
        r.conditions.push_back(condition("tangents at " + vertex.substr(i, 1) + ": " + d + "(0) = -E" + std::to_string(j + 1) + "'(1) - " + e + "'(0)/2", D(0), first, t.size + length(first)));
        r.conditions.push_back(condition("tangents at " + vertex.substr(j, 1) + ": " + d + "(1) = E" + std::to_string(i + 1) + "'(0) + " + e + "'(1)/2", D(1), last, t.size + length(last)));
        Promise p = r.promises[k];
        r.promises.push_back({d + " is the cross derivative", p.line, D, 1, 0});
    }
    return r;
}

DataReport examine_nielson(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& cross) {
    DataReport r = examine_triangle(edges, cross);
    for (std::size_t k = 0; k < 6; ++k) r.promises[k].on_edge = make_nielson_c1(edges, cross, TrianglePart(k % 3 + 1));
    return r;
}

DataReport examine_nielson_g1(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& normals) {
    DataReport r = examine_triangle(edges);
    const TriangleEdges t(edges);
    std::array<Curve, 3> N = normals;
    for (Curve& n : N) n = reparametrized(n, 0, 1);
    const auto sine = [](const Point& a, const Point& b) { return length(b) == 0 ? 0 : length(cross(normalized(a), normalized(b))); };
    const auto cosine = [](const Point& a, const Point& b) { return length(b) == 0 ? 0 : std::fabs(dot(normalized(a), normalized(b))); };
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;  // E_i ends and E_j begins at vertex k
        const std::string at = std::string("normals at ") + "ABC"[k] + ": N" + std::to_string(j + 1) + "(0) ";
        r.conditions.push_back({at + "parallel to N" + std::to_string(i + 1) + "(1) (sine of the angle)", sine(N[i](1), N[j](0)), compatibility_tolerance, ""});
        r.conditions.push_back({at + "normal to E" + std::to_string(i + 1) + "'(1) (sine of the angle)", cosine(N[j](0), t.E[i].derivative(1)), compatibility_tolerance, ""});
    }
    for (std::size_t k = 0; k < 3; ++k) {
        r.promises[k].on_edge = make_nielson_g1(edges, normals, TrianglePart(k + 1));
        Promise p = r.promises[k];
        p.what = "N" + std::to_string(k + 1) + " is the direction of the normal", p.curve = N[k], p.derivative = kNormal;
        r.promises.push_back(p);
    }
    return r;
}

}  // namespace isoparm
