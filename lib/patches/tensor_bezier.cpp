#include "patches/tensor_bezier.h"

#include <algorithm>
#include <array>

#include "curves/bspline.h"
#include "error.h"
#include "patch_model.h"
#include "patches/tensor_bezier_points.h"

namespace isoparm {
namespace {

/// Bernstein basis of degree n at t (Farin 2002, 5.1), as products of the same scalar.
template <class S> void bernstein(int n, const S& t, std::vector<S>& out) {
    out.assign(1, S(1.0));
    const S s = 1.0 - t;
    for (int k = 1; k <= n; ++k) {
        out.push_back(t * out[k - 1]);
        for (int i = k - 1; i > 0; --i) out[i] = s * out[i] + t * out[i - 1];
        out[0] = s * out[0];
    }
}

/// One coordinate (or the denominator) of a cell: Bezier coefficients, and the exact polynomial for intervals.
struct Coordinate {
    Grid<double> c;
    Polynomial exact;
    Interval convex_hull;

    explicit Coordinate(const Grid<Interval>& coefficients) : convex_hull(coefficients[0][0]) {
        for (const auto& row : coefficients) {
            c.emplace_back();
            for (const auto& x : row) c.back().push_back(mid(x)), convex_hull = hull(convex_hull, x);
        }
        std::vector<Polynomial> bu, bv;
        bernstein(int(c.size()) - 1, Polynomial::variable_u({0, 1}), bu);
        bernstein(int(c[0].size()) - 1, Polynomial::variable_v({0, 1}), bv);
        for (std::size_t i = 0; i < bu.size(); ++i)
            for (std::size_t j = 0; j < bv.size(); ++j) exact = exact + bu[i] * bv[j] * Polynomial(coefficients[i][j]);
    }

    template <class U, class V> auto operator()(const U&, const V&, const std::vector<U>& bu, const std::vector<V>& bv) const {
        auto sum = bu[0] * along_v(0, bv);
        for (std::size_t i = 1; i < bu.size(); ++i) sum = sum + bu[i] * along_v(i, bv);
        return sum;
    }
    template <class V> V along_v(std::size_t i, const std::vector<V>& bv) const {
        V sum = bv[0] * c[i][0];
        for (std::size_t j = 1; j < bv.size(); ++j) sum = sum + bv[j] * c[i][j];
        return sum;
    }
};

struct Cell {
    double u0, u1, v0, v1;
    std::vector<Coordinate> n;  // x, y, z (weighted), and the denominator when rational
    std::vector<double> all;    // the coefficients of these, one after the other
    BezierCoefficients coefficients() const { return {int(n[0].c.size()) - 1, int(n[0].c[0].size()) - 1, n.size() == 4, u0, u1, v0, v1, all.data()}; }
};

struct TensorBezier {
    static constexpr Domain domain = Domain::quad;
    Rect range;
    std::vector<double> inner_u, inner_v;
    std::vector<Cell> cells;  // u-major

    Rect rect() const { return range; }
    std::vector<double> breaks_u() const { return inner_u; }
    std::vector<double> breaks_v() const { return inner_v; }

    template <class U, class V> auto operator()(const U& u, const V& v) const {
        const Cell& cell = cell_at(u, v);
        return evaluate(cell, local(u, cell.u0, cell.u1), local(v, cell.v0, cell.v1));
    }
    std::vector<Polynomial> homogeneous(const Polynomial& u, const Polynomial& v) const {
        const Cell& cell = cell_at(u, v);
        return coordinates(cell, local(u, cell.u0, cell.u1), local(v, cell.v0, cell.v1));
    }

