#include "curves/bezier_cells.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

/// Value at ends that are -1 (n - k times) and 1 (k times) of the blossom of x^i as a polynomial of degree n: the k-th Bernstein
/// coefficient of x^i over [-1,1].
double blossom_of_power(int i, int n, int k) {
    double sum = 0;
    for (int ones = 0; ones <= i; ++ones)
        if (ones <= k && i - ones <= n - k) sum += ((i - ones) % 2 ? -1 : 1) * binomial(k, ones) * binomial(n - k, i - ones);
    return sum / binomial(n, i);
}

/// From the poles of a curve its point at t, by de Casteljau.
template <class T> T casteljau(std::vector<T> b, double t) {
    for (std::size_t n = b.size(); n > 1; --n)
        for (std::size_t k = 0; k + 1 < n; ++k) b[k] = (1 - t) * b[k] + t * b[k + 1];
    return b[0];
}

/// What a term amounts to in the cell.
double size_of_term(const Polynomial& x, int i, int j, double hu, double hv) { return std::fabs(mid(x.coefficient(i, j))) * std::pow(hu, i) * std::pow(hv, j); }

/// Empty where a weight is not positive or a degree too high.
std::vector<BezierCell> bezier_cell(const std::vector<Polynomial>& form, double u0, double u1, double v0, double v1, int max_degree) {
    BezierCell cell{u0, u1, v0, v1, 1, 1, {}, {}};
    const double hu = 0.5 * (u1 - u0), hv = 0.5 * (v1 - v0);
    double largest = 0;
    const auto each_term = [&](auto f) {
        for (const Polynomial& x : form)
            for (int i = 0; i <= x.degree_u(); ++i)
                for (int j = 0; j <= x.degree_v(); ++j) f(size_of_term(x, i, j, hu, hv), i, j);
    };
    each_term([&](double size, int, int) { largest = std::max(largest, size); });
    each_term([&](double size, int i, int j) {  // the others are rounding errors
        if (size > 0x1p-51 * largest) cell.degree_u = std::max(cell.degree_u, i), cell.degree_v = std::max(cell.degree_v, j);
    });
    if (std::max(cell.degree_u, cell.degree_v) > max_degree) return {};
    std::vector<std::vector<double>> coordinate;
    for (const Polynomial& x : form) {
        std::vector<double> c;
        for (int i = 0; i <= cell.degree_u; ++i)
            for (int j = 0; j <= cell.degree_v; ++j) c.push_back(i <= x.degree_u() && j <= x.degree_v() ? mid(x.coefficient(i, j)) : 0);
        coordinate.push_back(bernstein_from_centred(c, cell.degree_u, cell.degree_v, hu, hv));
    }
    for (std::size_t k = 0; k < coordinate[0].size(); ++k) {
        const double w = form.size() == 4 ? coordinate[3][k] : 1;
        if (!(w > 0)) return {};
        cell.poles.push_back(Point{coordinate[0][k], coordinate[1][k], coordinate[2][k]} / w);
        if (form.size() == 4) cell.weights.push_back(w);
    }
    return {cell};
}

}  // namespace

std::vector<BezierCell> bezier_cells(const Patch& patch, int max_degree) {
    const auto us = patch.lines_u(), vs = patch.lines_v();
    std::vector<BezierCell> list;
    for (std::size_t i = 0; i + 1 < us.size(); ++i)
        for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
            const auto form = patch.exact_cell(i, j);
            const auto cell = form.size() < 3 ? std::vector<BezierCell>{} : bezier_cell(form, us[i], us[i + 1], vs[j], vs[j + 1], max_degree);
            if (cell.empty()) return {};
            list.push_back(cell[0]);
        }
    return list;
}

std::vector<double> bernstein_from_centred(const std::vector<double>& c, int p, int q, double hu, double hv) {
    const auto rows = std::size_t(p) + 1, columns = std::size_t(q) + 1;
    std::vector<double> half(rows * columns, 0), b(rows * columns, 0);
    double scale = 1;
    for (int j = 0; j <= q; ++j, scale *= hv)
        for (std::size_t i = 0; i < rows; ++i)
            for (int k = 0; k <= q; ++k) half[i * columns + std::size_t(k)] += c[i * columns + std::size_t(j)] * scale * blossom_of_power(j, q, k);
    scale = 1;
    for (int i = 0; i <= p; ++i, scale *= hu)
        for (std::size_t j = 0; j < columns; ++j)
            for (int k = 0; k <= p; ++k) b[std::size_t(k) * columns + j] += half[std::size_t(i) * columns + j] * scale * blossom_of_power(i, p, k);
    return b;
}

Point BezierCell::operator()(double u, double v) const {
    const double s = (u - u0) / (u1 - u0), t = (v - v0) / (v1 - v0);
    const auto columns = std::size_t(degree_v) + 1;
    std::vector<Point> points;
    std::vector<double> denominators;
    for (int i = 0; i <= degree_u; ++i) {
        std::vector<Point> row;
        std::vector<double> w;
        for (std::size_t k = std::size_t(i) * columns; k < (std::size_t(i) + 1) * columns; ++k) {
            w.push_back(weights.empty() ? 1 : weights[k]);
            row.push_back(w.back() * poles[k]);
        }
        points.push_back(casteljau(row, t));
        denominators.push_back(casteljau(w, t));
    }
    return casteljau(points, s) / casteljau(denominators, s);
}

}  // namespace isoparm
