#include "rays/exact_quick.h"

#include <algorithm>
#include <cmath>

#include "batch/isa_loops.h"

namespace isoparm {
namespace {

constexpr float kPlain = 0x1p-21f;        // 8 roundings: relative, of a scalar product and its factors
constexpr float kMore = 1.002f;           // above what rounding does to determinants, which are not small
constexpr float kSurelyRegular = 0.89f;   // of |I - Y J|, for 0.9 in double
constexpr float kLongest = 0.1f;          // steps that may be the last one
constexpr int kQuickSteps = 5;
constexpr double kEdgeOn = 2e-3;          // det / (|a| |b|) below which rounding would count
constexpr double kHorner = 0x1p-19;       // 32 roundings: relative to the sum of the terms, of a polynomial of bidegree 3 and its quotient
constexpr double kShifted = 1e-13;        // relative: of a polynomial in double about another place
constexpr double kUp = 1 + 1e-6;          // above rounding to float32

#define ISOPARM_LOOPS "rays/exact_quick_loops.inc"
#include "batch/isa_copies.inc"

float up(double x) { return static_cast<float>(x * kUp); }
double sum_of(const Point& x) { return std::fabs(x.x) + std::fabs(x.y) + std::fabs(x.z); }

/// c[axis][i][j] of bidegree N, in the coordinates of a leaf; bounds of what they are off, over the leaf.
struct LeafPolynomial {
    int degree = 0;
    std::vector<double> c;
    double error = 0, slope_error = 0;
    bool rational = false;

    double& at(int axis, int i, int j) { return c[static_cast<std::size_t>((axis * (degree + 1) + i) * (degree + 1) + j)]; }
    /// Sums of |c| over (i, j) != 0, and of the greatest of them as slopes.
    std::array<double, 2> sizes(int axis) {
        std::array<double, 2> s{0, 0};
        for (int i = 0; i <= degree; ++i)
            for (int j = 0; j <= degree; ++j) s[0] += std::fabs(at(axis, i, j)), s[1] += std::max(i, j) * std::fabs(at(axis, i, j));
        return s;
    }
};

/// sum c_ij (m + x h)^i (n + y k)^j, as coefficients of x^i y^j; `off`: of all terms, what rounding and their radii make of them.
void shift(const Polynomial& f, double m, double h, double n, double k, int axis, LeafPolynomial& to, double& off, double& slope_off) {
    const auto power = [](double x, int n) { double p = 1; while (n-- > 0) p *= x; return p; };
    const auto binomial = [](int n, int k) { double b = 1; for (int i = 0; i < k; ++i) b = b * (n - i) / (i + 1); return b; };
    for (int i = 0; i <= f.degree_u(); ++i)
        for (int j = 0; j <= f.degree_v(); ++j) {
            const Interval& c = f.coefficient(i, j);
            for (int p = 0; p <= i; ++p)
                for (int q = 0; q <= j; ++q) to.at(axis, p, q) += mid(c) * binomial(i, p) * binomial(j, q) * power(m, i - p) * power(n, j - q) * power(h, p) * power(k, q);
            const double size = (kShifted * mag(c) + rad(c)) * power(std::fabs(m) + h, i) * power(std::fabs(n) + k, j);
            off += size, slope_off += std::max(i, j) * size;
        }
}

/// Of a patch that is polynomial, or a quotient, of bidegree 3 at most.
bool set_exact(const ExactPatch& patch, const LeafMap& leaf, std::uint32_t cell, LeafPolynomial& to) {
    const auto us = patch.patch().lines_u(), vs = patch.patch().lines_v();
    const std::size_t column = cell / (vs.size() - 1), row = cell % (vs.size() - 1);
    const auto form = patch.patch().exact_cell(column, row);
    if (form.size() < 3) return false;
    int degree = 2;
    for (const Polynomial& f : form) degree = std::max({degree, f.degree_u(), f.degree_v()});
    if (degree > 3) return false;
    to.degree = degree, to.rational = form.size() == 4;
    to.c.assign(form.size() * static_cast<std::size_t>((degree + 1) * (degree + 1)), 0.0);
    const double m = leaf.u - mid(Interval(us[column], us[column + 1])), n = leaf.v - mid(Interval(vs[row], vs[row + 1]));
    const double rounded = 2.3e-16 * std::max(std::max(std::fabs(leaf.u), std::fabs(m)) / leaf.hu, std::max(std::fabs(leaf.v), std::fabs(n)) / leaf.hv);
    double off[4] = {}, slope_off[4] = {};
    for (std::size_t axis = 0; axis < form.size(); ++axis) shift(form[axis], m, leaf.hu, n, leaf.hv, static_cast<int>(axis), to, off[axis], slope_off[axis]);
    const auto less = [&](int axis, int i, int j) { return to.rational ? leaf.s[axis] * to.at(3, i, j) : i + j == 0 ? leaf.s[axis] : 0.0; };
    for (int axis = 0; axis < 3; ++axis) {
        if (to.rational) off[axis] += std::fabs(leaf.s[axis]) * off[3] + kShifted * std::fabs(leaf.s[axis] * to.at(3, 0, 0)), slope_off[axis] += std::fabs(leaf.s[axis]) * slope_off[3];
        else off[axis] += kShifted * std::fabs(leaf.s[axis]);
        for (int i = 0; i <= degree; ++i)
            for (int j = 0; j <= degree; ++j) to.at(axis, i, j) -= less(axis, i, j);
    }
    double e[4], f[4], value = 0, slope = 0;
    for (int axis = 0; axis < (to.rational ? 4 : 3); ++axis) {
        const auto size = to.sizes(axis);
        e[axis] = off[axis] + kHorner * size[0] + rounded * size[1], f[axis] = slope_off[axis] + kHorner * size[1];
        if (axis < 3) value += size[0], slope += size[1];
    }
    to.error = e[0] + e[1] + e[2], to.slope_error = f[0] + f[1] + f[2];
    if (!to.rational) return true;
    // Q / w, whose w is at least half of that in the middle.
    const auto size = to.sizes(3);
    const double middle = to.at(3, 0, 0), least = middle - (size[0] - std::fabs(middle)) - e[3];
    if (!(least > 0.5 * middle)) return false;
    const double s = (value + to.error) / least, sx = (slope + s * size[1]) / least;
    to.error = (to.error + s * e[3]) / least + kHorner * s;
    to.slope_error = (to.slope_error + s * f[3] + size[1] * to.error + sx * e[3]) / least + kHorner * sx;
    return true;
}

/// Of any patch: its Taylor polynomial of degree 3, with the third derivatives' middles over the leaf.
bool set_taylor(const ExactPatch& patch, const LeafMap& leaf, LeafPolynomial& to) {
    const Enclosure e = patch.patch().enclose(leaf.box);
    to.degree = 3, to.rational = false;
    to.c.assign(48, 0.0), to.error = to.slope_error = 0;
    using Third = JetUV<Interval, 3>;
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i <= 3; ++i)
            for (int j = 0; i + j <= 3; ++j) {
                const double scale = std::pow(leaf.hu, i) * std::pow(leaf.hv, j);
                const Interval x = i + j < 3 ? e.centre[axis].c[JetUV<Interval, 2>::index(i, j)] : e.over[axis].c[Third::index(i, j)];
                if (!x.bounded()) return false;
                to.at(axis, i, j) = scale * (mid(x) - (i + j == 0 ? leaf.s[axis] : 0));
                to.error += scale * rad(x), to.slope_error += 3 * scale * rad(x);
            }
        const auto size = to.sizes(axis);
        to.error += (kHorner + kShifted) * size[0] + kShifted * std::fabs(leaf.s[axis]), to.slope_error += kHorner * size[1];
    }
    return true;
}

}  // namespace

