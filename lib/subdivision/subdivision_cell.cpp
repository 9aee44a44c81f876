#include "subdivision/subdivision_cell.h"

#include <array>
#include <cmath>
#include <map>

namespace isoparm {
namespace {

using Controls = std::vector<Vec3<Interval>>;

Point middle(const Vec3<Interval>& b) { return {mid(b.x), mid(b.y), mid(b.z)}; }

/// c[i][k]: 48 times the coefficient of x^i of the k-th uniform cubic B-spline on [-1/2, 1/2].
constexpr double kSpline[4][4] = {{1, 23, 23, 1}, {-6, -30, 30, 6}, {12, -12, -12, 12}, {-8, 24, -24, 8}};

/// The twelve basis functions of a regular Loop triangle, times 12, by the barycentric coordinates of the corners (Stam 1998).
template <class P> std::array<P, 12> box_splines(const P& u, const P& v, const P& w) {
    const auto corner = [](const P& a, const P& b, const P& c) {
        const P bc = b * c, bb = b * b, cc = c * c, aa = a * a;
        return P(6) * aa * aa + P(24) * aa * a * (b + c) + P(24) * aa * (bb + cc) + P(60) * aa * bc + P(8) * a * (bb * b + cc * c) + P(36) * a * bc * (b + c) + bb * bb +
               cc * cc + P(6) * bc * (bb + cc) + P(12) * bc * bc;
    };
    const auto across = [](const P& a, const P& b, const P& c) {
        const P ab = a * b, aa = a * a, bb = b * b;
        return aa * aa + bb * bb + P(6) * ab * (aa + bb) + P(12) * ab * ab + P(2) * c * (aa * a + bb * b) + P(6) * c * ab * (a + b);
    };
    const auto outer = [](const P& a, const P& b) { return a * a * a * (a + P(2) * b); };
    return {corner(u, v, w), corner(v, w, u), corner(w, u, v), across(u, v, w), across(v, w, u), across(w, u, v),
            outer(u, v),     outer(u, w),     outer(v, w),     outer(v, u),     outer(w, u),     outer(w, v)};
}

/// A homogeneous polynomial, by the exponents of u, v and w.
struct Form {
    std::map<std::array<int, 3>, double> c;
    Form() = default;
    explicit Form(int constant) { c[{0, 0, 0}] = constant; }
    explicit Form(std::map<std::array<int, 3>, double> terms) : c(std::move(terms)) {}
    friend Form operator+(Form a, const Form& b) {
        for (const auto& [e, x] : b.c) a.c[e] += x;
        return a;
    }
    friend Form operator*(const Form& a, const Form& b) {
        Form r;
        for (const auto& [d, x] : a.c)
            for (const auto& [e, y] : b.c) r.c[{d[0] + e[0], d[1] + e[1], d[2] + e[2]}] += x * y;
        return r;
    }
};

/// h to a power; h is a power of two, or minus one, so this is exact.
double power(double h, int n) { return std::ldexp(h < 0 && n % 2 ? -1.0 : 1.0, n * std::ilogb(h)); }

void keep_middles(SubdivisionCell& cell) {
    const auto& x = cell.exact;
    cell.c.resize((cell.degree + 1) * (cell.degree + 1));
    for (int i = 0; i <= cell.degree; ++i)
        for (int j = 0; j <= cell.degree; ++j)
            cell.c[(cell.degree + 1) * i + j] = {mid(x.x.coefficient(i, j)), mid(x.y.coefficient(i, j)), mid(x.z.coefficient(i, j))};
}

SubdivisionCell bicubic(const Controls& p, const FacePlace& at) {
    SubdivisionCell cell{at.u + at.h / 2, at.v + at.h / 2, {}, 3, {}};
    const Polynomial x = Polynomial::variable_u(at.across_u()), y = Polynomial::variable_v(at.across_v()), all = x * x * x * (y * y * y);
    for (int axis = 0; axis < 3; ++axis) {
        Polynomial& f = cell.exact[axis] = all;
        Interval rows[4][4];  // [i][l]: along u done
        for (int i = 0; i < 4; ++i)
            for (int l = 0; l < 4; ++l) {
                rows[i][l] = Interval(0);
                for (int k = 0; k < 4; ++k) rows[i][l] += Interval(kSpline[i][k]) * p[4 * k + l][axis];
            }
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                Interval sum(0);
                for (int l = 0; l < 4; ++l) sum += Interval(kSpline[j][l]) * rows[i][l];
                f.coefficient(i, j) = sum / Interval(2304) * Interval(power(at.h, -i - j));
            }
    }
    keep_middles(cell);
    return cell;
}

SubdivisionCell quartic(const Controls& p, const FacePlace& at) {
    static const auto basis = [] {  // in the triangle's own parameters
        const Polynomial v = Polynomial::variable_u({0, 1}), w = Polynomial::variable_v({0, 1});
        return box_splines<Polynomial>(Polynomial(1) - v - w, v, w);
    }();
    const Polynomial x = Polynomial::variable_u(at.across_u()), y = Polynomial::variable_v(at.across_v()), all = square(square(x)) * square(square(y));
    SubdivisionCell cell{at.u + at.h / 2, at.v + at.h / 2, {}, 4, {}};
    for (int axis = 0; axis < 3; ++axis) {
        Polynomial& f = cell.exact[axis] = all;
        for (int i = 0; i <= 4; ++i)
            for (int j = 0; j <= 4; ++j) {
                Interval sum(0);
                for (int k = 0; k < 12 && i + j <= 4; ++k)
                    if (i <= basis[k].degree_u() && j <= basis[k].degree_v()) sum += basis[k].coefficient(i, j) * p[k][axis];
                f.coefficient(i, j) = sum / Interval(12) * Interval(power(at.h, -i - j));
            }
    }
    keep_middles(cell);
    return cell;
}

}  // namespace

