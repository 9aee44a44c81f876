#include "bounds/model_source.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scalar/safe.h"

namespace isoparm {
namespace {

using Homogeneous = std::array<Interval, 4>;
constexpr int kDegree = PolynomialCell::max_degree;
/// Of numerators and denominators: more take long.
constexpr int kMostDegree = 9;
/// Boxes that tell whether a formula has models have this part of the cell's width. Models of a triangle's own box come before intervals where those are so many times vaguer.
constexpr double kProbe = 1.0 / 16, kFarSharper = 8;

/// At least the absolute values of a polynomial and its derivatives over |x| <= hu, |y| <= hv.
struct Sizes {
    double f = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;

    void add(int i, int j, double c, const double* x, const double* y) {
        f += c * x[i] * y[j];
        if (i > 0) u += i * c * x[i - 1] * y[j];
        if (j > 0) v += j * c * x[i] * y[j - 1];
        if (i > 1) uu += i * (i - 1) * c * x[i - 2] * y[j];
        if (i > 0 && j > 0) uv += i * j * c * x[i - 1] * y[j - 1];
        if (j > 1) vv += j * (j - 1) * c * x[i] * y[j - 2];
    }
};

/// Powers up to the n-th, not below the smallest numbers.
std::vector<double> powers(double h, int n) {
    std::vector<double> x(std::size_t(n) + 1, 1.0);
    for (int k = 1; k <= n; ++k) x[std::size_t(k)] = std::max(x[std::size_t(k) - 1] * h, rounding::kTiny);
    return x;
}

/// Taylor coefficients about a point (dx, dy) away, by repeated synthetic division.
void move(std::vector<Homogeneous>& a, int p, int q, const Interval& dx, const Interval& dy) {
    const int stride = q + 1;
    const auto step = [&](int to, int from, const Interval& d) {
        for (std::size_t k = 0; k < 4; ++k) a[std::size_t(to)][k] += a[std::size_t(from)][k] * d;
    };
    for (int k = 0; k < p; ++k)
        for (int i = p - 1; i >= k; --i)
            for (int j = 0; j <= q; ++j) step(i * stride + j, (i + 1) * stride + j, dx);
    for (int i = 0; i <= p; ++i)
        for (int k = 0; k < q; ++k)
            for (int j = q - 1; j >= k; --j) step(i * stride + j, i * stride + j + 1, dy);
}

/// Index of the cell between lines that begins with x.
std::size_t index_of(const std::vector<double>& lines, const Interval& x) {
    const auto at = std::lower_bound(lines.begin(), lines.end(), x.lo);
    return at == lines.end() || *at != x.lo || at + 1 == lines.end() || at[1] != x.hi ? SIZE_MAX : std::size_t(at - lines.begin());
}

}  // namespace

ModelSource::ModelSource(const Patch& patch, const Box& cell) {
    take_quotient(patch, cell);
    if (exact_.empty()) try_formula(patch, cell);
}

/// A formula without models costs time wherever one is tried, and where intervals are nearly as sharp they are faster: three small boxes tell.
void ModelSource::try_formula(const Patch& patch, const Box& cell) {
    int sharper = 0;
    for (const auto& [x, y] : {std::pair{0.25, 0.25}, {0.5, 0.25}, {0.25, 0.5}}) {
        const auto part = [](const Interval& t, double at) { return Interval(t.lo + at * (t.hi - t.lo), t.lo + (at + kProbe) * (t.hi - t.lo)); };
        const Box box{part(cell.u, x), part(cell.v, y)};
        const PolynomialCell model = formula_over(patch, box);
        if (!model.exists()) continue;
        formula_ = true;
        const SecondDerivatives by_model = model(box), by_intervals(patch, box);
        const auto vague = [](const SecondDerivatives& s, const Box& b) {
            const double h[2] = {rad(b.u), rad(b.v)};
            double sum = 0;
            for (std::size_t k = 0; k < 4; ++k) sum += s.t_rad[k] * std::pow(h[0], double(3 - k)) * std::pow(h[1], double(k));
            for (std::size_t k = 0; k < 3; ++k) sum += s.h_rad[k] * std::pow(h[0], double(2 - k)) * std::pow(h[1], double(k));
            return s.bounded ? sum : std::numeric_limits<double>::infinity();
        };
        sharper += vague(by_intervals, box) > kFarSharper * vague(by_model, box);
    }
    sharper_ = sharper > 1;
}

void ModelSource::take_quotient(const Patch& patch, const Box& cell) {
    const std::vector<double> us = patch.lines_u(), vs = patch.lines_v();
    const std::size_t column = index_of(us, cell.u), row = index_of(vs, cell.v);
    if (column == SIZE_MAX || row == SIZE_MAX) return;
    const std::vector<Polynomial> form = patch.exact_cell(column, row);
    if (form.size() != 4) return;
    for (const Polynomial& f : form) p_ = std::max(p_, f.degree_u()), q_ = std::max(q_, f.degree_v());
    if (p_ > kMostDegree || q_ > kMostDegree || !in_scale(rad(cell.u)) || !in_scale(rad(cell.v))) return;
    u_ = mid(cell.u), v_ = mid(cell.v);
    exact_.assign(std::size_t((p_ + 1) * (q_ + 1)), Homogeneous{});
    c_.assign(exact_.size(), Lanes{});
    const std::vector<double> x = powers(rounding::up(rad(cell.u)), p_), y = powers(rounding::up(rad(cell.v)), q_);
    const double relative = (4.0 * (p_ + q_) + 8) * 0x1p-53 * (1 + 1e-12);
    // What underflows in slack(): less than the smallest number in each product, multiplied by powers of the half-widths at most.
    const double lost = 4.0 * (p_ + 1) * (q_ + 1) * rounding::kTiny * std::max(1.0, x.back()) * std::max(1.0, y.back());
    for (std::size_t k = 0; k < 4; ++k) {
        for (int i = 0; i <= form[k].degree_u(); ++i)
            for (int j = 0; j <= form[k].degree_v(); ++j) {
                const auto n = std::size_t(i * (q_ + 1) + j);
                const Interval& c = exact_[n][k] = form[k].coefficient(i, j);
                c_[n][k] = mid(c);
                error_[k] += x[std::size_t(i)] * y[std::size_t(j)] * (relative * mag(c) + (c.lo == c.hi ? 0 : rad(c)));
            }
        error_[k] = safe(error_[k] + lost);
    }
}

PolynomialCell ModelSource::over(const Patch& patch, const Box& box) const { return !exact_.empty() ? rational_over(box) : formula_ ? formula_over(patch, box) : PolynomialCell(); }

/// What the formula of the surface makes of its parameters as models.
PolynomialCell ModelSource::formula_over(const Patch& patch, const Box& box) {
    const std::vector<Polynomial> x = patch.model(box);
    if (x.size() != 3) return {};
    constexpr int stride = kDegree + 1;
    std::vector<PolynomialCell::Lanes> c(std::size_t(stride * stride), PolynomialCell::Lanes{});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!x[axis].exists() || x[axis].degree_u() > kDegree || x[axis].degree_v() > kDegree) return {};
        for (int i = 0; i <= x[axis].degree_u(); ++i)
            for (int j = 0; j <= x[axis].degree_v(); ++j) c[std::size_t(i * stride + j)][axis] = mid(x[axis].coefficient(i, j));
    }
    const auto length_of = [&](double Polynomial::Rest::*of) { return rounding::length_up(x[0].rest().*of, x[1].rest().*of, x[2].rest().*of); };
    return PolynomialCell(kDegree, kDegree, mid(box.u), mid(box.v), rad(box.u), rad(box.v), std::move(c),
                          {length_of(&Polynomial::Rest::uu), length_of(&Polynomial::Rest::uv), length_of(&Polynomial::Rest::vv)});
}

