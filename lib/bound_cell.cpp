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
constexpr double kLarge = 3;
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

}  // namespace

TriangleBound bound_triangle(const SecondDerivatives& s, const CornerData& triangle, Measure measure, bool least, bool turns) {
    TriangleBound result;
    if (!s.bounded) return result;
    const auto& p = triangle.uv;
    const Box box = box_of(p);
    const double mu = mid(box.u), mv = mid(box.v);
    const double ru = std::max(box.u.hi - mu, mu - box.u.lo), rv = std::max(box.v.hi - mv, mv - box.v.lo);
    const double du = mu - s.u, dv = mv - s.v, au = std::fabs(du), av = std::fabs(dv);
    std::array<Point, 3> h;  // at (mu, mv)
    for (int k = 0; k < 3; ++k) h[k] = s.h[k] + du * s.t[k] + dv * s.t[k + 1];

    // Edges: H(m)[e,e], the mesh's edges, and what rounding in H[e,e] is relative to.
    std::array<Point, 3> b, x;
    std::array<double, 3> uu, uv, vv, noise, side;
    for (int k = 0; k < 3; ++k) {
        const double eu = p[kNext[k]].x - p[k].x, ev = p[kNext[k]].y - p[k].y;
        uu[k] = eu * eu, uv[k] = eu * ev, vv[k] = ev * ev;
        b[k] = uu[k] * h[0] + 2 * uv[k] * h[1] + vv[k] * h[2];
        noise[k] = kRounding * (uu[k] * s.h_size[0] + 2 * std::fabs(uv[k]) * s.h_size[1] + vv[k] * s.h_size[2]);
        x[k] = triangle.points[kNext[k]] - triangle.points[k];
        side[k] = length(x[k]);
    }
    const Point normal = cross(x[0], x[1]);
    const double twice_area = length(normal), longest = std::max({side[0], side[1], side[2]});
    const bool flat = twice_area > 1e-9 * longest * longest && twice_area > 1e-140;  // else too thin, or too small, to have a normal
    const Point n = flat ? normal / twice_area : Point{};

    // How far H strays from H(m) in the triangle: along unit vectors by `size` of the third derivatives.
    const double aspect = ru > 0 && rv > 0 ? rv / ru : 1;
    std::array<double, 3> model;  // by which H(m) itself is uncertain
    for (int k = 0; k < 3; ++k) model[k] = (s.h_rad[k] + s.t_rad[k] * au + s.t_rad[k + 1] * av) * (least ? -1 : 1);
    const auto stray = [&](const std::array<double, 4>& size) {
        const double suu = model[0] + size[0] * ru + size[1] * rv, suv = model[1] + size[1] * ru + size[2] * rv, svv = model[2] + size[2] * ru + size[3] * rv;
        // 2 |du dv| <= aspect du^2 + dv^2 / aspect makes the form diagonal, which adds up over the corners.
        const double quu = suu + suv * aspect, qvv = svv + suv / aspect;
        std::array<double, 3> q;
        for (int k = 0; k < 3; ++k) q[k] = safe(quu * uu[k] + qvv * vv[k] + noise[k]);
        return q;
    };
    std::array<double, 4> size = s.t_size;
    if (least)
        for (int k = 0; k < 4; ++k) size[k] = std::max(0.0, size[k] - 2 * s.t_rad[k]);
    const std::array<double, 3> q = stray(size);
    std::array<double, 3> bend;  // at least |H[e,e]| anywhere in the triangle
    for (int k = 0; k < 3; ++k) bend[k] = safe(length(b[k]) + q[k]);

    const auto choose_edge = [&](const std::array<double, 3>& score) {
        // Where two edges are all but equal, the longer one in the domain: the choice must not hang on rounding.
        int best = 0;
        for (int k = 1; k < 3; ++k) {
            const double size_k = uu[k] + vv[k], size_best = uu[best] + vv[best];
            if (score[k] > score[best] * (1 + 1e-9) || (score[k] >= score[best] * (1 - 1e-9) && size_k > size_best * (1 + 1e-9))) best = k;
        }
        return best;
    };
    result.worst_edge = result.worst_across = choose_edge(bend);
    const auto parametric = [&] {
        std::array<double, 3> most;
        const auto frame = frame_of(n);
        for (int f = 0; f < 3; ++f) most[f] = largest_form({dot(frame[f], b[0]), dot(frame[f], b[1]), dot(frame[f], b[2])}, least ? q : noise);
        return safe(0.5 * (rounding::length_up(most[0], most[1], most[2]) + simplex_maximum(q[0], q[1], q[2])));
    };
    result.parametric = parametric();
    if (measure == Measure::parametric || !flat) return result;

    const double s_ = triangle.slack;
    result.unit = n;
    result.tilt = safe((8.1 * s_ * (longest + s_) + 33 * 0x1p-53 * longest * longest) / twice_area + 4 * 0x1p-53);
    if (turns && !least) result.turn = turn_of(n, x, b, q, side, s_, result.worst_turn);
    std::array<double, 4> along;
    for (int k = 0; k < 4; ++k) along[k] = std::max(0.0, std::fabs(dot(n, s.t[k])) + (least ? -s.t_rad[k] : s.t_rad[k]) + 4 * 0x1p-53 * s.t_size[k]);
    const std::array<double, 3> qn = stray(along), bn{dot(n, b[0]), dot(n, b[1]), dot(n, b[2])};
    result.worst_edge = choose_edge({std::fabs(bn[0]) + qn[0], std::fabs(bn[1]) + qn[1], std::fabs(bn[2]) + qn[2]});
    // Third derivatives with their signs, where they hardly vary: how H bends along an edge, and over the triangle.
    const ThirdDerivatives third{s.t};
    const auto on_edge = [&](int k) {
        const Vec2 &from = p[k], &to = p[kNext[k]], e{to.x - from.x, to.y - from.y};
        const std::array<double, 4> r = least ? std::array<double, 4>{} : s.t_rad;
        const double off = uu[k] * (model[0] + r[0] * ru + r[1] * rv) + 2 * std::fabs(uv[k]) * (model[1] + r[1] * ru + r[2] * rv) + vv[k] * (model[2] + r[2] * ru + r[3] * rv);
        return EdgeBend{b[k] + third(e, {0.5 * ((from.x - mu) + (to.x - mu)), 0.5 * ((from.y - mv) + (to.y - mv))}), 0.5 * third(e, e), std::max(0.0, off) + 8 * noise[k]};
    };
    std::array<double, 3> across, lens;  // across: at least |inward . H[e_k,e_k]| as far as the edge's deviation goes
    bool quiet = result.tilt <= 1e-3;
    for (int k = 0; k < 3; ++k) {
        const EdgeBend edge = on_edge(k);
        const Point inward = cross(n, x[k]) / side[k];  // in the plane
        const double any = safe(edge.largest());
        across[k] = safe(edge.along(inward) + 2 * result.tilt * any);
        lens[k] = safe(across[k] + 0.32 * (edge.along(n) + result.tilt * any)) * side[k] / (2 * side[k] - any);
        quiet = quiet && any <= side[k] && bend[k] <= 1.5 * longest;
    }
    if (!quiet || !lenses_apart(lens, side, twice_area) || !keeps_orientation(n, x, b, q, bend, result.tilt)) return result;
    result.quiet = true;
    std::array<double, 4> vague;
    for (int k = 0; k < 4; ++k) vague[k] = least ? -s.t_rad[k] : s.t_rad[k];
    const CubicForm cubic(n, bn, s.t, p, {mu, mv});
    const std::array<double, 3> off = stray(vague);
    const double rounding = 8 * (noise[0] + noise[1] + noise[2]) + result.tilt * result.parametric;
    result.normal = safe(std::min(0.5 * largest_form(bn, qn), cubic.largest(off)) + rounding);
    for (int k = 0; k < 3; ++k) {
        const double wide = safe(1.06 * result.parametric * side[k] / twice_area);  // see Lemma 6
        result.beside[k] = std::min(result.normal, safe(cubic.beside(k, off, wide) + rounding));
        result.across[k] = safe(across[k] / 8);
    }
    return result;
}

