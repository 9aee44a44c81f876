#include "bounds/second_derivatives.h"

#include <algorithm>
#include <cmath>

#include "scalar/safe.h"

namespace isoparm {
namespace {

Point middle(const Vec3<Interval>& x) { return {mid(x.x), mid(x.y), mid(x.z)}; }
double radius(const Vec3<Interval>& x) { return rounding::length_up(rad(x.x), rad(x.y), rad(x.z)); }
double size_of(const Point& x) { return rounding::length_up(std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)); }
/// Second derivatives along the normal below this part of all of them count as that: a plane has none.
constexpr double kVagueNormal = 0.02;
constexpr double kBinomial[6][6] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}, {1, 5, 10, 10, 5, 1}};
bool bounded(const Vec3<Interval>& x) { return x.x.bounded() && x.y.bounded() && x.z.bounded(); }

/// Piece (i, j) of parts x parts.
Box piece_of(const Box& box, int i, int j, int parts) {
    const auto cut = [parts](const Interval& x, int k) {
        const auto at = [&](int n) { return n == 0 ? x.lo : n == parts ? x.hi : x.lo + (x.hi - x.lo) * n / parts; };
        return Interval(at(k), at(k + 1));
    };
    return {cut(box.u, i), cut(box.v, j)};
}

/// The ranges over a box become the hulls of those over pieces of it, pieces outside the domain left out: intervals that overestimate
/// grow with the box.
void enclose_pieces(Enclosure& e, const Patch& patch, const Box& box, int parts) {
    Vec3<JetUV<Interval, 3>> hull_of_all;
    bool first = true;
    for (int i = 0; i < parts; ++i)
        for (int j = 0; j < parts; ++j) {
            const Box piece = piece_of(box, i, j, parts);
            if (patch.domain() == Domain::triangle && piece.u.lo + piece.v.lo > 1 + 1e-15) continue;
            const auto over = patch.enclose(piece).over;
            for (std::size_t k = 0; k < std::size(over.x.c); ++k)
                for (const auto axis : {&Vec3<JetUV<Interval, 3>>::x, &Vec3<JetUV<Interval, 3>>::y, &Vec3<JetUV<Interval, 3>>::z}) {
                    Interval& all = (hull_of_all.*axis).c[k];
                    all = first ? (over.*axis).c[k] : hull(all, (over.*axis).c[k]);
                }
            first = false;
        }
    if (!first) e.over = hull_of_all;
}

}  // namespace

SecondDerivatives::SecondDerivatives(const Patch& patch, const Box& box, int parts) {
    Enclosure e = patch.enclose(box);
    if (parts > 1) enclose_pieces(e, patch, box, parts);
    u = e.u, v = e.v;
    const auto centre = [&](int i, int j, double scale) {
        const int k = JetUV<Interval, 2>::index(i, j);
        const Interval s(scale);
        return Vec3<Interval>{s * e.centre.x.c[k], s * e.centre.y.c[k], s * e.centre.z.c[k]};
    };
    const auto over = [&](int i, int j, double scale) {
        const int k = JetUV<Interval, 3>::index(i, j);
        const Interval s(scale);
        return Vec3<Interval>{s * e.over.x.c[k], s * e.over.y.c[k], s * e.over.z.c[k]};
    };
    const Vec3<Interval> second[3] = {centre(2, 0, 2), centre(1, 1, 1), centre(0, 2, 2)};
    const Vec3<Interval> third[4] = {over(3, 0, 6), over(2, 1, 2), over(1, 2, 2), over(0, 3, 6)};
    for (int k = 0; k < 4; ++k) {
        if (!isoparm::bounded(third[k])) return;
        t[k] = middle(third[k]), t_rad[k] = radius(third[k]);
    }
    for (int k = 0; k < 3; ++k) {
        if (!isoparm::bounded(second[k])) return;
        h[k] = middle(second[k]), h_rad[k] = radius(second[k]);
    }
    add_sizes(rounding::up(std::max(box.u.hi - u, u - box.u.lo)), rounding::up(std::max(box.v.hi - v, v - box.v.lo)));
}