/// S = N / W. The model P is S's Taylor polynomial about the middle, up to rounding; S - P is R / W with R = N - P W, whose coefficients are
/// bounded: small ones, but for those of high order.
PolynomialCell ModelSource::rational_over(const Box& box) const {
    const double u = mid(box.u), v = mid(box.v), hu = rounding::up(std::max(box.u.hi - u, u - box.u.lo)), hv = rounding::up(std::max(box.v.hi - v, v - box.v.lo));
    if (!in_scale(hu) || !in_scale(hv)) return {};
    std::vector<Homogeneous> a = exact_;
    move(a, p_, q_, Interval(u) - Interval(u_), Interval(v) - Interval(v_));
    const auto at = [&](int i, int j) -> const Homogeneous& { return a[std::size_t(i * (q_ + 1) + j)]; };
    const std::vector<double> x = powers(hu, kDegree + p_), y = powers(hv, kDegree + q_);
    Sizes w;
    for (int i = 0; i <= p_; ++i)
        for (int j = 0; j <= q_; ++j) w.add(i, j, mag(at(i, j)[3]), x.data(), y.data());
    const double least = (at(0, 0)[3].lo - safe(w.f - mag(at(0, 0)[3]))) * (1 - 1e-12) - 1e-12 * safe(w.f);
    if (!(least > 1e-3 * mag(at(0, 0)[3])) || !(least > 1e-60)) return {};

    std::vector<Lanes> middle(a.size()), radius(a.size());
    for (std::size_t n = 0; n < a.size(); ++n)
        for (std::size_t k = 0; k < 4; ++k) middle[n][k] = mid(a[n][k]), radius[n][k] = rad(a[n][k]);
    const auto index = [&](int i, int j) { return std::size_t(i * (q_ + 1) + j); };
    constexpr int stride = kDegree + 1;
    std::vector<PolynomialCell::Lanes> c(std::size_t(stride * stride), PolynomialCell::Lanes{});
    const double scale = 1 / middle[0][3];
    for (int i = 0; i <= kDegree; ++i)
        for (int j = 0; j <= kDegree; ++j) {
            Lanes sum = i <= p_ && j <= q_ ? middle[index(i, j)] : Lanes{};
            for (int s = 0; s <= std::min(i, p_); ++s)
                for (int t = s == 0 ? 1 : 0; t <= std::min(j, q_); ++t)
                    for (std::size_t k = 0; k < 3; ++k) sum[k] -= middle[index(s, t)][3] * c[std::size_t((i - s) * stride + j - t)][k];
            for (std::size_t k = 0; k < 3; ++k) c[std::size_t(i * stride + j)][k] = sum[k] * scale;
        }

    // In plain arithmetic: each of at most 101 terms is rounded once, and so is each sum, none of which is above the sizes of all terms.
    constexpr double relative = 256 * 0x1p-53;
    Sizes r[3];
    for (int i = 0; i <= kDegree + p_; ++i)
        for (int j = 0; j <= kDegree + q_; ++j) {
            const bool there = i <= p_ && j <= q_;
            Lanes rest = there ? middle[index(i, j)] : Lanes{}, off = there ? radius[index(i, j)] : Lanes{}, size{};
            for (std::size_t k = 0; k < 3; ++k) size[k] = std::fabs(rest[k]);
            for (int s = std::max(0, i - kDegree); s <= std::min(i, p_); ++s)
                for (int t = std::max(0, j - kDegree); t <= std::min(j, q_); ++t) {
                    const double w_middle = middle[index(s, t)][3], w_radius = radius[index(s, t)][3];
                    const Lanes& factor = c[std::size_t((i - s) * stride + j - t)];
                    for (std::size_t k = 0; k < 3; ++k) {
                        const double product = w_middle * factor[k];
                        rest[k] -= product, size[k] += std::fabs(product), off[k] += w_radius * std::fabs(factor[k]);
                    }
                }
            for (std::size_t k = 0; k < 3; ++k) r[k].add(i, j, std::fabs(rest[k]) + off[k] + relative * size[k], x.data(), y.data());
        }
    const auto length_of = [&](double Sizes::*of) { return safe(rounding::length_up(r[0].*of, r[1].*of, r[2].*of)); };
    // Differentiate R = (S - P) W.
    const double each = safe(1 / least), d = safe(length_of(&Sizes::f) * each);
    const double du = safe((length_of(&Sizes::u) + d * w.u) * each), dv = safe((length_of(&Sizes::v) + d * w.v) * each);
    const std::array<double, 3> off{safe((length_of(&Sizes::uu) + 2 * du * w.u + d * w.uu) * each), safe((length_of(&Sizes::uv) + du * w.v + dv * w.u + d * w.uv) * each),
                                    safe((length_of(&Sizes::vv) + 2 * dv * w.v + d * w.vv) * each)};
    return PolynomialCell(kDegree, kDegree, u, v, hu, hv, std::move(c), off);
}

