#include "curve.h"

#include <algorithm>

#include "curves/modify.h"
#include "curves/piecewise_bezier.h"

namespace isoparm {
namespace {

struct Reparametrized {
    Curve curve;
    double begin, end;
    std::vector<Break> breaks() const {
        auto list = curve.breaks();
        for (auto& b : list) b.t = begin + (b.t - curve.begin()) * (end - begin) / (curve.end() - curve.begin());
        return list;
    }
    template <class S> auto operator()(const S& t) const {
        const double scale = (curve.end() - curve.begin()) / (end - begin);
        return curve(kept_in((t - begin) * scale + curve.begin(), curve.begin(), curve.end()));
    }
    Vec3<Polynomial> operator()(const Polynomial& t) const { return curve(place(t)); }
    Vec3<Quotient> quotient(const Polynomial& t) const { return curve.quotient(place(t)); }

private:
    Polynomial place(const Polynomial& t) const {
        const double scale = (curve.end() - curve.begin()) / (end - begin);
        return (t - Polynomial(begin)) * Polynomial(scale) + Polynomial(curve.begin());
    }
};

}  // namespace

/// Of a model: a cubic, and third derivatives that differ from its own by what intervals show. Points of a surface have parameters in the domain
/// of its curves, wherever the box of the model reaches.
Vec3<Polynomial> Curve::Concept::exact(const Polynomial& t) const {
    const Vec3<Polynomial> none{Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()};
    if (!t.exists() || !t.is_model()) return none;
    const Interval range = clip(t.range(), {begin(), end()});
    const double at = mid(range);
    Vec3<Interval> f[4], over[4];
    taylor(Interval(at), 3, f);
    taylor(range, 3, over);
    Vec3<Polynomial> x;
    for (int axis = 0; axis < 3; ++axis) {
        const Interval c[4] = {f[0][axis], f[1][axis], f[2][axis], over[3][axis]};
        x[axis] = Polynomial::composed(c, 3, t, at);
    }
    return x;
}

std::vector<Break> breaks_of(std::span<const Curve> curves) {
    std::vector<Break> list, merged;
    for (const Curve& c : curves)
        for (const Break& b : c.breaks()) list.push_back(b);
    std::sort(list.begin(), list.end(), [](const Break& x, const Break& y) { return x.t < y.t; });
    const double tolerance = curves.empty() ? 0 : break_rounding * (curves[0].end() - curves[0].begin());
    for (const Break& b : list) {
        if (b.t - curves[0].begin() <= tolerance || curves[0].end() - b.t <= tolerance) continue;
        if (merged.empty() || b.t - merged.back().t > tolerance) merged.push_back(b);
        else merged.back().continuity = std::min(merged.back().continuity, b.continuity);
    }
    return merged;
}

std::vector<double> break_parameters(const std::vector<Curve>& curves) {
    std::vector<double> list;
    for (const Break& b : breaks_of(curves)) list.push_back(b.t);
    return list;
}

Curve reparametrized(const Curve& c, double begin, double end) {
    if (c.begin() == begin && c.end() == end) return c;
    if (const auto* b = c.bezier()) {
        auto pieces = b->pieces();
        const double scale = (end - begin) / (c.end() - c.begin());
        for (auto& p : pieces) {
            p.begin = begin + (p.begin - c.begin()) * scale;
            p.end = begin + (p.end - c.begin()) * scale;
        }
        pieces.back().end = end;
        return make_piecewise_bezier(std::move(pieces), b->continuity());
    }
    return make_curve(Reparametrized{c, begin, end});
}

}  // namespace isoparm