SubdivisionCell make_subdivision_cell(const Controls& control, const FacePlace& at, Scheme scheme) {
    return scheme == Scheme::loop ? quartic(control, at) : bicubic(control, at);
}

SubdivisionCell moved(SubdivisionCell cell, const Vec3<Interval>& by) {
    for (int axis = 0; axis < 3; ++axis) {
        Interval& c = cell.exact[axis].coefficient(0, 0);
        c = c + by[axis];
        cell.c[0][axis] = mid(c);
    }
    return cell;
}

std::vector<Point> bezier_points(const Controls& control, Scheme scheme) {
    // The Bezier points of a polynomial are its blossoms; of a cubic spline segment: 6 times the weights of its control points.
    static constexpr double cubic[4][4] = {{1, 4, 1, 0}, {0, 4, 2, 0}, {0, 2, 4, 0}, {0, 1, 4, 1}};
    std::vector<Point> result;
    if (scheme != Scheme::loop) {
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                Vec3<Interval> sum;
                for (int k = 0; k < 4; ++k)
                    for (int l = 0; l < 4; ++l) sum = sum + Interval(cubic[i][k] * cubic[j][l]) * control[4 * k + l];
                result.push_back(middle(sum / Interval(36)));
            }
        return result;
    }
    // A homogeneous form in u, v, w is its own Bernstein form, but for the multinomial coefficients; b_ijk belongs to weights that the patch calls w (corner 0), u, v.
    const auto variable = [](int k) { return Form({{{k == 0, k == 1, k == 2}, 1.0}}); };
    const auto basis = box_splines<Form>(variable(0), variable(1), variable(2));
    for (int k = 0; k <= 4; ++k)
        for (int j = 0; j + k <= 4; ++j) {
            const int i = 4 - j - k;
            Vec3<Interval> sum;
            for (int b = 0; b < 12; ++b)
                if (const auto term = basis[b].c.find({k, i, j}); term != basis[b].c.end()) sum = sum + Interval(term->second) * control[b];
            result.push_back(middle(sum / Interval(12 * binomial(4, i) * binomial(4 - i, j))));
        }
    return result;
}

}  // namespace isoparm