    /// The same bits, faster; false where degrees are too high for that.
    bool points(std::size_t n, const double* u, const double* v, Point* out) const {
        if (std::max(cells[0].n[0].c.size(), cells[0].n[0].c[0].size()) > BezierCoefficients::max_degree + 1) return false;
        for (std::size_t first = 0; first < n;) {
            const Cell& cell = cell_at(u[first], v[first]);
            std::size_t last = cells.size() == 1 ? n : first + 1;
            while (last < n && &cell_at(u[last], v[last]) == &cell) ++last;
            bezier_points(chosen_isa(), cell.coefficients(), last - first, u + first, v + first, out + first);
            first = last;
        }
        return true;
    }

private:
    template <class U, class V> const Cell& cell_at(const U& u, const V& v) const { return cells[cell_of(inner_u, u) * (inner_v.size() + 1) + cell_of(inner_v, v)]; }
    static std::vector<Polynomial> coordinates(const Cell& cell, const Polynomial& s, const Polynomial& t) {
        std::vector<Polynomial> bu, bv, x;
        bernstein(int(cell.n[0].c.size()) - 1, s, bu);
        bernstein(int(cell.n[0].c[0].size()) - 1, t, bv);
        for (const Coordinate& c : cell.n) x.push_back(c(s, t, bu, bv));
        return x;
    }
    /// From [from, to] to [0, 1]. Over intervals the width is one too: to - from is rounded.
    template <class S> static S local(const S& t, double from, double to) {
        using T = std::decay_t<decltype(base(t))>;
        return (t - T(from)) / (T(to) - T(from));
    }
    static Polynomial local(const Polynomial& t, double from, double to) { return (t - Polynomial(from)) / Polynomial(Interval(to) - Interval(from)); }
    template <class U, class V> static auto evaluate(const Cell& cell, const U& s, const V& t) {
        std::vector<U> bu;
        std::vector<V> bv;
        bernstein(int(cell.n[0].c.size()) - 1, s, bu);
        bernstein(int(cell.n[0].c[0].size()) - 1, t, bv);
        using R = decltype(cell.n[0](s, t, bu, bv));
        Vec3<R> p{cell.n[0](s, t, bu, bv), cell.n[1](s, t, bu, bv), cell.n[2](s, t, bu, bv)};
        return cell.n.size() == 3 ? p : p / cell.n[3](s, t, bu, bv);
    }
    /// Over intervals: numerator and denominator by their exact polynomials, so that only the quotient loses tightness.
    template <int I1, int J1, int I2, int J2, int N>
    static auto evaluate(const Cell& cell, const Jet<Interval, I1, J1, N>& s, const Jet<Interval, I2, J2, N>& t) {
        using R = JetUV<Interval, N>;
        R n[4];
        const Interval unit(0, 1);  // parameters lie in the cell; only rounding can put the ends of a box outside
        for (std::size_t k = 0; k < cell.n.size(); ++k) {
            cell.n[k].exact.template jets<N>(0.5, 0.5, clip(s.c[0], unit), clip(t.c[0], unit), nullptr, &n[k]);
            n[k].c[0] = intersection(n[k].c[0], cell.n[k].convex_hull);
            for (int c = 0; c < R::size; ++c) {
                const auto [i, j] = R::powers[c];
                for (int q = 0; q < i; ++q) n[k].c[c] = n[k].c[c] * s.coefficient(1, 0);
                for (int q = 0; q < j; ++q) n[k].c[c] = n[k].c[c] * t.coefficient(0, 1);
            }
        }
        const Vec3<R> p{n[0], n[1], n[2]};
        return cell.n.size() == 3 ? p : p / n[3];
    }
    static Vec3<Polynomial> evaluate(const Cell& cell, const Polynomial& s, const Polynomial& t) {
        if (cell.n.size() == 4 && !s.is_model()) return {Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()};
        const auto x = coordinates(cell, s, t);
        const Vec3<Polynomial> p{x[0], x[1], x[2]};
        return cell.n.size() == 3 ? p : p / x[3];
    }
};

void check_shape(const Grid<Point>& points, const Grid<double>& weights) {
    if (points.empty() || points[0].empty()) throw_input("found no points, expected at least one row of points");
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].size() != points[0].size())
            throw_input("found " + std::to_string(points[i].size()) + " points in row " + std::to_string(i) + ", expected " + std::to_string(points[0].size()) + " as in row 0");
        for (const auto& p : points[i])
            if (!finite(p)) throw_input("a point in row " + std::to_string(i) + " is not finite");
    }
    if (weights.empty()) return;
    if (weights.size() != points.size()) throw_input("found " + std::to_string(weights.size()) + " rows of weights, expected " + std::to_string(points.size()));
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i].size() != points[i].size())
            throw_input("found " + std::to_string(weights[i].size()) + " weights in row " + std::to_string(i) + ", expected " + std::to_string(points[i].size()));
        for (double w : weights[i])
            if (!(w > 0 && std::isfinite(w))) throw_input("found weight " + to_text(w) + " in row " + std::to_string(i) + ", expected a positive number");
    }
}

