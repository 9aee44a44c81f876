#include "patches/nielson.h"

#include "curves/modify.h"
#include "patch_model.h"
#include "patches/basis.h"
#include "patches/cross_data.h"
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

}  // namespace

Patch make_nielson_c1(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& cross, TrianglePart part) {
    const CrossData d(edges, cross);
    double tangents = d.size;
    for (const auto& s : d.slope) tangents = std::max({tangents, length(s(0)), length(s(1))});
    return make_patch(Nielson<RayC1>{{d.E, d.slope, d.D, d.V}, part, 10 * compatibility_tolerance * tangents});
}

Patch make_nielson_g1(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& normals, TrianglePart part) {
    const NormalData d(edges, normals);
    return make_patch(Nielson<RayG1>{{d.E, d.N, d.V, d.at_vertex}, part, 10 * compatibility_tolerance * d.size});
}

}  // namespace isoparm