const QuickKernel* quick_kernels(Isa isa) {
#ifdef ISOPARM_ISA_LOOPS
    if (isa == Isa::avx512) return avx512::kernels;
    if (isa == Isa::avx2) return avx2::kernels;
#endif
    static_cast<void>(isa);
    return baseline::kernels;
}

void QuickRays::set_planes(const RayPacket& rays) {
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < lanes; ++i) n1[k][i] = static_cast<float>(rays.n1[k][i]), n2[k][i] = static_cast<float>(rays.n2[k][i]);
}

void QuickPatch::add(std::size_t leaf, const Point& centre) {
    const LeafMap& l = patch_.map(leaf);
    QuickLeaf& q = leaves_.emplace_back();
    q.kind = QuickLeaf::none, q.first = static_cast<std::uint32_t>(coefficients_.size());
    LeafPolynomial p;
    if (!std::isfinite(l.bend) || !std::isfinite(l.uu) || (!set_exact(patch_, l, patch_.cell(leaf), p) && !set_taylor(patch_, l, p))) return;
    const Point s = l.s - centre;
    for (int k = 0; k < 3; ++k) {
        q.s[k] = static_cast<float>(s[k]), q.a[k] = static_cast<float>(l.a[k]), q.b[k] = static_cast<float>(l.b[k]);
        for (int i = 0; i < 3; ++i) q.second[i][k] = static_cast<float>(l.second[i][k]);
    }
    const double a = sum_of(l.a), b = sum_of(l.b);
    q.bend = up(l.bend), q.turn_u = up(l.turn_u), q.turn_v = up(l.turn_v), q.uu = up(l.uu), q.uv = up(l.uv), q.vv = up(l.vv);
    q.size_a = up(l.size_a + l.turn_u), q.size_b = up(l.size_b + l.turn_v), q.sum_a = up(a), q.sum_b = up(b), q.area = up(kEdgeOn * a * b);
    q.error = up(p.error + kPlain * (sum_of(s) + 2 * (a + b) + l.bend) + patch_.slack()), q.slope_error = up(p.slope_error);
    q.slant_u = l.slanted ? up(l.hu) : 0.0f, q.slant_v = l.slanted ? up(l.hv) : 0.0f, q.slant = l.slanted ? static_cast<float>(l.u + l.v - 1) : -1.0f;
    if (!(q.area > 0x1p-100f) || !std::isfinite(q.error) || !std::isfinite(q.slope_error)) return;
    for (const double c : p.c) coefficients_.push_back(static_cast<float>(c));
    q.kind = p.degree == 2 ? (p.rational ? QuickLeaf::rational_quadric : QuickLeaf::quadric) : p.rational ? QuickLeaf::rational_cubic : QuickLeaf::cubic;
}

QuickPatch::QuickPatch(const ExactPatch& patch, const Point& centre) : patch_(patch), kernels_(quick_kernels(chosen_isa())) {
    leaves_.reserve(patch.leaves());
    for (std::size_t i = 0; i < patch.leaves(); ++i) add(i, centre);
    coefficients_.shrink_to_fit();
}

}  // namespace isoparm