void SecondDerivatives::add_sizes(double ru, double rv) {
    for (int k = 0; k < 4; ++k) t_size[k] = safe(size_of(t[k]) + t_rad[k]);
    for (int k = 0; k < 3; ++k) h_size[k] = safe(std::fabs(h[k].x) + std::fabs(h[k].y) + std::fabs(h[k].z) + t_size[k] * ru + t_size[k + 1] * rv);
    const double all = h_size[0] + h_size[1] + h_size[2] + t_size[0] + t_size[1] + t_size[2] + t_size[3] + h_rad[0] + h_rad[1] + h_rad[2];
    bounded = all < kLargestDerivative && in_scale(ru) && in_scale(rv);
}

PolynomialCell::PolynomialCell(const Patch& patch, const Box& box) {
    const auto index = [](const std::vector<double>& lines, const Interval& x) -> std::size_t {
        const auto after = std::upper_bound(lines.begin(), lines.end() - 1, x.lo);
        return after == lines.begin() || !(x.hi <= *after) ? SIZE_MAX : std::size_t(after - lines.begin()) - 1;
    };
    const std::vector<double> us = patch.lines_u(), vs = patch.lines_v();
    const std::size_t i = index(us, box.u), j = index(vs, box.v);
    if (i == SIZE_MAX || j == SIZE_MAX) return;
    const std::vector<Polynomial> form = patch.exact_cell(i, j);
    if (form.size() != 3) return;  // none, or rational
    for (const Polynomial& f : form) p_ = std::max(p_, f.degree_u()), q_ = std::max(q_, f.degree_v());
    if (p_ > max_degree || q_ > max_degree) return;
    const Interval u(us[i], us[i + 1]), v(vs[j], vs[j + 1]);
    u_ = mid(u), v_ = mid(v);
    if (!in_scale(rad(u)) || !in_scale(rad(v))) return;
    c_.assign(std::size_t((p_ + 1) * (q_ + 1)), Lanes{});
    for (int axis = 0; axis < 3; ++axis)
        for (int s = 0; s <= form[axis].degree_u(); ++s)
            for (int t = 0; t <= form[axis].degree_v(); ++t) c_[std::size_t(s * (q_ + 1) + t)][std::size_t(axis)] = mid(form[axis].coefficient(s, t));
    const auto radius = [&](std::size_t n, int axis) {
        const int i = int(n) / (q_ + 1), j = int(n) % (q_ + 1);
        if (i > form[axis].degree_u() || j > form[axis].degree_v()) return 0.0;
        const Interval& c = form[axis].coefficient(i, j);
        return c.lo == c.hi ? 0 : rad(c);
    };
    bound_errors(radius, rounding::up(rad(u)), rounding::up(rad(v)));
}

PolynomialCell::PolynomialCell(int p, int q, double u, double v, double hu, double hv, std::vector<Lanes> c, const std::array<double, 3>& off)
    : p_(p), q_(q), u_(u), v_(v), c_(std::move(c)), off_(off), hu_(hu), hv_(hv) {
    double all = off[0] + off[1] + off[2];
    for (const Lanes& x : c_) all += std::fabs(x[0]) + std::fabs(x[1]) + std::fabs(x[2]);
    if (!(all < kLargestDerivative) || !in_scale(hu) || !in_scale(hv)) {
        c_.clear();
        return;
    }
    bound_errors([](std::size_t, int) { return 0.0; }, hu, hv);
}

