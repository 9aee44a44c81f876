#include <algorithm>

#include "joints/edge_cells.h"
#include "promises.h"

namespace isoparm {
namespace {

using Models = Vec3<TaylorModel>;

/// A curve as numerators and their denominator, if it is a quotient between two breaks.
struct CurveForm {
    Vec3<Quotient> x;
    Polynomial w;
    CurveForm(const Curve& curve, double from, double to) : x(curve.quotient(Polynomial::variable_u(Interval(from, to)))), w(common_denominator(x)) {}
    bool exists() const { return x.x.over.exists() && x.y.over.exists() && x.z.over.exists() && w.exists(); }
};
TaylorModel model_of(const Polynomial& p, const TaylorModel& t) {
    TaylorModel r;
    for (int k = p.degree_u(); k >= 0; --k) r = r * t + TaylorModel(p.coefficient(k, 0));
    return r;
}

/// A curve over [from, to] as a model over [middle - half, middle + half] of s in [0,1].
Models model_of(const Curve& curve, const CurveForm& exact, double from, double to, double middle, double half) {
    const Interval step = Interval(to) - Interval(from), m = Interval(from) + step * Interval(middle), h = step * Interval(half);
    Models r;
    if (exact.exists()) {
        const TaylorModel t = TaylorModel::linear(m - Interval(mid(Interval(from, to))), h), w = model_of(exact.w, t);
        for (int axis = 0; axis < 3; ++axis) {
            r[axis] = model_of(exact.x[axis].over, t);
            if (exact.w.degree_u() > 0) r[axis] = r[axis] / w;
        }
        return r;
    }
    const Interval reach(std::max(curve.begin(), (m - h).lo), std::min(curve.end(), (m + h).hi));
    if (const auto model = reach.lo < reach.hi ? curve(Polynomial::model_u(reach)) : Vec3<Polynomial>{Polynomial::nothing(), 0, 0}; model.x.exists() && model.y.exists() && model.z.exists()) {
        const TaylorModel t = TaylorModel::linear(m - Interval(mid(reach)), h);
        for (int axis = 0; axis < 3; ++axis) {
            r[axis] = model_of(model[axis], t);
            r[axis].widen(Interval(-model[axis].rest().f, model[axis].rest().f));
        }
        return r;
    }
    Vec3<Interval> at[4], over[4];
    const Interval centre = clip(m, {curve.begin(), curve.end()});
    curve.taylor(centre, 3, at);
    curve.taylor(reach, 3, over);
    const TaylorModel t = TaylorModel::linear(0, h);
    for (int axis = 0; axis < 3; ++axis) {
        // Of the orders that have a bound over the whole of it, the highest.
        int top = 3;
        while (top > 0 && !(over[top][axis].bounded() && at[top - 1][axis].bounded())) --top;
        r[axis] = TaylorModel(over[top][axis]);
        for (int k = top - 1; k >= 0; --k) r[axis] = r[axis] * t + TaylorModel(at[k][axis]);
    }
    return r;
}

}  // namespace

JumpBound bound_residual(const Patch& of, const Promise& promise, double tolerance) {
    const Patch& patch = promise.on_edge ? *promise.on_edge : of;
    const Vec2 from = promise.line.from, to = promise.line.to, cross = promise.line.cross;
    const Curve& curve = promise.curve;
    // Cut where the line leaves a cell of the patch, and at the breaks of the curve.
    std::vector<std::pair<double, double>> cuts{{0, curve.begin()}, {1, curve.end()}};
    const double length = curve.end() - curve.begin();
    for (const Break& b : curve.breaks()) cuts.push_back({(b.t - curve.begin()) / length, b.t});
    const bool along_u = from.y == to.y;
    if (patch.domain() == Domain::quad)
        for (const double t : along_u ? patch.breaks_u() : patch.breaks_v()) {
            const double start = along_u ? from.x : from.y, s = (t - start) / ((along_u ? to.x : to.y) - start);
            if (std::none_of(cuts.begin(), cuts.end(), [&](const auto& c) { return std::fabs(c.first - s) < 1e-12; })) cuts.push_back({s, curve.begin() + s * length});
        }
    else if (const int edge = edge_of_triangle(from, to); edge >= 0)
        for (const double s : form_breaks(patch, edge))
            if (std::none_of(cuts.begin(), cuts.end(), [&](const auto& c) { return std::fabs(c.first - s) < 1e-12; })) cuts.push_back({s, curve.begin() + s * length});
    std::sort(cuts.begin(), cuts.end());
    std::vector<EdgeSegment> segments;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        const auto [s0, t0] = cuts[k];
        const auto [s1, t1] = cuts[k + 1];
        const auto place = [&](double s) { return s == 0 ? from : s == 1 ? to : Vec2{from.x + s * (to.x - from.x), from.y + s * (to.y - from.y)}; };
        const EdgeSide side(patch, {place(s0), place(s1), cross}, cross);
        EdgeSegment e{side, side, {}, {}, {}, promise.derivative, {}};
        e.curve = [curve, exact = CurveForm(curve, t0, t1), a = t0, b = t1](double middle, double half) { return model_of(curve, exact, a, b, middle, half); };
        segments.push_back(std::move(e));
    }
    JumpLimits limits;
    limits.tolerance.fill(tolerance);
    if (promise.on_edge) limits.max_halvings *= 3;  // no singular ends: bounds of derivatives fall by 8 a doubling of the pieces, down to rounding
    JumpBound b = bound_jumps(segments, limits)[kC0];
    if (promise.slack > 0) b.lower = std::max(0.0, rounding::down(b.lower - promise.slack)), b.inside = rounding::up(b.inside + promise.slack), b.upper = rounding::up(b.upper + promise.slack);
    return b;
}

}  // namespace isoparm
