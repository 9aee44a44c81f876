#include "curves/bspline.h"

#include <cmath>

#include "curves/piecewise_bezier.h"
#include "error.h"

namespace isoparm {
namespace {

/// Value of the blossom of span [knots[k], knots[k+1]] at the arguments x, as weights of the control points k-p..k.
std::vector<double> blossom(int p, const std::vector<double>& knots, int k, const std::vector<double>& x) {
    std::vector<std::vector<double>> d(p + 1, std::vector<double>(p + 1, 0.0));
    for (int j = 0; j <= p; ++j) d[j][j] = 1;
    for (int r = 1; r <= p; ++r)
        for (int j = p; j >= r; --j) {
            const int i = k - p + j;  // de Boor's index
            const double left = knots[i], right = knots[i + p - r + 1];
            const double a = (x[r - 1] - left) / (right - left);
            for (int c = 0; c <= p; ++c) d[j][c] = (1 - a) * d[j - 1][c] + a * d[j][c];
        }
    return d[p];
}

}  // namespace

void check_knots(int degree, const std::vector<double>& knots, std::size_t points, const std::string& what) {
    if (degree < 1 || degree > max_degree)
        throw_input(what + ": found degree " + std::to_string(degree) + ", expected 1 to " + std::to_string(max_degree));
    if (points < static_cast<std::size_t>(degree) + 1)
        throw_input(what + ": found " + std::to_string(points) + " points for degree " + std::to_string(degree) + ", expected at least " +
                    std::to_string(degree + 1));
    if (knots.size() != points + degree + 1)
        throw_input(what + ": found " + std::to_string(knots.size()) + " knots, expected points + degree + 1 = " +
                    std::to_string(points + degree + 1));
    int multiplicity = 1;
    for (std::size_t i = 0; i < knots.size(); ++i) {
        if (!std::isfinite(knots[i])) throw_input(what + ": knot " + std::to_string(i) + " is not finite");
        if (i == 0) continue;
        if (knots[i] < knots[i - 1])
            throw_input(what + ": found knot " + std::to_string(i) + " = " + to_text(knots[i]) + " after " + to_text(knots[i - 1]) +
                        ", expected knots that do not decrease");
        multiplicity = knots[i] == knots[i - 1] ? multiplicity + 1 : 1;
        const bool interior = knots[i] > knots[degree] && knots[i] < knots[points];
        const int most = interior ? degree : degree + 1;
        if (multiplicity > most)
            throw_input(what + ": found knot " + to_text(knots[i]) + " " + std::to_string(multiplicity) + " times, expected at most " +
                        std::to_string(most) + " for degree " + std::to_string(degree));
    }
    if (!(knots[degree] < knots[points]))
        throw_input(what + ": found an empty domain [" + to_text(knots[degree]) + ", " + to_text(knots[points]) + "], expected knots[" +
                    std::to_string(degree) + "] < knots[" + std::to_string(points) + "]");
}

std::vector<BezierSpan> bezier_spans(int degree, const std::vector<double>& knots, std::size_t points) {
    std::vector<BezierSpan> spans;
    for (int k = degree; k < static_cast<int>(points); ++k) {
        if (!(knots[k] < knots[k + 1])) continue;
        BezierSpan s{knots[k], knots[k + 1], degree, {}, k - degree};
        std::vector<double> x(degree, s.begin);
        for (int i = 0; i <= degree; ++i) {
            s.rows.push_back(blossom(degree, knots, k, x));
            if (i < degree) x[i] = s.end;
        }
        for (std::size_t j = k + 1; j < knots.size() && knots[j] == s.end; ++j) --s.continuity_after;
        spans.push_back(std::move(s));
    }
    return spans;
}

Curve make_bspline(int degree, const std::vector<double>& knots, const std::vector<Point>& points, const std::vector<double>& weights) {
    check_knots(degree, knots, points.size(), "B-spline");
    if (!weights.empty() && weights.size() != points.size())
        throw_input("found " + std::to_string(weights.size()) + " weights for " + std::to_string(points.size()) + " points, expected one weight a point");
    for (double w : weights)
        if (!(w > 0 && std::isfinite(w))) throw_input("found weight " + to_text(w) + ", expected a positive number");
    std::vector<BezierPiece> pieces;
    std::vector<int> continuity;
    for (const auto& span : bezier_spans(degree, knots, points.size())) {
        BezierPiece piece{span.begin, span.end, {}, {}};
        for (const auto& row : span.rows) {
            Point sum;
            double total = 0;
            for (int k = 0; k <= degree; ++k) {
                const double w = row[k] * (weights.empty() ? 1 : weights[span.first + k]);
                sum += w * points[span.first + k];
                total += w;
            }
            piece.points.push_back(weights.empty() ? sum : sum / total);
            if (!weights.empty()) piece.weights.push_back(total);
        }
        pieces.push_back(std::move(piece));
        continuity.push_back(span.continuity_after);
    }
    continuity.pop_back();
    return make_piecewise_bezier(std::move(pieces), std::move(continuity));
}

}  // namespace isoparm
