#include "patches/bezier_triangle.h"

#include "curves/piecewise_bezier.h"
#include "error.h"
#include "patch_model.h"

namespace isoparm {
namespace {

/// sum n!/(i!j!k!) u^i v^j w^k b_ijk over one coordinate; coefficient(j, k) with i = n - j - k.
struct Coordinate {
    int degree;
    std::vector<Interval> c;  // rows k = 0..n, in each j = 0..n-k; already times the multinomial coefficient
    Polynomial exact{0.0};
    Interval convex_hull{};

    template <class S> std::vector<S> powers(const S& x) const {
        std::vector<S> p{S(1.0)};
        for (int i = 1; i <= degree; ++i) p.push_back(p.back() * x);
        return p;
    }
    template <class U, class V, class W> auto operator()(const U& u, const V& v, const W& w) const {
        const auto pu = powers(u);
        const auto pv = powers(v);
        const auto pw = powers(w);
        auto sum = (pu[degree] * pv[0]) * pw[0] * constant_for<W>(c[0]);
        std::size_t at = 1;
        for (int k = 0; k <= degree; ++k)
            for (int j = k == 0 ? 1 : 0; j <= degree - k; ++j) sum = sum + (pu[degree - j - k] * pv[j]) * pw[k] * constant_for<W>(c[at++]);
        return sum;
    }
};

struct BezierTriangle {
    static constexpr Domain domain = Domain::triangle;
    std::vector<Coordinate> n;  // x, y, z (weighted), and the denominator when rational

    template <class U, class V, class W> auto operator()(const U& u, const V& v, const W& w) const {
        Vec3<W> p{n[0](u, v, w), n[1](u, v, w), n[2](u, v, w)};
        return n.size() == 3 ? p : p / n[3](u, v, w);
    }
    Vec3<Polynomial> operator()(const Polynomial& u, const Polynomial& v, const Polynomial& w) const {
        if (n.size() == 4 && !u.is_model()) return {Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()};
        const Vec3<Polynomial> p{n[0](u, v, w), n[1](u, v, w), n[2](u, v, w)};
        return n.size() == 3 ? p : p / n[3](u, v, w);
    }
    std::vector<Polynomial> homogeneous(const Polynomial& u, const Polynomial& v, const Polynomial& w) const {
        std::vector<Polynomial> x;
        for (const Coordinate& c : n) x.push_back(c(u, v, w));
        return x;
    }
    /// Over intervals: by the exact polynomials in (u,v), where the powers of u, v and w do not lose each other.
    template <int N> Vec3<JetUV<Interval, N>> operator()(const JetU<Interval, N>& u, const JetV<Interval, N>& v, const JetUV<Interval, N>&) const
        requires(N > 0)
    {
        JetUV<Interval, N> x[4];
        for (std::size_t k = 0; k < n.size(); ++k) {
            n[k].exact.template jets<N>(0.5, 0.5, u.c[0], v.c[0], nullptr, &x[k]);
            x[k].c[0] = intersection(x[k].c[0], n[k].convex_hull);
        }
        const Vec3<JetUV<Interval, N>> p{x[0], x[1], x[2]};
        return n.size() == 3 ? p : p / x[3];
    }
};

}  // namespace

Patch make_bezier_triangle(int degree, const std::vector<Point>& points, const std::vector<double>& weights) {
    if (degree < 1 || degree > max_degree) throw_input("found degree " + std::to_string(degree) + ", expected 1 to " + std::to_string(max_degree));
    const std::size_t expected = std::size_t(degree + 1) * (degree + 2) / 2;
    if (points.size() != expected)
        throw_input("found " + std::to_string(points.size()) + " points for degree " + std::to_string(degree) + ", expected " + std::to_string(expected));
    if (!weights.empty() && weights.size() != expected) throw_input("found " + std::to_string(weights.size()) + " weights, expected " + std::to_string(expected));
    for (const auto& p : points)
        if (!finite(p)) throw_input("a point is not finite");
    for (double w : weights)
        if (!(w > 0 && std::isfinite(w))) throw_input("found weight " + to_text(w) + ", expected a positive number");
    BezierTriangle patch;
    const auto x = Polynomial::variable_u({0, 1}), y = Polynomial::variable_v({0, 1}), z = Polynomial(1) - x - y;
    for (int axis = 0; axis < (weights.empty() ? 3 : 4); ++axis) {
        Coordinate coordinate{degree, {}};
        std::size_t at = 0;
        coordinate.convex_hull = axis == 3 ? Interval(weights[0]) : Interval(points[0][axis]) * Interval(weights.empty() ? 1 : weights[0]);
        for (int k = 0; k <= degree; ++k)
            for (int j = 0; j <= degree - k; ++j, ++at) {
                const double multinomial = binomial(degree, k) * binomial(degree - k, j);
                const Interval value = axis == 3 ? Interval(1) : Interval(points[at][axis]);
                const Interval weighted = weights.empty() ? value : Interval(weights[at]) * value;
                coordinate.convex_hull = hull(coordinate.convex_hull, weighted);
                coordinate.c.push_back(Interval(multinomial) * weighted);
            }
        coordinate.exact = coordinate(x, y, z);
        patch.n.push_back(std::move(coordinate));
    }
    return make_patch(std::move(patch));
}

}  // namespace isoparm
