#include "patches/side_vertex.h"

#include <algorithm>
#include <limits>

#include "patch_model.h"
#include "patches/edge_series.h"
#include "patches/triangle_edges.h"
#include "scalar/cone.h"

namespace isoparm {
namespace {

/// E(t) - chord(t): what an edge adds to its chord.
struct Bulge {
    const Curve& edge;
    const Point &from, &to;
    template <class S> auto operator()(const S& t) const { return edge(t) - ((1.0 - t) * from + t * to); }
    double size() const { return length(from) + length(to); }  // of the terms, whose difference may vanish
};

Polynomial power(const Polynomial& x, int n) {
    Polynomial y(1);
    for (int k = 0; k < n; ++k) y = y * x;
    return y;
}

/// Forms of higher degree than this take long and serve nobody (ModelSource).
constexpr int kMostDegree = 9;

/// H(r) g(a/r), r = a + b, as polynomials x, y, z over r^order, where H and g are polynomials: each term h r^i g (a/r)^j is one over r^(j-i).
struct RationalCone {
    Vec3<Polynomial> sum;
    int order = 0, degree = 0;  // degree: of the sum
    bool exists = true;

    template <class G> RationalCone(const Function& H, const G& g, const Curve& edge, const Polynomial& a, const Polynomial& b) {
        const Polynomial t = Polynomial::variable_u({-1, 1}), h = H(t);  // coefficients of the powers of t
        const Vec3<Polynomial> x = g(t);
        exists = edge.breaks().empty() && h.exists() && x.x.exists() && x.y.exists() && x.z.exists() && zero(h.coefficient(0, 0));
        if (!exists) return;
        int lowest = 0;
        while (lowest < h.degree_u() && zero(h.coefficient(lowest, 0))) ++lowest;
        const Polynomial r = a + b;
        order = std::max({x.x.degree_u(), x.y.degree_u(), x.z.degree_u(), lowest}) - lowest, degree = order + h.degree_u();
        if (degree > kMostDegree) {
            exists = false;
            return;
        }
        for (int axis = 0; axis < 3; ++axis)
            for (int i = lowest; i <= h.degree_u(); ++i)
                for (int j = 0; j <= x[axis].degree_u(); ++j) sum[axis] = sum[axis] + power(a, j) * power(r, order + i - j) * Polynomial(h.coefficient(i, 0) * x[axis].coefficient(j, 0));
    }
    static bool zero(const Interval& x) { return x.lo == 0 && x.hi == 0; }
};

struct SideVertex {
    static constexpr Domain domain = Domain::triangle;
    std::array<Curve, 3> E;
    Point A, B, C;
    Function H;
    SideVertexForm form;
    SideVertexPart part;

