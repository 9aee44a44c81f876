#include "bezier_cells.h"

#include "scalar/polynomial.h"

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

}  // namespace

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
