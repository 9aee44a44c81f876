#include "bound_cell.h"

#include <algorithm>
#include <cmath>

#include "quiet.h"

namespace isoparm {
namespace {

/// Sums and products of numbers >= 0, a few dozen operations long, are at most this factor too small, up to underflow.
constexpr double kSafe = 1 + 1e-13, kUnderflow = 1e-290;
double safe(double x) { return x * kSafe + kUnderflow; }
/// Times the sum of the absolute terms: at least the rounding error of H(m)[e,e] and of its products with unit vectors.
constexpr double kRounding = 64 * 0x1p-53;

/// A triangle that fails is split by what its cell says, though this share of the bound may be the cell's: the first while there
/// are finer cells, the second when there are none.
constexpr double kClear = 0.4, kVague = 0.8;
/// Cells this much wider than a triangle are not tried.
constexpr double kLarge = 3, kLargePolynomial = 2;  // the second where cells cost little
/// Pieces of the triangle's own box are tried where a bound is within this factor of the tolerance.
constexpr double kNear = 2;


/// Right-handed orthonormal frame (up to 1e-15) whose first vector is n, or the axes where n is no unit vector.
std::array<Point, 3> frame_of(const Point& n) {
    if (!(std::fabs(dot(n, n) - 1) < 4e-15)) return {Point{0, 0, 1}, Point{1, 0, 0}, Point{0, 1, 0}};
    const Point t = normalized(cross(std::fabs(n.x) < 0.6 ? Point{1, 0, 0} : Point{0, 1, 0}, n));
    return {n, t, cross(n, t)};
}

/// An upper bound of the tangent of the angle between n and the normals of S: x the mesh's edges, b = H(m)[e_k,e_k], q what H strays from it
/// along e_k, slack how far the mesh's corners are from S. `worst`: the edge along which the normal turns most.
double turn_of(const Point& n, const std::array<Point, 3>& x, const std::array<Point, 3>& b, const std::array<double, 3>& q, const std::array<double, 3>& side, double slack,
               int& worst) {
    const std::array<Point, 3> first = along_edge(0, x, b), second = along_edge(1, x, b);
    std::array<Point, 3> normal;
    for (int c = 0; c < 3; ++c) normal[c] = normalized(cross(first[c], second[c]));
    const double extent = std::max({side[0], side[1], side[2]});
    const bool known = finite(normal[0]) && finite(normal[1]) && finite(normal[2]);
    // Slivers have no bound: an edge counts by its length as well, and alone where normals do not exist.
    const auto turned = [&](int k) { return (known ? length(normal[kNext[k]] - normal[k]) : 0) + 0.3 * side[k] / extent; };
    worst = turned(0) >= turned(1) && turned(0) >= turned(2) ? 0 : turned(1) >= turned(2) ? 1 : 2;
    double longest[2] = {0, 0}, off[2];
    for (int c = 0; c < 3; ++c) longest[0] = std::max(longest[0], length(first[c])), longest[1] = std::max(longest[1], length(second[c]));
    for (int k = 0; k < 2; ++k) off[k] = 0.5 * (q[0] + q[1] + q[2] + q[k]) + 2 * slack + kRounding * (side[k] + longest[k]);
    const double loose = safe(longest[0] * off[1] + longest[1] * off[0] + off[0] * off[1] + kRounding * longest[0] * longest[1]);
    // The cross product of DS[e_0] and DS[e_1] is quadratic, in the convex cone of its Bernstein coefficients.
    double turn = 0;
    for (int c = 0; c < 3; ++c)
        for (int d = c; d < 3; ++d) {
            const Point m = 0.5 * (cross(first[c], second[d]) + cross(first[d], second[c]));
            const double up = dot(n, m) - loose;
            if (!(up > 0)) return TriangleBound::none;
            turn = std::max(turn, safe((length(m - dot(n, m) * n) + loose) / up));
        }
    return turn;
}

Box half_of(const Box& box, int k) {
    const double mu = mid(box.u), mv = mid(box.v);
    return {k & 1 ? Interval(mu, box.u.hi) : Interval(box.u.lo, mu), k & 2 ? Interval(mv, box.v.hi) : Interval(box.v.lo, mv)};
}

bool inside(const Box& box, const Box& of) { return box.u.lo >= of.u.lo && box.u.hi <= of.u.hi && box.v.lo >= of.v.lo && box.v.hi <= of.v.hi; }

/// A triangle in the box of a model: its edges, and the model's derivatives along them.
class Shape {
public:
    Shape(const SecondDerivatives& model, const CornerData& triangle);