/// Bezier coefficients of a cell, x_k = sum_ij rows_u rows_v w_ij x_ij, as intervals that hold the exact numbers.
Cell make_cell(const BezierSpan& su, const BezierSpan& sv, const Grid<Point>& points, const Grid<double>& weights) {
    Cell cell{su.begin, su.end, sv.begin, sv.end, {}, {}};
    for (int axis = 0; axis < (weights.empty() ? 3 : 4); ++axis) {
        Grid<Interval> c(su.rows.size(), std::vector<Interval>(sv.rows.size(), Interval(0)));
        for (std::size_t i = 0; i < su.rows.size(); ++i)
            for (std::size_t j = 0; j < sv.rows.size(); ++j)
                for (std::size_t k = 0; k < su.rows[i].size(); ++k)
                    for (std::size_t l = 0; l < sv.rows[j].size(); ++l) {
                        const double weight = su.rows[i][k] * sv.rows[j][l];
                        if (weight == 0) continue;
                        const double w = weights.empty() ? 1 : weights[su.first + k][sv.first + l];
                        const double x = axis == 3 ? 1 : points[su.first + k][sv.first + l][axis];
                        const Interval term = weight == 1 && w == 1 ? Interval(x) : Interval(weight) * (Interval(w) * Interval(x));
                        c[i][j] = c[i][j].lo == 0 && c[i][j].hi == 0 ? term : c[i][j] + term;
                    }
        cell.n.emplace_back(c);
        for (const auto& row : cell.n.back().c) cell.all.insert(cell.all.end(), row.begin(), row.end());
    }
    return cell;
}

BezierSpan whole(int degree) {
    BezierSpan s{0, 1, degree, {}, 0};
    for (int i = 0; i <= degree; ++i) {
        s.rows.emplace_back(degree + 1, 0.0);
        s.rows[i][i] = 1;
    }
    return s;
}

Patch assemble(const std::vector<BezierSpan>& su, const std::vector<BezierSpan>& sv, const Grid<Point>& points, const Grid<double>& weights) {
    TensorBezier patch;
    patch.range = {su.front().begin, su.back().end, sv.front().begin, sv.back().end};
    for (std::size_t i = 0; i + 1 < su.size(); ++i) patch.inner_u.push_back(su[i].end);
    for (std::size_t j = 0; j + 1 < sv.size(); ++j) patch.inner_v.push_back(sv[j].end);
    for (const auto& a : su)
        for (const auto& b : sv) patch.cells.push_back(make_cell(a, b, points, weights));
    return make_patch(std::move(patch));
}

}  // namespace

Patch make_bezier_patch(const Grid<Point>& points, const Grid<double>& weights) {
    check_shape(points, weights);
    const int p = int(points.size()) - 1, q = int(points[0].size()) - 1;
    if (p > max_degree || q > max_degree)
        throw_input("found a patch of degree (" + std::to_string(p) + ", " + std::to_string(q) + "), expected at most " + std::to_string(max_degree));
    return assemble({whole(p)}, {whole(q)}, points, weights);
}

Patch make_bspline_patch(int degree_u, int degree_v, const std::vector<double>& knots_u, const std::vector<double>& knots_v, const Grid<Point>& points,
                         const Grid<double>& weights) {
    check_shape(points, weights);
    check_knots(degree_u, knots_u, points.size(), "knots along u");
    check_knots(degree_v, knots_v, points[0].size(), "knots along v");
    return assemble(bezier_spans(degree_u, knots_u, points.size()), bezier_spans(degree_v, knots_v, points[0].size()), points, weights);
}

}  // namespace isoparm