    template <class U, class V, class W> auto operator()(const U& u, const V& v, const W& w) const {
        return form == SideVertexForm::delta ? delta(u, v, w) : seed(u, v, w);
    }
    template <class U, class V, class W> auto delta(const U& u, const V& v, const W& w) const {
        const auto plane = u * A + v * B + w * C;
        const auto bent1 = [&] { return cone(H, Bulge{E[0], B, C}, w, v); };
        const auto bent2 = [&] { return cone(H, Bulge{E[1], C, A}, u, w); };
        const auto bent3 = [&] { return cone(H, Bulge{E[2], A, B}, v, u); };
        switch (part) {
            case SideVertexPart::s1: return plane + bent2();
            case SideVertexPart::s2: return plane + bent3();
            case SideVertexPart::s3: return plane + bent1();
            case SideVertexPart::s4: return plane;
            default: return plane + bent1() + bent2() + bent3();
        }
    }
    /// Over one denominator, which vanishes at the corners.
    std::vector<Polynomial> homogeneous(const Polynomial& u, const Polynomial& v, const Polynomial& w) const {
        using Part = SideVertexPart;
        if (part == Part::s4) return {};  // a polynomial, or nothing
        const bool whole = part == Part::sum, bulges = form == SideVertexForm::delta;
        const Polynomial* sides[3][2] = {{&w, &v}, {&u, &w}, {&v, &u}};  // a, b of the cones
        const Point *from[3] = {&B, &C, &A}, *to[3] = {&C, &A, &B};
        const Part alone[3] = {Part::s3, Part::s1, Part::s2};
        Vec3<Polynomial> sum[3];
        Polynomial powers[3] = {1, 1, 1};
        int orders = 0, degree = 0;
        for (int k = 0; k < 3; ++k) {
            if (!whole && part != alone[k]) continue;
            const Polynomial &a = *sides[k][0], &b = *sides[k][1];
            const RationalCone cone = bulges ? RationalCone(H, Bulge{E[k], *from[k], *to[k]}, E[k], a, b) : RationalCone(H, E[k], E[k], a, b);
            if (!cone.exists) return {};
            sum[k] = cone.sum, powers[k] = power(a + b, cone.order);
            orders += cone.order, degree = std::max(degree, cone.degree - cone.order);
        }
        if (degree + orders > kMostDegree) return {};
        const Vec3<Polynomial> flat = bulges                ? Vec3<Polynomial>(u * A + v * B + w * C)
                                      : part == Part::s1    ? Vec3<Polynomial>(H(v) * B)
                                      : part == Part::s2    ? Vec3<Polynomial>(H(w) * C)
                                      : part == Part::s3    ? Vec3<Polynomial>(H(u) * A)
                                                            : Vec3<Polynomial>(Polynomial(-1) * (H(u) * A + H(v) * B + H(w) * C));
        std::vector<Polynomial> x(4);
        x[3] = powers[0] * powers[1] * powers[2];
        for (int axis = 0; axis < 3; ++axis) {
            x[std::size_t(axis)] = x[3] * flat[axis];
            for (int k = 0; k < 3; ++k) x[std::size_t(axis)] = x[std::size_t(axis)] + sum[k][axis] * powers[(k + 1) % 3] * powers[(k + 2) % 3];
        }
        return x;
    }
    template <class U, class V, class W> auto seed(const U& u, const V& v, const W& w) const {
        using Sum = decltype(u * A + v * B + w * C);
        switch (part) {
            case SideVertexPart::s1: return Sum(cone(H, E[1], u, w) + H(v) * B);
            case SideVertexPart::s2: return Sum(cone(H, E[2], v, u) + H(w) * C);
            case SideVertexPart::s3: return Sum(cone(H, E[0], w, v) + H(u) * A);
            case SideVertexPart::s4: return Sum(H(u) * A + H(v) * B + H(w) * C);
            default: return Sum(cone(H, E[1], u, w) + cone(H, E[2], v, u) + cone(H, E[0], w, v) - (H(u) * A + H(v) * B + H(w) * C));
        }
    }
    std::vector<Polynomial> beside(int e, std::size_t n) const;
};

/// The whole surface beside part n of edge e, for a polynomial H = h_1 r + h_2 r^2 + ... With the cones over a / r, r = a + b, of the other two edges, which are run from (a = U) or to (b = U) the vertex
/// opposite: r^i (g0 + g1 U/r + g2 U^2/r^2), g0, g1, g2 the Taylor coefficients of the edge (or its bulge) at that end, away from it. Of these U^2/r alone is no polynomial.
std::vector<Polynomial> SideVertex::beside(int e, std::size_t n) const {
    const auto parts = parts_of({&E[e]});
    if (n >= parts.size()) return {};
    const EdgeFrame f{parts[n]};
    const Point V[3] = {A, B, C};
    const bool bulges = form == SideVertexForm::delta;
    const Polynomial h = H(Polynomial::variable_u({-1, 1}));  // coefficients of the powers of r
    const Polynomial3 on = form_of(E[e], f.over);
    if (!exists(on) || !h.exists() || !RationalCone::zero(h.coefficient(0, 0))) return {};
    Series b[3];
    b[e] = f.U, b[(e + 1) % 3] = f.V, b[(e + 2) % 3] = f.W;
    const auto of = [&](const Series& r) {
        Series sum;
        for (int i = h.degree_u(); i >= 1; --i) sum = (sum + Series(h.coefficient(i, 0))) * r;
        return sum;
    };
    Series3 curve = at(on, f.ratio, f.over), sum;
    if (bulges) curve = curve - ((Series(1) - f.ratio) * constant(V[(e + 1) % 3]) + f.ratio * constant(V[(e + 2) % 3]));
    sum = of(f.r) * curve;
    for (int k = 0; k < 3; ++k) sum = bulges ? sum + b[k] * constant(V[k]) : sum - of(b[k]) * constant(V[k]);
    Polynomial3 extra;
    for (const int step : {1, 2}) {  // the edge that begins in e + 2 and ends in e, whose cone has a = U; the one from e to e + 1, b = U
        const int k = (e + step) % 3;
        Vec3<Interval> g[3];
        E[k].taylor(Interval(step == 1 ? 0.0 : 1.0), 2, g);
        if (step == 2) g[1] = -g[1];
        const Point &from = V[(e + (step == 1 ? 2 : 1)) % 3], &to = V[e];
        if (bulges) g[0] = g[0] - Vec3<Interval>(from), g[1] = g[1] - (Vec3<Interval>(to) - Vec3<Interval>(from));
        const Series r = f.U + b[(e + (step == 1 ? 2 : 1)) % 3];
        for (int i = 1; i <= h.degree_u(); ++i) {
            const Series c(h.coefficient(i, 0));
            sum += c * power(r, i) * constant(g[0]) + c * f.U * power(r, i - 1) * constant(g[1]);
            if (i >= 2) sum += c * f.U * f.U * power(r, i - 2) * constant(g[2]);
            else if (!RationalCone::zero(h.coefficient(1, 0))) extra += (c.c[0] * (step == 1 ? f.rest : f.t)) * Polynomial3{Polynomial(g[2].x), Polynomial(g[2].y), Polynomial(g[2].z)};
        }
    }
    EdgeForm result(sum);
    if (!RationalCone::zero(h.coefficient(1, 0))) result.extra = extra, result.under[3] = f.t * f.rest;
    return result.list(f.over);
}

}  // namespace

Patch make_side_vertex(const std::array<Curve, 3>& edges, const Function& H, SideVertexForm form, SideVertexPart part) {
    const TriangleEdges t(edges);
    // No rounding here: H(0) is how far the surface is torn at a vertex, and cone() takes it for 0.
    constexpr double nothing = std::numeric_limits<double>::min();
    if (const double gap = std::abs(H(0)); !(gap <= nothing)) throw IncompatibleError("H(0) = 0", gap, nothing);
    // Nor may H jump there: next to 0 it is as small as the interval shows it to be.
    Interval near;
    H.taylor(Interval(0, 1e-300), 0, &near);
    if (const double gap = mag(near); !(gap <= 1e-12)) throw IncompatibleError("H(t) -> 0 for t -> 0", gap, 1e-12);
    if (const double gap = std::abs(H(1) - 1); !(gap <= 1e-12)) throw IncompatibleError("H(1) = 1", gap, 1e-12);
    const SideVertex formula{t.E, t.V[0], t.V[1], t.V[2], H, form, part};
    if (part != SideVertexPart::sum) return make_patch(formula);
    return with_triangle_forms(make_patch(formula), [formula](int edge, std::size_t part) { return formula.beside(edge, part); });
}

}  // namespace isoparm
