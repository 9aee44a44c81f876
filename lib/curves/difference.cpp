#include "curves/difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "curves/lane_by_lane.h"
#include "curves/quotient.h"

namespace isoparm {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
double unknown(double) { return kUnknown; }
Interval unknown(const Interval&) { return Interval::all(); }

constexpr int kMost = 8;  // orders that are asked for here
/// Taylor coefficients that a curve knows. Derivatives of derivatives of Bezier curves need more than the 3 that every curve has.
int known_order(const Curve& c) { return c.bezier() ? kMost : 3; }

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

/// m = 1 or 2 times the divided difference with one end.
class DividedDifference final : public Curve::Concept {
public:
    DividedDifference(Curve c, double end, int times) : c_(std::move(c)), end_(end), times_(times) {
        c_.taylor(end_, times_ - 1, at_end_);
        c_.taylor(Interval(end_), times_ - 1, enclosed_);
        near_ = 0.25 * (c_.end() - c_.begin());
        for (const auto& b : c_.breaks()) near_ = std::min(near_, std::fabs(b.t - end_));
    }
    double begin() const override { return c_.begin(); }
    double end() const override { return c_.end(); }
    std::vector<Break> breaks() const override { return c_.breaks(); }

    /// Near the end by quadrature, which is exact to rounding where the curve is tame between t and the end; elsewhere by the recurrence. Nothing
    /// says how tame it is, so both have to lie in the enclosure at t: it is as wide as the rounding of the quotient, or less.
    void taylor(double t, int order, Vec3<double>* out) const override {
        const double d = t - end_;
        const int known = std::fabs(d) <= near_ ? std::min(order, known_order(c_) - times_) : -1;
        if (known >= 0) integrate(d, known, out);
        Vec3<double> e[kMost + 1];
        c_.taylor(t, order, e);
        divide(e, at_end_, d, order, e);
        for (int k = 0; k <= order; ++k)
            if (k > known || !finite(out[k])) out[k] = k == 0 || known < 0 ? e[k] : (e_of_lower(t, k) - out[k - 1]) / d;
        Vec3<Interval> enclosed[kMost + 1];
        taylor(Interval(t), order, enclosed);
        for (int k = 0; k <= order; ++k)
            for (int axis = 0; axis < 3; ++axis) out[k][axis] = std::clamp(out[k][axis], enclosed[k][axis].lo, enclosed[k][axis].hi);
    }
    void taylor(const Pack& t, int order, Vec3<Pack>* out) const override { lane_by_lane(*this, t, order, out); }
    void taylor(const Interval& t, int order, Vec3<Interval>* out) const override {
        const Interval d = t - Interval(end_);
        const int known = std::min(order + times_, known_order(c_));
        Vec3<Interval> from_end[kMost + 1], here[kMost + 1];
        c_.taylor(hull(t, Interval(end_)), known, from_end);
        c_.taylor(t, order, here);
        divide(here, enclosed_, d, order, here);
        for (int k = 0; k <= order; ++k)
            for (int axis = 0; axis < 3; ++axis)
                out[k][axis] = k + times_ <= known ? intersection(from_end[k + times_][axis], here[k][axis]) : here[k][axis];
        if (t.lo == t.hi || order == 0) return;
        // Mean values: q_k(t) lies in q_k(m) + (k + 1) q_(k+1) (t - m).
        const double m = mid(t);
        Vec3<Interval> middle[kMost + 1];
        taylor(Interval(m), order, middle);
        for (int k = order - 1; k >= 0; --k)
            for (int axis = 0; axis < 3; ++axis)
                out[k][axis] = intersection(out[k][axis], middle[k][axis] + Interval(k + 1.0) * out[k + 1][axis] * (t - Interval(m)));
    }

private:
    /// From q (t - e) = E - E(e): q_k = (E_k - q_(k-1)) / (t - e), once or twice. The second time q(e) = E'(e). In and out may be the same.
    template <class T> void divide(const Vec3<T>* e, const Vec3<T>* at_end, const T& d, int order, Vec3<T>* out) const {
        for (int step = 0; step < times_; ++step) {
            const Vec3<T>* in = step == 0 ? e : out;
            for (int k = 0; k <= order; ++k) out[k] = (in[k] - (k == 0 ? at_end[step] : out[k - 1])) / d;
        }
    }
    /// What the last division divides: the k-th coefficient of the curve, or of its first divided difference.
    Point e_of_lower(double t, int k) const {
        Vec3<double> e[kMost + 1];
        if (times_ == 1) c_.taylor(t, k, e);
        else DividedDifference(c_, end_, 1).taylor(t, k, e);
        return e[k];
    }
    /// q_k = (k + m)! / k! times the integral of s^k (1 - s)^(m - 1) E_(k+m)(e + s (t - e)); the weights add up to 1.
    void integrate(double d, int order, Vec3<double>* out) const {
        static const Gauss gauss;
        std::fill(out, out + order + 1, Point{});
        for (int i = 0; i < Gauss::count; ++i) {
            const double s = gauss.node[i];
            Vec3<double> e[kMost + 1];
            c_.taylor(end_ + s * d, order + times_, e);
            double weight = gauss.weight[i] * (times_ == 2 ? 1 - s : 1);
            for (int k = 0; k <= order; ++k, weight *= s) out[k] += (times_ == 2 ? (k + 1) * (k + 2) : k + 1) * weight * e[k + times_];
        }
    }
    Curve c_;
    double end_, near_;
    int times_;
    Point at_end_[2];
    Vec3<Interval> enclosed_[2];
};

bool polynomial(const PiecewiseBezier* b) { return b && !b->rational(); }

}  // namespace

Curve derivative_curve(const Curve& c) {
    if (!polynomial(c.bezier())) {
        const auto exact = c.bezier() ? rational_derivative(*c.bezier()) : std::nullopt;
        return exact ? *exact : Curve(std::make_shared<Derivative>(c));
    }
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

Curve divided_difference(const Curve& c, CurveEnd end, int times) {
    const auto once = c.bezier() ? rational_difference(*c.bezier(), end) : std::nullopt;
    if (!once) return Curve(std::make_shared<DividedDifference>(c, end == CurveEnd::first ? c.begin() : c.end(), times));
    return times == 1 ? *once : divided_difference(*once, end, times - 1);
}

}  // namespace isoparm
