#include "curves/modify.h"

#include <algorithm>

#include "curves/piecewise_bezier.h"
#include "error.h"

namespace isoparm {
namespace {

/// c(offset + slope t) over [begin, end]
struct AffineParameter {
    Curve curve;
    double begin, end, offset, slope;
    std::vector<Break> breaks() const {
        std::vector<Break> list;
        for (const auto& b : curve.breaks()) {
            const double t = (b.t - offset) / slope;
            if (t > begin && t < end) list.push_back({t, b.continuity});
        }
        std::sort(list.begin(), list.end(), [](const Break& x, const Break& y) { return x.t < y.t; });
        return list;
    }
    template <class S> auto operator()(const S& t) const { return curve(kept_in(t * slope + offset, curve.begin(), curve.end())); }
    Vec3<Polynomial> operator()(const Polynomial& t) const { return curve(place(t)); }
    Vec3<Quotient> quotient(const Polynomial& t) const { return curve.quotient(place(t)); }
    Polynomial place(const Polynomial& t) const { return t * Polynomial(slope) + Polynomial(offset); }
};

struct Moved {
    Curve curve;
    Transform map;
    double begin = curve.begin(), end = curve.end();
    std::vector<Break> breaks() const { return curve.breaks(); }
    template <class S> auto operator()(const S& t) const { return map.point(curve(t)); }
    Vec3<Quotient> quotient(const Polynomial& t) const { return map.point(curve.quotient(t)); }
};

struct Combination {
    std::vector<double> weights;
    std::vector<Curve> curves;
    double begin = curves[0].begin(), end = curves[0].end();
    std::vector<Break> breaks() const { return breaks_of(curves); }
    template <class S> auto operator()(const S& t) const {
        auto sum = S(weights[0]) * curves[0](t);
        for (std::size_t k = 1; k < curves.size(); ++k) sum = sum + S(weights[k]) * curves[k](t);
        return sum;
    }
    Vec3<Quotient> quotient(const Polynomial& t) const {
        Vec3<Quotient> sum;
        for (std::size_t k = 0; k < curves.size(); ++k) sum = sum + Quotient(weights[k]) * curves[k].quotient(t);
        return sum;
    }
};

struct Homogeneous {
    std::vector<Point> points;  // weight times point
    std::vector<double> weights;
};

/// The points of both halves after one run of de Casteljau's scheme at s.
void split(const BezierPiece& piece, double s, BezierPiece* left, BezierPiece* right) {
    const int n = piece.degree();
    const bool rational = !piece.weights.empty();
    std::vector<Point> p = piece.points;
    std::vector<double> w = rational ? piece.weights : std::vector<double>(n + 1, 1.0);
    if (rational)
        for (int i = 0; i <= n; ++i) p[i] = w[i] * p[i];
    Homogeneous low{std::vector<Point>(n + 1), std::vector<double>(n + 1)}, high = low;
    for (int level = 0; level <= n; ++level) {
        low.points[level] = p[0];
        low.weights[level] = w[0];
        high.points[n - level] = p[n - level];
        high.weights[n - level] = w[n - level];
        for (int i = 0; i < n - level; ++i) {
            p[i] = (1 - s) * p[i] + s * p[i + 1];
            w[i] = (1 - s) * w[i] + s * w[i + 1];
        }
    }
    const double t = piece.begin + s * (piece.end - piece.begin);
    const auto finish = [&](Homogeneous& h, double begin, double end) {
        if (rational)
            for (int i = 0; i <= n; ++i) h.points[i] = h.points[i] / h.weights[i];
        return BezierPiece{begin, end, h.points, rational ? h.weights : std::vector<double>{}};
    };
    if (left) *left = finish(low, piece.begin, t);
    if (right) *right = finish(high, t, piece.end);
}

std::vector<Point> elevated(std::vector<Point> p, int degree) {
    while (static_cast<int>(p.size()) - 1 < degree) {
        const double n = static_cast<double>(p.size());
        std::vector<Point> q(p.size() + 1);
        for (std::size_t i = 0; i < q.size(); ++i) {
            const double a = double(i) / n;
            q[i] = i == 0 ? p[0] : i == p.size() ? p.back() : a * p[i - 1] + (1 - a) * p[i];
        }
        p = std::move(q);
    }
    return p;
}

}  // namespace

Curve reversed(const Curve& c) {
    const auto* b = c.bezier();
    if (!b) return make_curve(AffineParameter{c, c.begin(), c.end(), c.begin() + c.end(), -1});
    auto pieces = b->pieces();
    std::reverse(pieces.begin(), pieces.end());
    for (auto& p : pieces) {
        std::reverse(p.points.begin(), p.points.end());
        std::reverse(p.weights.begin(), p.weights.end());
        const double begin = c.begin() + (c.end() - p.end);
        p.end = c.begin() + (c.end() - p.begin);
        p.begin = begin;
    }
    auto continuity = b->continuity();
    std::reverse(continuity.begin(), continuity.end());
    return make_piecewise_bezier(std::move(pieces), std::move(continuity));
}

Curve segment(const Curve& c, double from, double to, bool unit) {
    if (!(c.begin() <= from && from < to && to <= c.end()))
        throw_input("found the interval [" + to_text(from) + ", " + to_text(to) + "], expected one inside the curve's domain [" + to_text(c.begin()) + ", " +
                    to_text(c.end()) + "]");
    const auto* b = c.bezier();
    if (!b) {
        const double begin = unit ? 0 : from, end = unit ? 1 : to, slope = (to - from) / (end - begin);
        return make_curve(AffineParameter{c, begin, end, from - slope * begin, slope});
    }
    // A break that differs from an end of the interval by rounding is that end: no piece of such a width is made.
    const double tolerance = std::min(break_rounding * (c.end() - c.begin()), 1e-3 * (to - from));
    std::vector<BezierPiece> pieces;
    std::vector<int> continuity;
    for (std::size_t k = 0; k < b->pieces().size(); ++k) {
        BezierPiece p = b->pieces()[k];
        if (p.end <= from + tolerance || p.begin >= to - tolerance) continue;
        if (p.end > to + tolerance) split(p, (to - p.begin) / (p.end - p.begin), &p, nullptr);
        if (p.end > to - tolerance) p.end = to;
        if (p.begin < from - tolerance) split(p, (from - p.begin) / (p.end - p.begin), nullptr, &p);
        if (p.begin < from + tolerance) p.begin = from;
        if (!pieces.empty()) continuity.push_back(b->continuity()[k - 1]);
        pieces.push_back(std::move(p));
    }
    const Curve cut = make_piecewise_bezier(std::move(pieces), std::move(continuity));
    return unit ? reparametrized(cut, 0, 1) : cut;
}

Curve transformed(const Curve& c, const Transform& m) {
    const auto* b = c.bezier();
    if (!b) return make_curve(Moved{c, m});
    auto pieces = b->pieces();
    for (auto& p : pieces)
        for (auto& x : p.points) x = m.point(x);
    return make_piecewise_bezier(std::move(pieces), b->continuity());
}

Curve linear_combination(const std::vector<double>& weights, const std::vector<Curve>& curves) {
    Combination sum{weights, curves};
    for (const auto& c : curves)
        if (!c.bezier() || c.bezier()->rational()) return make_curve(sum);
    std::vector<double> ends{sum.begin};
    std::vector<int> continuity;
    for (const auto& b : sum.breaks()) {
        ends.push_back(b.t);
        continuity.push_back(b.continuity);
    }
    ends.push_back(sum.end);
    std::vector<BezierPiece> pieces;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        std::vector<BezierPiece> parts;
        int degree = 0;
        for (const auto& c : curves) {
            parts.push_back(segment(c, ends[k], ends[k + 1], false).bezier()->pieces().front());
            degree = std::max(degree, parts.back().degree());
        }
        std::vector<Point> total(degree + 1);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto p = elevated(parts[i].points, degree);
            for (int j = 0; j <= degree; ++j) total[j] += weights[i] * p[j];
        }
        pieces.push_back({ends[k], ends[k + 1], std::move(total), {}});
    }
    return make_piecewise_bezier(std::move(pieces), std::move(continuity));
}

}  // namespace isoparm
