#include "patches/nielson.h"

#include "curves/modify.h"
#include "patch_model.h"
#include "patches/basis.h"
#include "patches/cross_data.h"
#include "patches/edge_series.h"
#include "scalar/cone.h"

namespace isoparm {
namespace {

/// H1: derivative at the vertex, H2: derivative on the edge, H3: value on the edge.
template <int K> struct Hermite {
    template <class S> S operator()(const S& rho) const { return hermite_polynomials(rho)[K]; }
};
using H1 = Hermite<1>;
using H2 = Hermite<2>;
using H3 = Hermite<3>;

/// E1(t) - A: from a vertex to the edge opposite.
struct Chord {
    const Curve& edge;
    const Point& vertex;
    template <class S> auto operator()(const S& t) const { return edge(t) - vertex; }
    double size() const { return length(edge(0)) + length(vertex); }
};

/// Where the ray of A arrives on E1: the derivative along it, (t - 1/2) E1' - D1.
struct Arrival {
    const Curve &slope, &cross;
    template <class S> auto operator()(const S& t) const { return (t - 0.5) * slope(t) - cross(t); }
    double size() const { return length(slope(0)) + length(cross(0)); }
};

/// A, then the edge opposite with the slope of its cross derivatives, along the ray u = 1 - rho, tau = w/(v+w):
///     T1 = H0(rho) A + u^2 v t_AB + u^2 w t_AC + H2(rho) R1(tau) + H3(rho) E1(tau),   t_AB = E3'(0), t_AC = -E2'(1)
struct RayC1 {
    std::array<Curve, 3> E, slope, D;
    std::array<Point, 3> V;
    std::vector<Interval> parts(int e) const { return parts_of({&E[e], &slope[e], &D[e]}); }
    std::optional<EdgeForm> beside(int e, const EdgeFrame& f) const;
    Polynomial3 along(int k, bool last, const Polynomial& r) const;
    template <class X, class Y, class Z> auto operator()(int k, const X& x, const Y& y, const Z& z) const {
        const Point along_y = slope[(k + 2) % 3](0), along_z = -slope[(k + 1) % 3](1);
        return V[k] + square(x) * (y * along_y + z * along_z) + (cone(H2{}, Arrival{slope[k], D[k]}, z, y) + cone(H3{}, Chord{E[k], V[k]}, z, y));
    }
};

/// The part of E1(t) - A that is normal to n(t): a projection, so no longer than what it is made of.
template <class N> struct Projected {
    Chord chord;
    const N& normal;
    template <class S> auto operator()(const S& t) const {
        const auto d = chord(t);
        const auto n = normal(t);
        auto r = d - (dot(n, d) / (square(n.x) + square(n.y) + square(n.z))) * n;
        if constexpr (requires { r.x.c[0].lo; }) {
            const double most = rounding::length_up(mag(d.x.c[0]), mag(d.y.c[0]), mag(d.z.c[0]));
            for (int axis = 0; axis < 3; ++axis) r[axis].c[0] = intersection(r[axis].c[0], {-most, most});
        }
        return r;
    }
    double size() const { return chord.size(); }
};
struct Constant {
    Point value;
    template <class S> Vec3<S> operator()(const S&) const { return {S(value.x), S(value.y), S(value.z)}; }
};

/// The same with directions instead of derivatives: the chord to the edge, projected into the tangent plane at either end of the ray:
///     T1 = H0(rho) A + H1(rho) Pi_A (E1 - A) + H2(rho) Pi_n1(tau) (E1 - A) + H3(rho) E1(tau)
struct RayG1 {
    std::array<Curve, 3> E, N;
    std::array<Point, 3> V, at_vertex;
    std::vector<Interval> parts(int e) const { return parts_of({&E[e], &N[e]}); }
    std::optional<EdgeForm> beside(int e, const EdgeFrame& f) const;
    Polynomial3 along(int k, bool last, const Polynomial& r) const;
    template <class X, class Y, class Z> auto operator()(int k, const X& x, const Y& y, const Z& z) const {
        (void)x;
        const Chord chord{E[k], V[k]};
        const Constant n{at_vertex[k]};
        return V[k] + (cone(H1{}, Projected<Constant>{chord, n}, z, y) + cone(H2{}, Projected<Curve>{chord, N[k]}, z, y) + cone(H3{}, chord, z, y));
    }
};

// ---- the weights v^2 w^2 / (v^2 w^2 + w^2 u^2 + u^2 v^2) ----------------------------------------------------------------------------------
double scale_of(double a, double b, double c) { return cone_detail::divisor(std::max({a, b, c})); }
Pack scale_of(const Pack& a, const Pack& b, const Pack& c) {
    Pack r;
    for (int i = 0; i < Pack::lanes; ++i) r.set(i, scale_of(a[i], b[i], c[i]));
    return r;
}
Interval scale_of(const Interval& a, const Interval& b, const Interval& c) { return scale_of(a.hi, b.hi, c.hi); }

/// The weight of u grows with v and w and falls with u.
Interval weight_range(const Interval& u, const Interval& v, const Interval& w) {
    const auto at = [](double x, double y, double z) {
        const Interval a = square(Interval(y) * Interval(z)), b = square(Interval(z) * Interval(x)), c = square(Interval(x) * Interval(y));
        return a / (a + b + c);
    };
    return {std::max(0.0, at(u.hi, v.lo, w.lo).lo), std::min(1.0, at(u.lo, v.hi, w.hi).hi)};
}

template <class J> struct Weights {
    J of_u, of_v;  // that of w is the rest of 1
};
template <class T, int N> Weights<JetUV<T, N>> weights(const JetUV<T, N>& u, const JetUV<T, N>& v, const JetUV<T, N>& w) {
    using J = JetUV<T, N>;
    J p = v * w, q = w * u, r = u * v;
    const T scale = scale_of(p.c[0], q.c[0], r.c[0]);  // so that no square underflows
    p = square(p / scale), q = square(q / scale), r = square(r / scale);
    J sum = p + q + r;
    sum.c[0] = cone_detail::divisor(sum.c[0]);
    Weights<J> x{p / sum, q / sum};
    if constexpr (std::is_same_v<T, Interval>) {
        x.of_u.c[0] = intersection(x.of_u.c[0], weight_range(u.c[0], v.c[0], w.c[0]));
        x.of_v.c[0] = intersection(x.of_v.c[0], weight_range(v.c[0], w.c[0], u.c[0]));
    }
    return x;
}

/// f_ij lies in f_ij(middle) + (i + 1) f_(i+1)j du + (j + 1) f_i(j+1) dv.
template <class J> void tighten(J& f, const J& middle, const Interval& du, const Interval& dv) {
    for (int k = J::size - 1; k >= 0; --k) {
        const auto [i, j] = J::powers[k];
        if (i + j == J::order) continue;
        f.c[k] = intersection(f.c[k], middle.c[k] + Interval(i + 1.0) * f.coefficient(i + 1, j) * du + Interval(j + 1.0) * f.coefficient(i, j + 1) * dv);
    }
}

/// At a vertex the weights have no limit, but their sum is 1: what the three interpolants agree on is what the surface has there.
template <class J> void agree_at_vertex(const Vec3<J>* T, int own, double tolerance, Vec3<J>& x) {
    for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < J::size; ++k) {
            const auto [low, high] = std::minmax({T[0][axis].c[k], T[1][axis].c[k], T[2][axis].c[k]});
            const bool agree = high - low <= tolerance && std::isfinite(T[0][axis].c[k] + T[1][axis].c[k] + T[2][axis].c[k]);
            x[axis].c[k] = k == 0 || agree ? T[own][axis].c[k] : std::numeric_limits<double>::quiet_NaN();
        }
}

template <class Ray> struct Nielson {
    static constexpr Domain domain = Domain::triangle;
    Ray ray;
    TrianglePart part;
    double tolerance;  // within which derivatives at a vertex agree

    std::vector<Polynomial> beside(int e, std::size_t n) const;
    template <class U, class V, class W> auto operator()(const U& u, const V& v, const W& w) const {
        using R = decltype(turned(0, ray, u, v, w));
        if (part != TrianglePart::sum) return turned(vertex_of(part), ray, u, v, w);
        return combined<R>(u, v, w);
    }
    template <class T, int N> struct Terms {
        Vec3<JetUV<T, N>> rays[3], difference[2];  // T1 - T3, T2 - T3: small near a vertex, where weights change fast
        Weights<JetUV<T, N>> weight;
    };
    template <class T, int I1, int J1, int I2, int J2, int N>
    Terms<T, N> terms_of(const Jet<T, I1, J1, N>& u, const Jet<T, I2, J2, N>& v, const JetUV<T, N>& w) const {
        Terms<T, N> x{{turned(0, ray, u, v, w), turned(1, ray, u, v, w), turned(2, ray, u, v, w)}, {}, weights<T, N>(u, v, w)};
        for (int k : {0, 1}) x.difference[k] = x.rays[k] - x.rays[2];
        if constexpr (std::is_same_v<T, Interval> && N == 3) {
            const double mu = mid(u.c[0]), mv = mid(v.c[0]);
            if (mu + mv > 1 || (u.c[0].lo == u.c[0].hi && v.c[0].lo == v.c[0].hi)) return x;
            // Mean values about the middle, which keep what cancels there.
            auto u0 = u;
            auto v0 = v;
            auto w0 = w;
            u0.c[0] = mu, v0.c[0] = mv;
            w0.c[0] = clip(Interval(1) - (u0.c[0] + v0.c[0]), {0, 1});
            const Vec3<JetUV<T, N>> a[3] = {turned(0, ray, u0, v0, w0), turned(1, ray, u0, v0, w0), turned(2, ray, u0, v0, w0)};
            const auto middle = weights<T, N>(u0, v0, w0);
            const Interval du = u.c[0] - Interval(mu), dv = v.c[0] - Interval(mv);
            for (int axis = 0; axis < 3; ++axis) {
                tighten(x.rays[2][axis], a[2][axis], du, dv);
                for (int k : {0, 1}) tighten(x.difference[k][axis], a[k][axis] - a[2][axis], du, dv);
            }
            tighten(x.weight.of_u, middle.of_u, du, dv);
            tighten(x.weight.of_v, middle.of_v, du, dv);
        }
        return x;
    }
    template <class R> R combined(const Polynomial& u, const Polynomial& v, const Polynomial& w) const {
        const Polynomial p = square(v * w), q = square(w * u), sum = p + q + square(u * v), of_u = p / sum, of_v = q / sum;
        if (!of_u.exists() || !of_v.exists()) return {Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()};
        const R t[3] = {turned(0, ray, u, v, w), turned(1, ray, u, v, w), turned(2, ray, u, v, w)};
        return t[2] + of_u * (t[0] - t[2]) + of_v * (t[1] - t[2]);
    }
    template <class R, class T, int I1, int J1, int I2, int J2, int N>
    R combined(const Jet<T, I1, J1, N>& u, const Jet<T, I2, J2, N>& v, const JetUV<T, N>& w) const {
        const Terms<T, N> terms = terms_of(u, v, w);
        const auto& t = terms.rays;
        R x = t[2] + terms.weight.of_u * terms.difference[0] + terms.weight.of_v * terms.difference[1];
        if constexpr (std::is_same_v<T, Interval>) {
            for (int axis = 0; axis < 3; ++axis)  // a mean of the three
                x[axis].c[0] = intersection(x[axis].c[0], hull(hull(t[0][axis].c[0], t[1][axis].c[0]), t[2][axis].c[0]));
        }
        if constexpr (std::is_same_v<T, double> && N > 0) {
            const double at[3] = {u.c[0], v.c[0], w.c[0]};
            for (int k = 0; k < 3; ++k)
                if (at[(k + 1) % 3] == 0 && at[(k + 2) % 3] == 0) agree_at_vertex(t, k, tolerance, x);
        }
        return x;
    }
};

// ---- beside the edges ------------------------------------------------------------------------------------------------------------------
Vec3<Interval> value_at(const Curve& c, double t) {
    Vec3<Interval> x;
    c.taylor(Interval(t), 0, &x);
    return x;
}
Polynomial3 constants(const Vec3<Interval>& x) { return {Polynomial(x.x), Polynomial(x.y), Polynomial(x.z)}; }
Polynomial3 constants(const Point& x) { return {Polynomial(x.x), Polynomial(x.y), Polynomial(x.z)}; }
/// Of x, normal to n.
Vec3<Interval> projected(const Vec3<Interval>& x, const Vec3<Interval>& n) { return x - (dot(n, x) / dot(n, n)) * n; }

/// The interpolant along the rays of vertex e itself.
std::optional<EdgeForm> RayC1::beside(int e, const EdgeFrame& f) const {
    const Polynomial3 on = form_of(E[e], f.over), along = form_of(slope[e], f.over), across = form_of(D[e], f.over);
    if (!exists(on) || !exists(along) || !exists(across)) return {};
    const auto from_vertex = [](const Point& p) { return constant(p); };
    const Series3 tangents = f.V * from_vertex(slope[(e + 2) % 3](0)) + f.W * from_vertex(-slope[(e + 1) % 3](1));
    const Series3 arrival = (f.ratio - Series(0.5)) * at(along, f.ratio, f.over) - at(across, f.ratio, f.over), chord = at(on, f.ratio, f.over) - constant(V[e]);
    return EdgeForm(constant(V[e]) + f.U * f.U * tangents + H2{}(f.r) * arrival + H3{}(f.r) * chord);
}
/// That along the rays of vertex k, on the ray that is the edge to the next vertex, or to the one after it (`last`); r is 0 at k.
Polynomial3 RayC1::along(int k, bool last, const Polynomial& r) const {
    const Polynomial from = Polynomial(1) - r;
    const double end = last ? 1 : 0;
    const Polynomial3 tangent = constants(last ? -slope[(k + 1) % 3](1) : slope[(k + 2) % 3](0));
    const Vec3<Interval> arrival = Interval(end - 0.5) * value_at(slope[k], end) - value_at(D[k], end), chord = value_at(E[k], end) - Vec3<Interval>(V[k]);
    return constants(V[k]) + from * from * r * tangent + H2{}(r) * constants(arrival) + H3{}(r) * constants(chord);
}

/// With d the chord, n the normal and q = n.d / n.n, series in x, and H2(1 - x) = -x + 2 x^2: the term H2 (d - q n), whose quotients are
///     q0 = a0 / b0,  q1 = (a1 b0 - a0 b1) / b0^2,    a = n.d, b = n.n.
std::optional<EdgeForm> RayG1::beside(int e, const EdgeFrame& f) const {
    const Polynomial3 on = form_of(E[e], f.over), normal = form_of(N[e], f.over);
    if (!exists(on) || !exists(normal)) return {};
    const Series3 d = at(on, f.ratio, f.over) - constant(V[e]), n = at(normal, f.ratio, f.over);
    const Vec3<Interval> at_end(at_vertex[e]);
    const Series3 first = d - (dot(constant(at_end), d) * Series(Polynomial(Interval(1) / dot(at_end, at_end)))) * constant(at_end);
    EdgeForm form(constant(V[e]) + H1{}(f.r) * first + H2{}(f.r) * d + H3{}(f.r) * d);
    const Series a = dot(n, d), b = dot(n, n);
    const Polynomial &b0 = b.c[0], bb = b0 * b0, q1 = a.c[1] * b0 - a.c[0] * b.c[1];
    for (int axis = 0; axis < 3; ++axis) {
        const Polynomial &n0 = n[axis].c[0], &n1 = n[axis].c[1];
        form.across[axis] = form.across[axis] * b0 + a.c[0] * n0;
        form.second[axis] = form.second[axis] * bb + q1 * n0 + a.c[0] * b0 * (n1 - Polynomial(2) * n0);
    }
    form.under[1] = b0, form.under[2] = bb;
    return form;
}
Polynomial3 RayG1::along(int k, bool last, const Polynomial& r) const {
    const double end = last ? 1 : 0;
    const Vec3<Interval> chord = value_at(E[k], end) - Vec3<Interval>(V[k]);
    return constants(V[k]) + H1{}(r) * constants(projected(chord, Vec3<Interval>(at_vertex[k]))) + H2{}(r) * constants(projected(chord, value_at(N[k], end))) + H3{}(r) * constants(chord);
}

/// The weights of the other two are x^2 / (1 - t)^2 and x^2 / t^2, and O(x^3): position and first derivatives are those of the one of vertex e.
template <class Ray> std::vector<Polynomial> Nielson<Ray>::beside(int e, std::size_t n) const {
    const auto parts = ray.parts(e);
    if (n >= parts.size()) return {};
    const EdgeFrame f{parts[n]};
    if (part != TrianglePart::sum && vertex_of(part) != e) return {};
    std::optional<EdgeForm> form = ray.beside(e, f);
    if (!form) return {};
    if (part != TrianglePart::sum) return form->list(f.over);
    const Polynomial tt = f.t * f.t, rr = f.rest * f.rest;
    form->extra = tt * (ray.along((e + 1) % 3, false, f.t) - form->value) + rr * (ray.along((e + 2) % 3, true, f.rest) - form->value);
    form->under[3] = tt * rr;
    // What agrees at the vertices has those zeros too; what is left of it is rounding.
    for (int axis = 0; axis < 3; ++axis) {
        if (!form->extra[axis].exists()) return {};
        form->second[axis] = form->second[axis] + divided(form->extra[axis], form->under[3], f.t - Polynomial(mid(f.over))) * form->under[2];
    }
    return form->list(f.over);
}
template <class Ray> Patch with_forms(const Nielson<Ray>& formula) {
    return with_triangle_forms(make_patch(formula), [formula](int edge, std::size_t n) { return formula.beside(edge, n); });
}

}  // namespace

Patch make_nielson_c1(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& cross, TrianglePart part) {
    const CrossData d(edges, cross);
    double tangents = d.size;
    for (const auto& s : d.slope) tangents = std::max({tangents, length(s(0)), length(s(1))});
    return with_forms(Nielson<RayC1>{{d.E, d.slope, d.D, d.V}, part, 10 * compatibility_tolerance * tangents});
}

Patch make_nielson_g1(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& normals, TrianglePart part) {
    const NormalData d(edges, normals);
    return with_forms(Nielson<RayG1>{{d.E, d.N, d.V, d.at_vertex}, part, 10 * compatibility_tolerance * d.size});
}

}  // namespace isoparm
