#include "joints/edge_side.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

using Jet2 = JetUV<TaylorModel, 2>;

/// Models are made over boxes that have some width: this part of the cell, into which nothing of the surface's second derivatives changes that could be seen.
constexpr double kStrip = 0x1p-30;

Interval with_width(const Interval& t, double low, double high) {
    const double strip = kStrip * (high - low);
    if (t.hi - t.lo >= strip) return t;
    return t.lo + strip <= high ? Interval(t.lo, t.lo + strip) : Interval(high - strip, high);
}

/// What a model leaves out, of a direction (a,b): bounds of the first and, halved, of the second derivative, and of the mixed one with (c,d).
double first(const Polynomial::Rest& r, double a, double b) { return r.u * std::fabs(a) + r.v * std::fabs(b); }
double mixed(const Polynomial::Rest& r, double a, double b, double c, double d) {
    return r.uu * std::fabs(a * c) + r.uv * (std::fabs(a * d) + std::fabs(b * c)) + r.vv * std::fabs(b * d);
}

/// Taylor coefficients f_l, l <= 2, in y at `at` of sum c_ij x^i y^j: each a polynomial in x.
std::array<std::vector<Interval>, 3> beside(const Polynomial& f, bool along_u, const Interval& at) {
    const int n = along_u ? f.degree_u() : f.degree_v(), m = along_u ? f.degree_v() : f.degree_u();
    std::array<std::vector<Interval>, 3> r;
    for (int l = 0; l <= 2; ++l)
        for (int i = 0; i <= n; ++i) {
            Interval sum(0);
            for (int j = m; j >= l; --j) sum = sum * at + Interval(binomial(j, l)) * (along_u ? f.coefficient(i, j) : f.coefficient(j, i));
            r[std::size_t(l)].push_back(sum);
        }
    return r;
}
/// sum of binomial(i, k) a_i x^(i - k)
TaylorModel derivative(const std::vector<Interval>& a, int k, const std::vector<TaylorModel>& powers) {
    TaylorModel sum;
    for (std::size_t i = std::size_t(k); i < a.size(); ++i) sum = sum + TaylorModel(Interval(binomial(int(i), k)) * a[i]) * powers[i - std::size_t(k)];
    return sum;
}

}  // namespace

/// Over a piece of a line u = const or v = const, from a model of the surface over a strip beside it: polynomials of degree 5, where enclosures have 3.
std::optional<EdgeSide::Jet> EdgeSide::modelled(const TaylorModel& s) const {
    const Interval reach = s.range();
    const bool along_u = line_.from.y == line_.to.y;
    if (!reach.bounded() || reach.lo == reach.hi || (!along_u && line_.from.x != line_.to.x)) return {};
    const Box thin = box(reach), strip{with_width(thin.u, cell_.u0, cell_.u1), with_width(thin.v, cell_.v0, cell_.v1)};
    const auto model = patch_.model(strip);
    if (model.empty()) return {};
    const double a = along_u ? line_.from.x : line_.from.y, b = along_u ? line_.to.x : line_.to.y, on = along_u ? line_.from.y : line_.from.x;
    const double along_rest = rounding::up(std::fabs(b - a)), across = along_u ? line_.cross.y : line_.cross.x, skew = along_u ? line_.cross.x : line_.cross.y;
    const Interval step = Interval(b) - Interval(a), cross(across), lean(skew);
    const TaylorModel x = TaylorModel(Interval(a) - Interval(mid(along_u ? strip.u : strip.v))) + TaylorModel(step) * s;
    const Interval y = Interval(on) - Interval(mid(along_u ? strip.v : strip.u));
    std::vector<TaylorModel> powers{TaylorModel(1.0)};
    for (int k = 0; k < 5; ++k) powers.push_back(powers.back() * x);
    Jet r;
    for (int axis = 0; axis < 3; ++axis) {
        const Polynomial& f = model[std::size_t(axis)];
        const auto c = beside(f, along_u, y);
        const TaylorModel f0 = derivative(c[0], 0, powers), f0x = derivative(c[0], 1, powers), f0xx = derivative(c[0], 2, powers);
        const TaylorModel f1 = derivative(c[1], 0, powers), f1x = derivative(c[1], 1, powers), f2 = derivative(c[2], 0, powers);
        auto& to = r[axis].c;
        to[0] = f0, to[1] = TaylorModel(step) * f0x, to[2] = TaylorModel(cross) * f1 + TaylorModel(lean) * f0x, to[3] = TaylorModel(step * step) * f0xx;
        to[4] = TaylorModel(step * cross) * f1x + TaylorModel(Interval(2) * step * lean) * f0xx;
        to[5] = TaylorModel(cross * cross) * f2 + TaylorModel(cross * lean) * f1x + TaylorModel(lean * lean) * f0xx;
        const Polynomial::Rest& rest = f.rest();
        const Vec2 d = along_u ? Vec2{along_rest, 0} : Vec2{0, along_rest}, e = line_.cross;
        const double out[] = {rest.f, first(rest, d.x, d.y), first(rest, e.x, e.y), 0.5 * mixed(rest, d.x, d.y, d.x, d.y), mixed(rest, d.x, d.y, e.x, e.y), 0.5 * mixed(rest, e.x, e.y, e.x, e.y)};
        for (int n = 0; n < Jet2::size; ++n) {
            const double wide = out[n] * (1 + 1e-12) + rounding::kTiny;
            to[n].widen(Interval(-wide, wide));
        }
    }
    return r;
}

}  // namespace isoparm
