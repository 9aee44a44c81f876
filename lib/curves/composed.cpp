#include "curves/composed.h"

#include <algorithm>
#include <array>

#include "curves/piecewise_bezier.h"
#include "error.h"

namespace isoparm {
namespace {

/// phi over [t0, t1] by its values and slopes at the ends.
struct Cubic {
    double t0, t1, s0, s1, m0, m1;
    std::array<double, 4> bezier() const {
        const double h = (t1 - t0) / 3;
        return {s0, s0 + h * m0, s1 - h * m1, s1};
    }
    double operator()(double t) const {
        const auto b = bezier();
        const double x = (t - t0) / (t1 - t0), y = 1 - x;
        return y * y * y * b[0] + 3 * x * y * (y * b[1] + x * b[2]) + x * x * x * b[3];
    }
    double slope(double t) const {
        const auto b = bezier();
        const double x = (t - t0) / (t1 - t0), y = 1 - x;
        return 3 * (y * y * (b[1] - b[0]) + 2 * x * y * (b[2] - b[1]) + x * x * (b[3] - b[2])) / (t1 - t0);
    }
    /// Where phi is s, s0 < s < s1: bisection, phi is monotone.
    double inverse(double s) const {
        double low = t0, high = t1;
        for (int k = 0; k < 200; ++k) {
            const double middle = low + 0.5 * (high - low);
            if (!(low < middle && middle < high)) break;
            ((*this)(middle) < s ? low : high) = middle;
        }
        return high < t1 ? high : low;
    }
};

std::vector<Cubic> monotone_cubics(const std::vector<double>& t, const std::vector<double>& s) {
    const std::size_t n = t.size() - 1;
    std::vector<double> secant(n), m(n + 1);
    for (std::size_t k = 0; k < n; ++k) secant[k] = (s[k + 1] - s[k]) / (t[k + 1] - t[k]);
    for (std::size_t k = 1; k < n; ++k) m[k] = 2 / (1 / secant[k - 1] + 1 / secant[k]);
    m[0] = n == 1 ? secant[0] : (3 * secant[0] - m[1]) / 2;
    m[n] = n == 1 ? secant[0] : (3 * secant[n - 1] - m[n - 1]) / 2;
    std::vector<Cubic> list;
    for (std::size_t k = 0; k < n; ++k) list.push_back({t[k], t[k + 1], s[k], s[k + 1], m[k], m[k + 1]});
    return list;
}

/// A point times its weight, and the weight.
struct Homogeneous {
    Point p;
    double w = 0;
    void add(double factor, const Homogeneous& h) { p += factor * h.p, w += factor * h.w; }
};
using Bernstein = std::vector<Homogeneous>;  // coefficients

/// b + x (c - b), x of degree 3: degrees add up (Farin 2002, 6.9).
Bernstein between(const Bernstein& b, const Bernstein& c, const std::array<double, 4>& x) {
    const int n = int(b.size()) - 1;
    Bernstein r(b.size() + 3);
    for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= 3; ++k) {
            const double share = binomial(n, i) * binomial(3, k) / binomial(n + 3, i + k);
            r[std::size_t(i + k)].add(share * (1 - x[std::size_t(k)]), b[std::size_t(i)]);
            r[std::size_t(i + k)].add(share * x[std::size_t(k)], c[std::size_t(i)]);
        }
    return r;
}

/// De Casteljau's scheme at the parameter x(t), a cubic with these coefficients (DeRose 1988).
BezierPiece composed(const BezierPiece& piece, double begin, double end, const std::array<double, 4>& x) {
    std::vector<Bernstein> level;
    for (std::size_t i = 0; i < piece.points.size(); ++i) {
        const double w = piece.weights.empty() ? 1 : piece.weights[i];
        level.push_back({{w * piece.points[i], w}});
    }
    for (; level.size() > 1; level.pop_back())
        for (std::size_t i = 0; i + 1 < level.size(); ++i) level[i] = between(level[i], level[i + 1], x);
    BezierPiece r{begin, end, {}, {}};
    for (const Homogeneous& h : level[0]) {
        r.points.push_back(piece.weights.empty() ? h.p : h.p / h.w);
        if (!piece.weights.empty()) r.weights.push_back(h.w);
    }
    return r;
}

}  // namespace

Curve run_by_monotone_cubic(const Curve& c, const std::vector<double>& t, const std::vector<double>& s) {
    const PiecewiseBezier* b = c.bezier();
    if (!b) throw_input("found a curve given by formulas, expected one of Bezier pieces: others cannot be run at another speed");
    const double near = 1e-12 * (s.back() - s.front());
    std::vector<BezierPiece> pieces;
    std::vector<int> continuity;
    const auto cubics = monotone_cubics(t, s);
    for (std::size_t k = 0; k < b->pieces().size(); ++k) {
        const BezierPiece& p = b->pieces()[k];
        if (3 * p.degree() > max_degree) throw_input("found a curve of degree " + std::to_string(p.degree()) + ", expected at most " + std::to_string(max_degree / 3) + " to run it at another speed");
        for (const Cubic& phi : cubics) {
            // Breaks that differ from a node by rounding are that node.
            const bool first = p.begin <= phi.s0 + near, last = p.end >= phi.s1 - near;
            if (p.end <= phi.s0 + near || p.begin >= phi.s1 - near) continue;
            const double begin = first ? phi.t0 : phi.inverse(p.begin), end = last ? phi.t1 : phi.inverse(p.end);
            if (!(begin < end)) continue;
            const auto at = [&](double x) { return (x - p.begin) / (p.end - p.begin); };
            const double from = first ? phi.s0 : p.begin, to = last ? phi.s1 : p.end, third = (end - begin) / 3;
            if (!pieces.empty()) continuity.push_back(pieces.back().end == phi.t0 ? (from <= p.begin + near ? std::min(1, b->continuity()[k - 1]) : 1) : b->continuity()[k - 1]);
            pieces.push_back(composed(p, begin, end, {at(from), at(from + third * phi.slope(begin)), at(to - third * phi.slope(end)), at(to)}));
            if (pieces.size() > 1) pieces.back().begin = pieces[pieces.size() - 2].end;
        }
    }
    return make_piecewise_bezier(std::move(pieces), std::move(continuity));
}

}  // namespace isoparm