double PolynomialCell::inaccuracy() const {
    if (exact()) return 0;
    const double scale[3] = {hu_ * hu_, 2 * hu_ * hv_, hv_ * hv_};
    const auto at = [&](int i, int j) { return i <= p_ && j <= q_ ? Point{c_[std::size_t(i * (q_ + 1) + j)][0], c_[std::size_t(i * (q_ + 1) + j)][1], c_[std::size_t(i * (q_ + 1) + j)][2]} : Point{}; };
    const Point n = normalized(cross(at(1, 0), at(0, 1)));
    const bool known = finite(n);
    double all = 0, along = 0, off = 0;
    for (int k = 0; k < 3; ++k) {
        const Point h = (k == 1 ? 1.0 : 2.0) * at(2 - k, k);
        all += scale[k] * length(h), along += known ? scale[k] * std::fabs(dot(n, h)) : 0, off += scale[k] * off_[std::size_t(k)];
    }
    const double size = std::max(along, kVagueNormal * all);
    return off == 0 ? 0 : off / size;
}

/// In repeated synthetic division every term of a sum passes 2 p additions and p products, and has p rounded factors u - u_ at most; the same
/// along v. So rounding is below 4 (p + q) units of the sum of the terms' sizes; 8 more are for scaling by 2 or 6.
template <class Radius> void PolynomialCell::bound_errors(Radius radius, double hu, double hv) {
    const double relative = (4.0 * (p_ + q_) + 8) * 0x1p-53 * (1 + 1e-12);
    error_.assign(c_.size(), 0.0);
    for (int i = 0; i <= p_; ++i)
        for (int j = 0; j <= q_; ++j) {
            double each[3] = {0, 0, 0}, weights = 1;
            double x = 1;
            for (int s = i; s <= p_; ++s, x *= hu) {
                double y = 1;
                for (int t = j; t <= q_; ++t, y *= hv) {
                    const double weight = kBinomial[s][i] * kBinomial[t][j] * x * y;
                    weights += weight;
                    const auto n = std::size_t(s * (q_ + 1) + t);
                    for (int axis = 0; axis < 3; ++axis) {
                        const double known = radius(n, axis);
                        each[axis] += weight * (relative * (std::fabs(c_[n][std::size_t(axis)]) + known) + known);
                    }
                }
            }
            error_[std::size_t(i * (q_ + 1) + j)] = safe(rounding::length_up(each[0], each[1], each[2])) + weights * kUnderflow;
        }
}

namespace {

using Lanes = std::array<double, 4>;

/// x + y d
void step(Lanes& x, const Lanes& y, double d) {
    for (std::size_t lane = 0; lane < 4; ++lane) x[lane] += y[lane] * d;
}


}  // namespace

Point PolynomialCell::point(const Vec2& p) const {
    const double du = p.x - u_, dv = p.y - v_;
    Lanes sum{};
    for (int i = p_; i >= 0; --i) {
        const Lanes* row = &c_[std::size_t(i * (q_ + 1))];
        Lanes at = row[q_];
        for (int j = q_ - 1; j >= 0; --j) {
            Lanes next = row[j];
            step(next, at, dv);
            at = next;
        }
        step(at, sum, du);
        sum = at;
    }
    return {sum[0], sum[1], sum[2]};
}

double PolynomialCell::slack(const Vec2& p, const Point& x) const {
    const Point s = point(p);
    const auto off = [](double a, double b) { return rounding::up(std::fabs(a - b)); };
    return rounding::up(rounding::length_up(off(s.x, x.x), off(s.y, x.y), off(s.z, x.z)) + error_[0]);
}

SecondDerivatives PolynomialCell::operator()(const Box& box) const { return p_ == 3 && q_ == 3 ? over<3, 3>(box) : over<-1, -1>(box); }