/// |x - N/W| = |x W - N| / W.
double ModelSource::slack(const Vec2& p, const Point& x) const {
    if (exact_.empty()) return std::numeric_limits<double>::infinity();
    const double du = p.x - u_, dv = p.y - v_;
    Lanes sum{};
    for (int i = p_; i >= 0; --i) {
        const Lanes* row = &c_[std::size_t(i * (q_ + 1))];
        Lanes at = row[q_];
        for (int j = q_ - 1; j >= 0; --j)
            for (std::size_t k = 0; k < 4; ++k) at[k] = row[j][k] + at[k] * dv;
        for (std::size_t k = 0; k < 4; ++k) sum[k] = at[k] + sum[k] * du;
    }
    const double w = (sum[3] - error_[3]) * (1 - 1e-15);
    if (!(w > 1e-60)) return std::numeric_limits<double>::infinity();
    const auto off = [&](std::size_t k, double at) {
        const double product = sum[3] * at;
        return std::fabs(product - sum[k]) + 0x1p-51 * (std::fabs(product) + std::fabs(sum[k])) + error_[k] + std::fabs(at) * error_[3];
    };
    return safe(rounding::length_up(safe(off(0, x.x)), safe(off(1, x.y)), safe(off(2, x.z))) / w);
}

}  // namespace isoparm
