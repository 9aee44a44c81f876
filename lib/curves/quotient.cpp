#include "curves/quotient.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

std::vector<double> weights_of(const BezierPiece& p) { return p.weights.empty() ? std::vector<double>(p.points.size(), 1.0) : p.weights; }

/// Bezier coefficients of the same polynomial, of degree one higher.
template <class X> std::vector<X> elevated(const std::vector<X>& x) {
    const std::size_t n = x.size();
    std::vector<X> r(n + 1);
    for (std::size_t i = 0; i <= n; ++i) {
        const double a = double(i) / double(n);
        r[i] = i == 0 ? x.front() : i == n ? x.back() : a * x[i - 1] + (1 - a) * x[i];
    }
    return r;
}
/// Times the linear polynomial from `first` to `last`.
template <class X> std::vector<X> times_linear(const std::vector<X>& x, double first, double last) {
    const std::size_t n = x.size();
    std::vector<X> r(n + 1, X{});
    for (std::size_t i = 0; i <= n; ++i) {
        const double a = double(i) / double(n);
        if (i > 0) r[i] = r[i] + (a * last) * x[i - 1];
        if (i < n) r[i] = r[i] + ((1 - a) * first) * x[i];
    }
    return r;
}
std::vector<Point> over(std::vector<Point> numerator, const std::vector<double>& weights) {
    for (std::size_t i = 0; i < numerator.size(); ++i) numerator[i] = numerator[i] / weights[i];
    return numerator;
}

BezierPiece derivative(const BezierPiece& p) {
    const int n = p.degree();
    const auto w = weights_of(p);
    // E' w^2 = sum over i < j of (j - i) binomial(n,i) binomial(n,j) w_i w_j (P_j - P_i) s^(i+j-1) (1-s)^(2n-i-j-1) / h
    std::vector<Point> slope(std::max(2 * n - 1, 1));
    std::vector<double> squared(2 * n + 1);
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
            const double product = binomial(n, i) * binomial(n, j) * (w[i] * w[j]);
            squared[i + j] += product / binomial(2 * n, i + j);
            if (i < j) slope[i + j - 1] += ((j - i) * product / binomial(2 * n - 2, i + j - 1) / (p.end - p.begin)) * (p.points[j] - p.points[i]);
        }
    while (int(slope.size()) < 2 * n + 1) slope = elevated(slope);
    return {p.begin, p.end, over(slope, squared), std::move(squared)};
}

/// Of the piece that begins (or ends) in the end itself: as sum binomial(n,i) s^i (1-s)^(n-i) w_i (P_i - P_0) is s times such a sum.
BezierPiece difference_at_end(BezierPiece p, bool first) {
    const int n = p.degree();
    const auto w = weights_of(p);
    std::vector<Point> q(std::max(n, 1));
    for (int i = 0; i < n; ++i) {
        const int k = first ? i + 1 : i, steps = first ? i + 1 : n - i;
        q[i] = (n * w[k] / (steps * (p.end - p.begin))) * (first ? p.points[k] - p.points[0] : p.points[n] - p.points[k]);
    }
    if (p.weights.empty()) p.points = std::move(q);
    else p.points = over(n == 0 ? q : elevated(q), w);
    return p;
}
/// Of another piece, where t - e has one sign: its absolute value joins the weights.
BezierPiece difference_beyond(BezierPiece p, const Point& at_end, double end) {
    const bool after = p.begin >= end;
    const auto w = weights_of(p);
    std::vector<Point> numerator(w.size());
    for (std::size_t i = 0; i < w.size(); ++i) numerator[i] = w[i] * (after ? p.points[i] - at_end : at_end - p.points[i]);
    p.weights = times_linear(w, std::fabs(p.begin - end), std::fabs(p.end - end));
    p.points = over(elevated(numerator), p.weights);
    return p;
}

bool usable(const std::vector<BezierPiece>& pieces) {
    return std::all_of(pieces.begin(), pieces.end(), [](const BezierPiece& p) {
        return p.degree() <= max_degree && std::all_of(p.points.begin(), p.points.end(), [](const Point& x) { return finite(x); }) &&
               std::all_of(p.weights.begin(), p.weights.end(), [](double w) { return w > 0 && std::isfinite(w); });
    });
}
std::optional<Curve> curve_of(std::vector<BezierPiece> pieces, std::vector<int> continuity) {
    if (!usable(pieces)) return {};
    return make_piecewise_bezier(std::move(pieces), std::move(continuity));
}

}  // namespace

std::optional<Curve> rational_derivative(const PiecewiseBezier& c) {
    std::vector<BezierPiece> pieces;
    for (const auto& p : c.pieces()) {
        if (2 * p.degree() > max_degree) return {};
        pieces.push_back(derivative(p));
    }
    auto continuity = c.continuity();
    for (auto& k : continuity) --k;
    return curve_of(std::move(pieces), std::move(continuity));
}

std::optional<Curve> rational_difference(const PiecewiseBezier& c, CurveEnd end) {
    const bool first = end == CurveEnd::first;
    const std::size_t own = first ? 0 : c.pieces().size() - 1;
    const Point at_end = first ? c.pieces()[own].points.front() : c.pieces()[own].points.back();
    std::vector<BezierPiece> pieces;
    for (std::size_t k = 0; k < c.pieces().size(); ++k)
        pieces.push_back(k == own ? difference_at_end(c.pieces()[k], first) : difference_beyond(c.pieces()[k], at_end, first ? c.begin() : c.end()));
    return curve_of(std::move(pieces), c.continuity());
}

}  // namespace isoparm
