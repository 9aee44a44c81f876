#include "patches/edge_scalar.h"

#include <cmath>

#include "exact_parts.h"
#include "patches/edge_series.h"
#include "patches/forwarding.h"

namespace isoparm {
namespace {

/// Taylor coefficients to second order.
std::array<Interval, 3> expanded(const Polynomial& p, const Interval& at) {
    std::array<Interval, 3> a{};
    for (int k = 0; k < 3; ++k)
        for (int i = p.degree_u(); i >= k; --i) a[std::size_t(k)] = a[std::size_t(k)] * at + Interval(binomial(i, k)) * p.coefficient(i, 0);
    return a;
}

class WithEdgeForms final : public ForwardingPatch {
public:
    WithEdgeForms(Patch patch, EdgeFormula formula) : ForwardingPatch(std::move(patch)), formula_(std::move(formula)), lines_u_(patch_.lines_u()), lines_v_(patch_.lines_v()) {}

    std::vector<Polynomial> exact_cell(std::size_t i, std::size_t j) const override {
        const std::size_t cells = lines_u_.size() - 1;
        if (i >= cells) return form_at(i % cells, j, static_cast<int>(i / cells) - 1);
        auto form = patch_.exact_cell(i, j);
        return form.empty() ? std::vector<Polynomial>(2, Polynomial(0)) : form;
    }

private:
    std::vector<Polynomial> form_at(std::size_t m, std::size_t n, int k) const {
        const Interval u(lines_u_[m], lines_u_[m + 1]), v(lines_v_[n], lines_v_[n + 1]);
        const bool is_u = k == 1 || k == 3, upper = k == 1 || k == 2;
        const auto x = is_u ? formula_(EdgeScalar::across(u, upper), EdgeScalar::along(v)) : formula_(EdgeScalar::along(u), EdgeScalar::across(v, upper));
        EdgeForm form;
        Polynomial3* const parts[] = {&form.value, &form.across, &form.second};
        for (int order = 0; order < 3; ++order) {
            Vec3<Quotient> q{x.x.c[order], x.y.c[order], x.z.c[order]};
            form.under[order] = common_denominator(q);
            for (int axis = 0; axis < 3; ++axis) (*parts[order])[axis] = q[axis].over;
        }
        return form.list(is_u ? v : u);
    }

    EdgeFormula formula_;
    std::vector<double> lines_u_, lines_v_;
};

}  // namespace

EdgeScalar EdgeScalar::along(const Interval& cell) {
    EdgeScalar t;
    t.c[0] = Polynomial::variable_u(cell), t.kind_ = Kind::along, t.cell_ = cell;
    return t;
}
EdgeScalar EdgeScalar::across(const Interval& cell, bool upper) {
    EdgeScalar t(upper ? cell.hi : cell.lo);
    t.c[1] = Polynomial(1), t.kind_ = Kind::across, t.cell_ = cell;
    t.side_ = upper ? Interval(std::nextafter(cell.hi, cell.lo), cell.hi) : Interval(cell.lo);
    return t;
}

Vec3<EdgeScalar> EdgeScalar::of(const Curve& curve) const {
    Vec3<EdgeScalar> r;
    if (kind_ == Kind::across) {
        Vec3<Interval> a[3];
        Vec3<Quotient> x = curve.quotient(Polynomial::variable_u(cell_));
        const Polynomial under = common_denominator(x);
        if (x.x.over.exists() && x.y.over.exists() && x.z.over.exists()) {  // its piece in the cell, even where its break differs from the line by rounding
            const Interval at = Interval(c[0].over.coefficient(0, 0)) - Interval(mid(cell_));
            const auto w = expanded(under, at);
            for (int axis = 0; axis < 3; ++axis) {
                const auto n = expanded(x[axis].over, at);
                a[0][axis] = n[0] / w[0];
                a[1][axis] = (n[1] - a[0][axis] * w[1]) / w[0];
                a[2][axis] = (n[2] - a[1][axis] * w[1] - a[0][axis] * w[2]) / w[0];
            }
        } else {
            curve.taylor(side_, 2, a);
        }
        for (int axis = 0; axis < 3; ++axis)
            for (int k = 0; k < 3; ++k) r[axis].c[k] = Polynomial(a[k][axis]);
        return r;
    }
    const Vec3<Quotient> x = kind_ == Kind::along ? curve.quotient(c[0].over) : Vec3<Quotient>{Polynomial::nothing(), Polynomial::nothing(), Polynomial::nothing()};
    for (int axis = 0; axis < 3; ++axis) r[axis].c[0] = x[axis];
    return r;
}
EdgeScalar EdgeScalar::of(const Function& f) const {
    EdgeScalar r;
    if (kind_ == Kind::across) {
        Interval a[3];
        f.taylor(side_, 2, a);
        for (int k = 0; k < 3; ++k) r.c[k] = Polynomial(a[k]);
    } else {
        r.c[0] = kind_ == Kind::along ? f(c[0].over) : Polynomial::nothing();
    }
    return r;
}

EdgeScalar operator+(const EdgeScalar& a, const EdgeScalar& b) {
    EdgeScalar r;
    for (int k = 0; k < 3; ++k) r.c[k] = a.c[k] + b.c[k];
    return r;
}
EdgeScalar operator-(const EdgeScalar& a) {
    EdgeScalar r;
    for (int k = 0; k < 3; ++k) r.c[k] = {-a.c[k].over, a.c[k].under};
    return r;
}
EdgeScalar operator*(const EdgeScalar& a, const EdgeScalar& b) {
    EdgeScalar r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; i + j < 3; ++j) r.c[i + j] = r.c[i + j] + a.c[i] * b.c[j];
    return r;
}
EdgeScalar polynomial(const double* c, int degree, const EdgeScalar& t) {
    EdgeScalar r(c[degree]);
    for (int k = degree - 1; k >= 0; --k) r = r * t + c[k];
    return r;
}
EdgeScalar kept_in(EdgeScalar x, double low, double high) {
    if (x.c[0].is_number()) x.c[0] = Polynomial(clip(x.c[0].over.coefficient(0, 0), {low, high}));
    return x;
}

EdgeScalar cone(const SquareOfRadius&, const GregoryRatio&, const EdgeScalar& p, const EdgeScalar& q) {
    if (p.c[0].is_number(0)) return p * p;
    if (q.c[0].is_number(0)) return p * q - q * q;
    const EdgeScalar r = p + q;
    const Quotient one(1.0), once(one.over, {r.c[0].over}), twice = once * once, slope = Quotient(-1.0) * r.c[1];
    EdgeScalar inverse;
    inverse.c[0] = once, inverse.c[1] = slope * twice, inverse.c[2] = slope * slope * (once * twice);  // p and q are linear in x
    return square(p) * q * inverse;
}

Patch with_edge_forms(Patch patch, EdgeFormula formula) { return Patch(std::make_shared<WithEdgeForms>(std::move(patch), std::move(formula))); }

}  // namespace isoparm