    /// `least`, `turns` as for bound_triangle(). `quick`: parametric may be larger than it has to be where the triangle is quiet.
    TriangleBound bound(Measure measure, bool least, bool turns, bool quick) const;
    /// Of a quiet triangle: bound().normal with `least`.
    double least_normal() const;

private:
    /// The same for all numbers that depend on how much H strays from H(m).
    struct Stray {
        bool least;
        std::array<double, 3> model;  // by which H(m) itself is uncertain
    };
    Stray stray_of(bool least) const;
    /// At least how far H[e_k,e_k] strays from H(m)[e_k,e_k] in the triangle, along unit vectors along which third derivatives are at most `size`.
    std::array<double, 3> stray(const Stray& of, const std::array<double, 4>& size) const;
    std::array<double, 3> stray_along(const Stray& of, const Point& f) const;
    std::array<double, 3> stray_vaguely(const Stray& of) const;
    std::array<double, 3> along_normal() const { return {dot(n_, b_[0]), dot(n_, b_[1]), dot(n_, b_[2])}; }
    EdgeBend on_edge(const Stray& of, int k) const;
    int choose_edge(const std::array<double, 3>& score) const;
    double noise() const { return 8 * (noise_[0] + noise_[1] + noise_[2]); }
    double parametric(const std::array<double, 3>& q, bool least) const;