template <int P, int Q> SecondDerivatives PolynomialCell::over(const Box& box) const {
    constexpr int order = 4, size = max_degree + 1;
    const int p = P < 0 ? p_ : P, q = Q < 0 ? q_ : Q, stride = q + 1;
    SecondDerivatives m;
    m.u = mid(box.u), m.v = mid(box.v);
    const double ru = rounding::up(std::max(box.u.hi - m.u, m.u - box.u.lo)), rv = rounding::up(std::max(box.v.hi - m.v, m.v - box.v.lo));
    Lanes a[size * size];
    std::copy_n(c_.begin(), (p + 1) * stride, a);
    const double du = m.u - u_, dv = m.v - v_;  // to Taylor coefficients about (m.u, m.v)
    for (int k = 0; k < p; ++k)
        for (int i = p - 1; i >= k; --i)
            for (int j = 0; j <= q; ++j) step(a[i * stride + j], a[(i + 1) * stride + j], du);
    for (int i = 0; i <= p; ++i)
        for (int k = 0; k < q; ++k)
            for (int j = q - 1; j >= k; --j) step(a[i * stride + j], a[i * stride + j + 1], dv);
    const auto coefficient = [&](int i, int j) -> Lanes { return i <= p && j <= q ? a[i * stride + j] : Lanes{}; };
    const auto error = [&](int i, int j) { return i <= p && j <= q ? error_[std::size_t(i * stride + j)] : 0; };
    const auto point = [](const Lanes& x, double scale) { return Point{scale * x[0], scale * x[1], scale * x[2]}; };
    for (int k = 0; k < 3; ++k) {
        const double scale = k == 1 ? 1 : 2;
        m.h[std::size_t(k)] = point(coefficient(2 - k, k), scale), m.h_rad[std::size_t(k)] = safe(scale * error(2 - k, k) + off_[std::size_t(k)]);
    }
    // Third derivatives over the box: the coefficient, and multiples of those behind it. Where both powers are even the multiple is from 0 up.
    double power_u[size] = {1}, power_v[size] = {1};
    for (int k = 1; k < size; ++k) power_u[k] = power_u[k - 1] * ru, power_v[k] = power_v[k - 1] * rv;
    static constexpr double factorial[order] = {1, 1, 2, 6};
    for (int k = 0; k < order; ++k) {
        const int i = 3 - k, j = k;
        const double scale = factorial[i] * factorial[j];
        Lanes middle = coefficient(i, j), off{};
        double rest = error(i, j);
        for (int s = i; s <= p; ++s)
            for (int t = s == i ? j + 1 : j; t <= q; ++t) {
                const Lanes& c = a[s * stride + t];
                const double weight = std::max(kBinomial[s][i] * kBinomial[t][j] * power_u[s - i] * power_v[t - j], rounding::kTiny);
                const bool one_sided = (s - i) % 2 == 0 && (t - j) % 2 == 0;
                const double half = one_sided ? 0.5 * weight : weight;
                for (std::size_t lane = 0; lane < 4; ++lane) {
                    if (one_sided) middle[lane] += half * c[lane];
                    off[lane] += half * std::fabs(c[lane]);
                }
                rest += weight * error(s, t);
            }
        m.t[std::size_t(k)] = point(middle, scale);
        const double moved = 64 * 0x1p-53 * (std::fabs(middle[0]) + std::fabs(middle[1]) + std::fabs(middle[2]) + off[0] + off[1] + off[2]);  // rounding of the middle
        m.t_rad[std::size_t(k)] = safe(scale * (rounding::length_up(off[0], off[1], off[2]) + rest + moved));
    }
    m.add_sizes(ru, rv);
    return m;
}

SecondDerivatives PolynomialCell::operator()(const Box& box, int parts) const {
    SecondDerivatives all = (*this)(box);
    std::array<double, 4> most{};
    for (int i = 0; i < parts; ++i)
        for (int j = 0; j < parts; ++j) {
            const SecondDerivatives piece = (*this)(piece_of(box, i, j, parts));
            for (std::size_t k = 0; k < 4; ++k) most[k] = std::max(most[k], safe(size_of(piece.t[k] - all.t[k]) + piece.t_rad[k] + 0x1p-52 * (piece.t_size[k] + all.t_size[k])));
        }
    for (std::size_t k = 0; k < 4; ++k) all.t_rad[k] = std::min(all.t_rad[k], most[k]);
    all.add_sizes(rounding::up(std::max(box.u.hi - all.u, all.u - box.u.lo)), rounding::up(std::max(box.v.hi - all.v, all.v - box.v.lo)));
    return all;
}

}  // namespace isoparm
