#include "curves/difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "piecewise_bezier.h"

namespace isoparm {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
double unknown(double) { return kUnknown; }
Interval unknown(const Interval&) { return Interval::all(); }

constexpr int kMost = 8;  // orders that are asked for here
/// Taylor coefficients that a curve knows. Derivatives of derivatives of Bezier curves need more than the 3 that every curve has.
int known_order(const Curve& c) { return c.bezier() ? kMost : 3; }

/// What a curve must answer on packs, by its answers on numbers.
template <class C> void lane_by_lane(const C& c, const Pack& t, int order, Vec3<Pack>* out) {
    Vec3<double> one[4];
    for (int i = 0; i < Pack::lanes; ++i) {
        c.taylor(t[i], order, one);
        for (int k = 0; k <= order; ++k)
            for (int axis = 0; axis < 3; ++axis) out[k][axis].set(i, one[k][axis]);
    }
}

class Derivative final : public Curve::Concept {
public:
    explicit Derivative(Curve c) : c_(std::move(c)) {}
    double begin() const override { return c_.begin(); }
    double end() const override { return c_.end(); }
    std::vector<Break> breaks() const override {
        auto list = c_.breaks();
        for (auto& b : list) --b.continuity;
        return list;
    }
    void taylor(double t, int order, Vec3<double>* out) const override { run(t, order, out); }
    void taylor(const Pack& t, int order, Vec3<Pack>* out) const override { lane_by_lane(*this, t, order, out); }
    void taylor(const Interval& t, int order, Vec3<Interval>* out) const override { run(t, order, out); }

private:
    template <class T> void run(const T& t, int order, Vec3<T>* out) const {
        Vec3<T> e[kMost + 1];
        const int known = std::min(order + 1, known_order(c_));
        c_.taylor(t, known, e);
        for (int k = 0; k <= order; ++k) out[k] = k < known ? T(k + 1.0) * e[k + 1] : Vec3<T>{unknown(t), unknown(t), unknown(t)};
    }
    Curve c_;
};

/// Nodes and weights of Gauss and Legendre on [0,1]: exact to degree 23.
struct Gauss {
    static constexpr int count = 12;
    std::array<double, count> node, weight;
    Gauss() {
        for (int i = 0; i < count; ++i) {
            double x = std::cos(M_PI * (i + 0.75) / (count + 0.5)), slope = 1;
            for (int step = 0; step < 8; ++step) {  // Newton on the Legendre polynomial
                double p = 1, before = 0;
                for (int n = 1; n <= count; ++n) {
                    const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
                    before = p, p = next;
                }
                slope = count * (x * p - before) / (x * x - 1);
                x -= p / slope;
            }
            node[i] = 0.5 * (1 + x);
            weight[i] = 1 / ((1 - x * x) * slope * slope);
        }
    }
};

class DividedDifference final : public Curve::Concept {
public:
    DividedDifference(Curve c, double end) : c_(std::move(c)), end_(end), value_(c_(end)) {
        c_.taylor(Interval(end_), 0, &enclosure_);
        near_ = 0.25 * (c_.end() - c_.begin());
        for (const auto& b : c_.breaks()) near_ = std::min(near_, std::fabs(b.t - end_));
    }
    double begin() const override { return c_.begin(); }
    double end() const override { return c_.end(); }
    std::vector<Break> breaks() const override { return c_.breaks(); }

    /// Near the end by quadrature (the curve is smooth up to its first break), elsewhere from q_k (t - e) = E_k - q_(k-1).
    void taylor(double t, int order, Vec3<double>* out) const override {
        const double d = t - end_;
        Vec3<double> e[4];
        c_.taylor(t, order, e);
        if (std::fabs(d) <= near_) integrate(d, std::min(order, 2), out);
        for (int k = 0; k <= order; ++k)
            if (std::fabs(d) > near_ || k > 2 || !finite(out[k])) out[k] = (e[k] - (k == 0 ? value_ : out[k - 1])) / d;
    }
    void taylor(const Pack& t, int order, Vec3<Pack>* out) const override { lane_by_lane(*this, t, order, out); }
    void taylor(const Interval& t, int order, Vec3<Interval>* out) const override {
        const Interval d = t - Interval(end_);
        const int known = std::min(order + 1, known_order(c_));
        Vec3<Interval> from_end[kMost + 1], here[kMost + 1];
        c_.taylor(hull(t, Interval(end_)), known, from_end);
        c_.taylor(t, order, here);
        for (int k = 0; k <= order; ++k)
            for (int axis = 0; axis < 3; ++axis) {
                const Interval rest = k == 0 ? enclosure_[axis] : out[k - 1][axis];
                out[k][axis] = intersection(k < known ? from_end[k + 1][axis] : Interval::all(), (here[k][axis] - rest) / d);
            }
        if (t.lo == t.hi || order == 0) return;
        // Mean values: q_k(t) lies in q_k(m) + (k + 1) q_(k+1) (t - m).
        const double m = mid(t);
        Vec3<Interval> middle[4];
        taylor(Interval(m), order, middle);
        for (int k = order - 1; k >= 0; --k)
            for (int axis = 0; axis < 3; ++axis)
                out[k][axis] = intersection(out[k][axis], middle[k][axis] + Interval(k + 1.0) * out[k + 1][axis] * (t - Interval(m)));
    }

private:
    /// q_k = (k + 1) times the integral of s^k E_(k+1)(e + s d)
    void integrate(double d, int order, Vec3<double>* out) const {
        static const Gauss gauss;
        std::fill(out, out + order + 1, Point{});
        for (int i = 0; i < Gauss::count; ++i) {
            Vec3<double> e[4];
            c_.taylor(end_ + gauss.node[i] * d, order + 1, e);
            double weight = gauss.weight[i];
            for (int k = 0; k <= order; ++k, weight *= gauss.node[i]) out[k] += (k + 1) * weight * e[k + 1];
        }
    }
    Curve c_;
    double end_, near_;
    Point value_;
    Vec3<Interval> enclosure_;
};

bool polynomial(const PiecewiseBezier* b) { return b && !b->rational(); }

}  // namespace

Curve derivative_curve(const Curve& c) {
    if (!polynomial(c.bezier())) return Curve(std::make_shared<Derivative>(c));
    auto pieces = c.bezier()->pieces();
    auto continuity = c.bezier()->continuity();
    for (auto& k : continuity) --k;
    for (auto& p : pieces) {
        const int n = p.degree();
        std::vector<Point> slope(std::max(n, 1));
        for (int i = 0; i < n; ++i) slope[i] = (n / (p.end - p.begin)) * (p.points[i + 1] - p.points[i]);
        p.points = std::move(slope);
    }
    return make_piecewise_bezier(std::move(pieces), std::move(continuity));
}

Curve divided_difference(const Curve& c, CurveEnd end) {
    const bool first = end == CurveEnd::first;
    if (!polynomial(c.bezier()) || c.bezier()->pieces().size() > 1)
        return Curve(std::make_shared<DividedDifference>(c, first ? c.begin() : c.end()));
    BezierPiece p = c.bezier()->pieces().front();
    const int n = p.degree();
    std::vector<Point> q(std::max(n, 1));
    for (int i = 0; i < n; ++i)
        q[i] = (n / (p.end - p.begin)) * (first ? (p.points[i + 1] - p.points[0]) / (i + 1.0) : (p.points[n] - p.points[i]) / double(n - i));
    p.points = std::move(q);
    return make_piecewise_bezier({p}, {});
}

}  // namespace isoparm