    const SecondDerivatives& s_;
    const CornerData& triangle_;
    double mu_, mv_, ru_, rv_, aspect_;  // middle and half-widths of the triangle's box
    std::array<Point, 3> b_, x_;         // H(m)[e,e], and the mesh's edges
    std::array<double, 3> uu_, uv_, vv_, noise_, side_;  // noise: what rounding in H[e,e] is relative to
    double twice_area_, longest_;
    bool flat_;  // else too thin, or too small, to have a normal
    Point n_;
};

Shape::Shape(const SecondDerivatives& s, const CornerData& triangle) : s_(s), triangle_(triangle) {
    const auto& p = triangle.uv;
    const Box box = box_of(p);
    mu_ = mid(box.u), mv_ = mid(box.v);
    ru_ = std::max(box.u.hi - mu_, mu_ - box.u.lo), rv_ = std::max(box.v.hi - mv_, mv_ - box.v.lo);
    aspect_ = ru_ > 0 && rv_ > 0 ? rv_ / ru_ : 1;
    const double du = mu_ - s.u, dv = mv_ - s.v;
    std::array<Point, 3> h;  // at (mu, mv)
    for (int k = 0; k < 3; ++k) h[k] = s.h[k] + du * s.t[k] + dv * s.t[k + 1];
    for (int k = 0; k < 3; ++k) {
        const double eu = p[kNext[k]].x - p[k].x, ev = p[kNext[k]].y - p[k].y;
        uu_[k] = eu * eu, uv_[k] = eu * ev, vv_[k] = ev * ev;
        b_[k] = uu_[k] * h[0] + 2 * uv_[k] * h[1] + vv_[k] * h[2];
        noise_[k] = kRounding * (uu_[k] * s.h_size[0] + 2 * std::fabs(uv_[k]) * s.h_size[1] + vv_[k] * s.h_size[2]);
        x_[k] = triangle.points[kNext[k]] - triangle.points[k];
        side_[k] = length(x_[k]);
    }
    const Point normal = cross(x_[0], x_[1]);
    twice_area_ = length(normal), longest_ = std::max({side_[0], side_[1], side_[2]});
    flat_ = twice_area_ > 1e-9 * longest_ * longest_ && twice_area_ > 1e-140;
    n_ = flat_ ? normal / twice_area_ : Point{};
}

Shape::Stray Shape::stray_of(bool least) const {
    const double au = std::fabs(mu_ - s_.u), av = std::fabs(mv_ - s_.v);
    Stray of{least, {}};
    for (int k = 0; k < 3; ++k) of.model[k] = (s_.h_rad[k] + s_.t_rad[k] * au + s_.t_rad[k + 1] * av) * (least ? -1 : 1);
    return of;
}

std::array<double, 3> Shape::stray(const Stray& of, const std::array<double, 4>& size) const {
    const auto& model = of.model;
    const double suu = model[0] + size[0] * ru_ + size[1] * rv_, suv = model[1] + size[1] * ru_ + size[2] * rv_, svv = model[2] + size[2] * ru_ + size[3] * rv_;
    // 2 |du dv| <= aspect du^2 + dv^2 / aspect makes the form diagonal, which adds up over the corners.
    const double quu = suu + suv * aspect_, qvv = svv + suv / aspect_;
    std::array<double, 3> q;
    for (int k = 0; k < 3; ++k) q[k] = safe(quu * uu_[k] + qvv * vv_[k] + noise_[k]);
    return q;
}

std::array<double, 3> Shape::stray_along(const Stray& of, const Point& f) const {
    std::array<double, 4> along;
    for (int k = 0; k < 4; ++k) along[k] = std::max(0.0, std::fabs(dot(f, s_.t[k])) + (of.least ? -s_.t_rad[k] : s_.t_rad[k]) + 4 * 0x1p-53 * s_.t_size[k]);
    return stray(of, along);
}

std::array<double, 3> Shape::stray_vaguely(const Stray& of) const {
    std::array<double, 4> vague;
    for (int k = 0; k < 4; ++k) vague[k] = of.least ? -s_.t_rad[k] : s_.t_rad[k];
    return stray(of, vague);
}

/// Third derivatives with their signs, where they hardly vary: how H bends along an edge.
EdgeBend Shape::on_edge(const Stray& of, int k) const {
    const auto& p = triangle_.uv;
    const ThirdDerivatives third{s_.t};
    const Vec2 &from = p[k], &to = p[kNext[k]], e{to.x - from.x, to.y - from.y};
    const std::array<double, 4> r = of.least ? std::array<double, 4>{} : s_.t_rad;
    const double off = uu_[k] * (of.model[0] + r[0] * ru_ + r[1] * rv_) + 2 * std::fabs(uv_[k]) * (of.model[1] + r[1] * ru_ + r[2] * rv_) +
                       vv_[k] * (of.model[2] + r[2] * ru_ + r[3] * rv_);
    return EdgeBend{b_[k] + third(e, {0.5 * ((from.x - mu_) + (to.x - mu_)), 0.5 * ((from.y - mv_) + (to.y - mv_))}), 0.5 * third(e, e), std::max(0.0, off) + 8 * noise_[k]};
}

/// Where two edges are all but equal, the longer one in the domain: the choice must not hang on rounding.
int Shape::choose_edge(const std::array<double, 3>& score) const {
    int best = 0;
    for (int k = 1; k < 3; ++k) {
        const double size_k = uu_[k] + vv_[k], size_best = uu_[best] + vv_[best];
        if (score[k] > score[best] * (1 + 1e-9) || (score[k] >= score[best] * (1 - 1e-9) && size_k > size_best * (1 + 1e-9))) best = k;
    }
    return best;
}

double Shape::parametric(const std::array<double, 3>& q, bool least) const {
    std::array<double, 3> most;
    const auto frame = frame_of(n_);
    for (int f = 0; f < 3; ++f) most[f] = largest_form({dot(frame[f], b_[0]), dot(frame[f], b_[1]), dot(frame[f], b_[2])}, least ? q : noise_);
    return safe(0.5 * (rounding::length_up(most[0], most[1], most[2]) + simplex_maximum(q[0], q[1], q[2])));
}

double Shape::least_normal() const {
    const Stray of = stray_of(true);
    const std::array<double, 3> bn = along_normal();
    const CubicForm cubic(n_, bn, s_.t, triangle_.uv, {mu_, mv_});
    return safe(std::min(0.5 * largest_form(bn, stray_along(of, n_)), cubic.largest(stray_vaguely(of))) + noise());
}

TriangleBound Shape::bound(Measure measure, bool least, bool turns, bool quick) const {
    TriangleBound result;
    const Stray of = stray_of(least);
    std::array<double, 4> size = s_.t_size;
    if (least)
        for (int k = 0; k < 4; ++k) size[k] = std::max(0.0, size[k] - 2 * s_.t_rad[k]);
    const std::array<double, 3> q = stray(of, size);
    std::array<double, 3> bend;  // at least |H[e,e]| anywhere in the triangle
    for (int k = 0; k < 3; ++k) bend[k] = safe(length(b_[k]) + q[k]);
    result.worst_edge = result.worst_across = choose_edge(bend);
    const bool planar = measure == Measure::geometric && flat_;
    result.parametric = quick && planar ? safe(0.5 * simplex_maximum(bend[0], bend[1], bend[2])) : parametric(q, least);
    if (!planar) return result;

    const double slack = triangle_.slack;
    result.unit = n_;
    result.tilt = safe((8.1 * slack * (longest_ + slack) + 33 * 0x1p-53 * longest_ * longest_) / twice_area_ + 4 * 0x1p-53);
    if (turns && !least) result.turn = turn_of(n_, x_, b_, q, side_, slack, result.worst_turn);
    const std::array<double, 3> qn = stray_along(of, n_), bn = along_normal();
    result.worst_edge = choose_edge({std::fabs(bn[0]) + qn[0], std::fabs(bn[1]) + qn[1], std::fabs(bn[2]) + qn[2]});
    std::array<double, 3> across, lens;  // across: at least |inward . H[e_k,e_k]| as far as the edge's deviation goes
    bool quiet = result.tilt <= 1e-3;
    for (int k = 0; k < 3; ++k) {
        const EdgeBend edge = on_edge(of, k);
        const Point inward = cross(n_, x_[k]) / side_[k];  // in the plane
        const double any = safe(edge.largest());
        across[k] = safe(edge.along(inward) + 2 * result.tilt * any);
        lens[k] = safe(across[k] + 0.32 * (edge.along(n_) + result.tilt * any)) * side_[k] / (2 * side_[k] - any);
        quiet = quiet && any <= side_[k] && bend[k] <= 1.5 * longest_;
    }
    if (!quiet || !lenses_apart(lens, side_, twice_area_) || !keeps_orientation(n_, x_, b_, q, bend, result.tilt)) {
        if (quick) result.parametric = std::min(result.parametric, parametric(q, least));
        return result;
    }
    result.quiet = true;
    const CubicForm cubic(n_, bn, s_.t, triangle_.uv, {mu_, mv_});
    const std::array<double, 3> off = stray_vaguely(of);
    const double rounding = noise() + result.tilt * result.parametric;
    result.normal = safe(std::min(0.5 * largest_form(bn, qn), cubic.largest(off)) + rounding);
    for (int k = 0; k < 3; ++k) {
        const double wide = safe(1.06 * result.parametric * side_[k] / twice_area_);  // see Lemma 6
        result.beside[k] = std::min(result.normal, safe(cubic.beside(k, off, wide) + rounding));
        result.across[k] = safe(across[k] / 8);
    }
    return result;
}

}  // namespace

TriangleBound bound_triangle(const SecondDerivatives& s, const CornerData& triangle, Measure measure, bool least, bool turns) {
    return s.bounded ? Shape(s, triangle).bound(measure, least, turns, false) : TriangleBound{};
}

BoundCell::BoundCell(const Patch& patch, const Box& box) : BoundCell(patch, box, box, std::make_shared<PolynomialCell>(patch, box)) {}
BoundCell::BoundCell(const Patch& patch, const Box& box, const Box& reach, std::shared_ptr<const PolynomialCell> exact)
    : box_(box), reach_(reach), exact_(std::move(exact)), model_(exact_->exists() ? (*exact_)(reach) : SecondDerivatives(patch, reach)) {}
SecondDerivatives BoundCell::model_of(const Patch& patch, const Box& box, int parts) const {
    if (exact_->exists()) return parts > 1 ? (*exact_)(box, parts) : (*exact_)(box);
    auto& last = last_[parts > 1];
    const auto same = [](const Interval& a, const Interval& b) { return a.lo == b.lo && a.hi == b.hi; };
    {
        const std::lock_guard lock(last_guard_);
        if (last && last->parts == parts && same(last->box.u, box.u) && same(last->box.v, box.v)) return last->model;
    }
    auto fresh = std::make_unique<const Last>(Last{box, parts, SecondDerivatives(patch, box, parts)});
    const SecondDerivatives model = fresh->model;
    const std::lock_guard lock(last_guard_);
    last = std::move(fresh);
    return model;
}
BoundCell::~BoundCell() {
    for (auto& c : children_) delete c.load();
}

/// The child whose reach holds the box, made if it is not there yet; nullptr where none holds it.
const BoundCell* BoundCell::child(const Patch& patch, const Box& of) const {
    const int k = (mid(of.u) >= mid(box_.u) ? 1 : 0) + (mid(of.v) >= mid(box_.v) ? 2 : 0);
    if (BoundCell* c = children_[k].load(std::memory_order_acquire)) return inside(of, c->reach_) ? c : nullptr;
    const Box half = half_of(box_, k);
    const double gu = 0.25 * (half.u.hi - half.u.lo), gv = 0.25 * (half.v.hi - half.v.lo);
    const Box reach{{std::max(reach_.u.lo, half.u.lo - gu), std::min(reach_.u.hi, half.u.hi + gu)}, {std::max(reach_.v.lo, half.v.lo - gv), std::min(reach_.v.hi, half.v.hi + gv)}};
    if (!inside(of, reach)) return nullptr;
    if (patch.domain() == Domain::triangle && mid(reach.u) + mid(reach.v) > 1) return nullptr;  // its centre has to be a point of the domain
    auto fresh = std::unique_ptr<BoundCell>(new BoundCell(patch, half, reach, exact_));
    BoundCell* expected = nullptr;
    if (children_[k].compare_exchange_strong(expected, fresh.get(), std::memory_order_acq_rel)) return fresh.release();
    return expected;  // another thread was faster, with the same numbers
}

TriangleBound BoundCell::bound(const Patch& patch, const BoundCell*& cell, const CornerData& triangle, double tolerance, Measure measure, double turn, bool decide) {
    const Box box = box_of(triangle.uv);
    const bool turns = turn != TriangleBound::unasked;
    const auto by = [&](const SecondDerivatives& model) { return model.bounded ? Shape(model, triangle).bound(measure, false, turns, true) : TriangleBound{}; };
    // What no finer cell could go below, as far as the shape tells, whose bound is b.
    const auto least_of = [&](const Shape& shape, const TriangleBound& b) { return b.quiet ? shape.least_normal() : shape.bound(measure, true, false, true).own(measure); };
    const auto passes = [&](const TriangleBound& b) { return b.own(measure) <= tolerance && (!turns || b.turn <= turn); };
    const auto width = [](const Interval& x) { return x.hi - x.lo; };
    const double large = cell->exact_->exists() ? kLargePolynomial : kLarge;
    while (width(cell->box_.u) > large * width(box.u) && width(cell->box_.v) > large * width(box.v)) {
        const BoundCell* finer = cell->child(patch, box);
        if (!finer) break;
        cell = finer;
    }
    for (;;) {
        double help = 1;  // where the cell tells nothing
        if (cell->model_.bounded) {
            const Shape shape(cell->model_, triangle);
            if (decide && measure == Measure::geometric && shape.least_normal() > tolerance) return {};
            const TriangleBound b = shape.bound(measure, false, turns, true);
            if (passes(b)) return b;
            // A finer cell helps if the bound may be below the tolerance, and to tell the edges apart.
            const double least = least_of(shape, b);
            if (decide && least > tolerance) return b;
            help = least > tolerance ? 1 - least / b.own(measure) : 1;
            if (help < kClear) return b;
        }
        const BoundCell* finer = cell->child(patch, box);
        if (!finer && help < kVague) return by(cell->model_);
        if (!finer) break;
        cell = finer;
    }
    // The sharpest cell is the triangle's own box. Where second derivatives change too much, first ones may tell more.
    const SecondDerivatives model = cell->model_of(patch, box);
    TriangleBound sharpest = by(model);
    if (sharpest.own(measure) <= tolerance) return sharpest;
    if (model.bounded && least_of(Shape(model, triangle), sharpest) > (decide ? tolerance : (1 - kClear) * sharpest.own(measure))) return sharpest;
    if (sharpest.own(measure) <= kNear * tolerance) {
        const TriangleBound finer = by(cell->model_of(patch, box, SecondDerivatives::pieces));
        if (finer.own(measure) < sharpest.own(measure)) sharpest = finer;
        if (sharpest.own(measure) <= tolerance) return sharpest;
    }
    if (cell->exact_->exists() && (sharpest.quiet || sharpest.own(measure) > kNear * tolerance)) return sharpest;  // first derivatives would not tell more
    const TriangleBound rough = bound_triangle(patch, triangle.uv, triangle.points);
    if (rough.parametric < sharpest.parametric) {
        sharpest.parametric = rough.parametric;
        if (!sharpest.quiet) sharpest.worst_edge = sharpest.worst_across = rough.worst_edge;
    }
    return sharpest;
}

}  // namespace isoparm
