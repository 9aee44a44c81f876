// optimal_triangles.cpp -- the asymptotic optimum, by the midpoint rule.
#include <tbb/parallel_for.h>

#include <cmath>

#include "tessellate.h"

namespace isoparm {
namespace {

constexpr int n = 32;  // samples of a cell along each parameter

struct Derivatives {
    Point u, v, uu, uv, vv;
};

/// Samples of a cell at one u, and the area of the domain that each stands for.
struct Row {
    double u = 0, area = 0;
    std::array<double, n> v{};
};

Row row_of(const Patch& patch, const Box& cell, int i) {
    const double width = cell.u.hi - cell.u.lo, height = cell.v.hi - cell.v.lo;
    Row row;
    row.u = cell.u.lo + width * (i + 0.5) / n;
    const double fold = patch.domain() == Domain::triangle ? 1 - row.u : 1;  // the square folded onto the triangle
    row.area = width * height / (n * n) * fold;
    for (int j = 0; j < n; ++j) row.v[j] = (cell.v.lo + height * (j + 0.5) / n) * fold;
    return row;
}

std::array<Derivatives, n> by_jets(const Patch& patch, const Row& row) {
    std::array<Derivatives, n> list;
    for (int j = 0; j < n; ++j) {
        const PointJet x = patch.jet(row.u, row.v[j]);
        const auto d = [&](int p, int q) { return Point{x.x.coefficient(p, q), x.y.coefficient(p, q), x.z.coefficient(p, q)}; };
        list[j] = {d(1, 0), d(0, 1), 2 * d(2, 0), d(1, 1), 2 * d(0, 2)};
    }
    return list;
}

/// The derivatives of a coordinate that is a polynomial in the cell, at all samples of a row: x and y are from the cell's middle.
void differentiate(const Polynomial& f, double x, const std::array<double, n>& y, double Point::*axis, std::array<Derivatives, n>& list) {
    const int p = f.degree_u(), q = f.degree_v();
    std::array<double, n> s{}, v{}, vv{}, u{}, uv{}, uu{};
    for (int j = q; j >= 0; --j) {
        double a = 0, b = 0, c = 0;  // along u: value, derivative, half the second derivative
        for (int i = p; i >= 0; --i) c = c * x + b, b = b * x + a, a = a * x + mid(f.coefficient(i, j));
        for (int k = 0; k < n; ++k) {
            vv[k] = vv[k] * y[k] + v[k], v[k] = v[k] * y[k] + s[k], s[k] = s[k] * y[k] + a;
            uv[k] = uv[k] * y[k] + u[k], u[k] = u[k] * y[k] + b;
            uu[k] = uu[k] * y[k] + 2 * c;
        }
    }
    for (int k = 0; k < n; ++k) {
        Derivatives& d = list[k];
        d.u.*axis = u[k], d.v.*axis = v[k], d.uu.*axis = uu[k], d.uv.*axis = uv[k], d.vv.*axis = 2 * vv[k];
    }
}

std::array<Derivatives, n> by_polynomials(const std::vector<Polynomial>& form, const Box& cell, const Row& row) {
    std::array<Derivatives, n> list;
    std::array<double, n> y;
    for (int j = 0; j < n; ++j) y[j] = row.v[j] - mid(cell.v);
    constexpr double Point::*axes[] = {&Point::x, &Point::y, &Point::z};
    for (int axis = 0; axis < 3; ++axis) differentiate(form[axis], row.u - mid(cell.u), y, axes[axis], list);
    return list;
}

struct Sums {
    double convex = 0, saddle = 0;
};

Sums sums_of(const std::array<Derivatives, n>& list, double area) {
    Sums sums;
    for (const Derivatives& d : list) {
        const Point normal = cross(d.u, d.v);
        const double size = length(normal);
        if (!(size > 0)) continue;
        const double L = dot(d.uu, normal) / size, M = dot(d.uv, normal) / size, N = dot(d.vv, normal) / size, k = L * N - M * M;
        if (std::isfinite(k)) (k > 0 ? sums.convex : sums.saddle) += std::sqrt(std::fabs(k)) * area;
    }
    return sums;
}

}  // namespace

// (0.3849 I+ + 0.2236 I-) / tolerance, I the integrals of sqrt|K| dA = sqrt|LN - M^2| du dv over K > 0 and K < 0, by the
// midpoint rule (Fejes Toth; Gruber; Atariah, Rote and Wintraecken 2018).
double optimal_triangles(const Patch& patch, double tolerance) {
    const std::vector<double> us = patch.lines_u(), vs = patch.lines_v();
    const std::size_t columns = us.size() - 1, rows = vs.size() - 1;
    std::vector<std::array<Sums, n>> parts(columns * rows);  // added in one order, whatever thread made them
    tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t cell) {
        const std::size_t a = cell / rows, b = cell % rows;
        const Box box{{us[a], us[a + 1]}, {vs[b], vs[b + 1]}};
        const std::vector<Polynomial> form = patch.exact_cell(a, b);
        const bool polynomial = form.size() == 3 && form[0].exists() && form[1].exists() && form[2].exists();
        tbb::parallel_for(tbb::blocked_range<int>(0, n, polynomial ? n : 2), [&](const tbb::blocked_range<int>& range) {
            for (int i = range.begin(); i < range.end(); ++i) {
                const Row row = row_of(patch, box, i);
                parts[cell][i] = sums_of(polynomial ? by_polynomials(form, box, row) : by_jets(patch, row), row.area);
            }
        });
    });
    Sums all;
    for (const auto& cell : parts)
        for (const Sums& s : cell) all.convex += s.convex, all.saddle += s.saddle;
    return (2 / (3 * std::sqrt(3.0)) * all.convex + 1 / (2 * std::sqrt(5.0)) * all.saddle) / tolerance;
}

}  // namespace isoparm