BoundCell::BoundCell(const Patch& patch, const Box& box) : BoundCell(patch, box, box, std::make_shared<PolynomialCell>(patch, box)) {}
BoundCell::BoundCell(const Patch& patch, const Box& box, const Box& reach, std::shared_ptr<const PolynomialCell> exact)
    : box_(box), reach_(reach), exact_(std::move(exact)), model_(model_of(patch, reach)) {}
SecondDerivatives BoundCell::model_of(const Patch& patch, const Box& box, int parts) const {
    if (exact_->exists()) return parts > 1 ? (*exact_)(box, parts) : (*exact_)(box);
    return SecondDerivatives(patch, box, parts);
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
    const auto by = [&](const SecondDerivatives& model, bool least = false) { return bound_triangle(model, triangle, measure, least, turns); };
    const auto passes = [&](const TriangleBound& b) { return b.own(measure) <= tolerance && (!turns || b.turn <= turn); };
    const auto width = [](const Interval& x) { return x.hi - x.lo; };
    while (width(cell->box_.u) > kLarge * width(box.u) && width(cell->box_.v) > kLarge * width(box.v)) {
        const BoundCell* finer = cell->child(patch, box);
        if (!finer) break;
        cell = finer;
    }
    for (;;) {
        double help = 1;  // where the cell tells nothing
        if (cell->model_.bounded) {
            const TriangleBound b = by(cell->model_);
            if (passes(b)) return b;
            // A finer cell helps if the bound may be below the tolerance, and to tell the edges apart.
            const double least = by(cell->model_, true).own(measure);
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
    if (sharpest.own(measure) <= tolerance || by(model, true).own(measure) > (decide ? tolerance : (1 - kClear) * sharpest.own(measure))) return sharpest;
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
