#include "bounds/bound_cell.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bounds/triangle_shape.h"

namespace isoparm {
namespace {

/// A triangle that fails is split by what its cell says, though this share of the bound may be the cell's: the first while there
/// are finer cells, the second when there are none.
constexpr double kClear = 0.4, kVagueShare = 0.8;
/// Cells this much wider than a triangle are not tried.
constexpr double kLarge = 3, kLargePolynomial = 2;  // the second where cells cost little
/// Pieces of the triangle's own box are tried where a bound is within this factor of the tolerance.
constexpr double kNear = 2;
/// Models as inaccurate as the first serve all triangles in their cells; those of a triangle's own box, as inaccurate as the second, are sharper than intervals.
constexpr double kSharp = 0.02, kVague = 0.1;
/// Cells are halved for models so often at most, and no further than to the triangle's size.
constexpr int kDeepest = 40;

Box half_of(const Box& box, int k) {
    const double mu = mid(box.u), mv = mid(box.v);
    return {k & 1 ? Interval(mu, box.u.hi) : Interval(box.u.lo, mu), k & 2 ? Interval(mv, box.v.hi) : Interval(box.v.lo, mv)};
}

bool inside(const Box& box, const Box& of) { return box.u.lo >= of.u.lo && box.u.hi <= of.u.hi && box.v.lo >= of.v.lo && box.v.hi <= of.v.hi; }

}  // namespace

BoundCell::BoundCell(const Patch& patch, const Box& box) : box_(box), reach_(box), polynomial_(std::make_shared<PolynomialCell>(patch, box)) {
    if (!polynomial_->exists()) {
        source_ = std::make_shared<ModelSource>(patch, box);
        polynomial_ = std::make_shared<PolynomialCell>(source_->over(patch, box));
    }
    sharp_ = polynomial_->exists() && polynomial_->inaccuracy() <= kSharp;
    model_ = polynomial_->exists() ? (*polynomial_)(reach_) : SecondDerivatives(patch, reach_);
}
BoundCell::BoundCell(const Patch& patch, const Box& box, const Box& reach, const BoundCell& parent)
    : box_(box), reach_(reach), polynomial_(parent.sharp_ ? parent.polynomial_ : std::make_shared<PolynomialCell>(parent.source_->over(patch, reach))), source_(parent.source_),
      sharp_(parent.sharp_ || (polynomial_->exists() && polynomial_->inaccuracy() <= kSharp)),
      model_(polynomial_->exists() ? (*polynomial_)(reach) : SecondDerivatives(patch, reach)) {}

SecondDerivatives BoundCell::model_of(const Patch& patch, const Box& box, int parts) const {
    const auto over = [&](const PolynomialCell& cell) { return parts > 1 ? cell(box, parts) : cell(box); };
    if (sharp_) return over(*polynomial_);
    auto& last = last_[parts > 1];
    const auto same = [](const Interval& a, const Interval& b) { return a.lo == b.lo && a.hi == b.hi; };
    {
        const std::lock_guard lock(last_guard_);
        if (last && last->parts == parts && same(last->box.u, box.u) && same(last->box.v, box.v)) return last->model;
    }
    const auto own = [&] {
        const PolynomialCell p = source_->over(patch, box);
        return p.exists() && p.inaccuracy() <= kVague ? over(p) : SecondDerivatives();
    };
    // Intervals over the box are the fastest; over pieces of it they take longer than a model of any formula.
    SecondDerivatives found = source_->first() || parts > 1 ? own() : SecondDerivatives(patch, box);
    if (!found.bounded) found = source_->first() || parts > 1 ? SecondDerivatives(patch, box, parts) : own();
    auto fresh = std::make_unique<const Last>(Last{box, parts, found});
    const SecondDerivatives model = fresh->model;
    const std::lock_guard lock(last_guard_);
    last = std::move(fresh);
    return model;
}
BoundCell::~BoundCell() {
    for (auto& c : children_) delete c.load();
}

const BoundCell* BoundCell::child(const Patch& patch, const Box& of) const {
    const int k = (mid(of.u) >= mid(box_.u) ? 1 : 0) + (mid(of.v) >= mid(box_.v) ? 2 : 0);
    if (BoundCell* c = children_[k].load(std::memory_order_acquire)) return inside(of, c->reach_) ? c : nullptr;
    const Box half = half_of(box_, k);
    const double gu = 0.25 * (half.u.hi - half.u.lo), gv = 0.25 * (half.v.hi - half.v.lo);
    const Box reach{{std::max(reach_.u.lo, half.u.lo - gu), std::min(reach_.u.hi, half.u.hi + gu)}, {std::max(reach_.v.lo, half.v.lo - gv), std::min(reach_.v.hi, half.v.hi + gv)}};
    if (!inside(of, reach)) return nullptr;
    if (patch.domain() == Domain::triangle && mid(reach.u) + mid(reach.v) > 1) return nullptr;  // its centre has to be a point of the domain
    auto fresh = std::unique_ptr<BoundCell>(new BoundCell(patch, half, reach, *this));
    BoundCell* expected = nullptr;
    if (children_[k].compare_exchange_strong(expected, fresh.get(), std::memory_order_acq_rel)) return fresh.release();
    return expected;  // another thread was faster, with the same numbers
}

const BoundCell* BoundCell::around(const Patch& patch, const Box& box) const {
    const auto width = [](const Interval& x) { return x.hi - x.lo; };
    const BoundCell* cell = this;
    const auto large = [&] { return cell->sharp_ ? kLargePolynomial : kLarge; };
    while (width(cell->box_.u) > large() * width(box.u) && width(cell->box_.v) > large() * width(box.v)) {
        const BoundCell* finer = cell->child(patch, box);
        if (!finer) break;
        cell = finer;
    }
    return cell;
}

const BoundCell* BoundCell::sharp_cell(const Patch& patch, const Box& box) const {
    const BoundCell* cell = this;
    for (int depth = 0; cell && !cell->sharp_; ++depth) cell = depth < kDeepest && cell->wider(box) ? cell->child(patch, box) : nullptr;
    return cell;
}

TriangleBound BoundCell::bound(const Patch& patch, const BoundCell*& cell, const CornerData& triangle, double tolerance, Measure measure, double turn, bool decide) {
    const Box box = box_of(triangle.uv);
    const bool turns = turn != TriangleBound::unasked;
    const auto by = [&](const SecondDerivatives& model) { return model.bounded ? TriangleShape(model, triangle).bound(measure, false, turns, true) : TriangleBound{}; };
    // What no finer cell could go below, as far as the shape tells, whose bound is b.
    const auto least_of = [&](const TriangleShape& shape, const TriangleBound& b) { return b.quiet ? shape.least_normal() : shape.bound(measure, true, false, true).own(measure); };
    const auto passes = [&](const TriangleBound& b) { return b.own(measure) <= tolerance && (!turns || b.turn <= turn); };
    cell = cell->around(patch, box);
    for (;;) {
        double help = 1;  // where the cell tells nothing
        if (cell->model_.bounded) {
            const TriangleShape shape(cell->model_, triangle);
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
        if (!finer && help < kVagueShare) return by(cell->model_);
        if (!finer) break;
        cell = finer;
    }
    // The sharpest cell is the triangle's own box. Where second derivatives change too much, first ones may tell more.
    const SecondDerivatives model = cell->model_of(patch, box);
    TriangleBound sharpest = by(model);
    if (sharpest.own(measure) <= tolerance) return sharpest;
    if (model.bounded && least_of(TriangleShape(model, triangle), sharpest) > (decide ? tolerance : (1 - kClear) * sharpest.own(measure))) return sharpest;
    if (sharpest.own(measure) <= kNear * tolerance) {
        const TriangleBound finer = by(cell->model_of(patch, box, SecondDerivatives::pieces));
        if (finer.own(measure) < sharpest.own(measure)) sharpest = finer;
        if (sharpest.own(measure) <= tolerance) return sharpest;
    }
    if (cell->sharp_ && (sharpest.quiet || sharpest.own(measure) > kNear * tolerance)) return sharpest;  // first derivatives would not tell more
    const TriangleBound rough = bound_triangle(patch, triangle.uv, triangle.points);
    if (rough.parametric < sharpest.parametric) {
        sharpest.parametric = rough.parametric;
        if (!sharpest.quiet) sharpest.worst_edge = sharpest.worst_across = rough.worst_edge;
    }
    return sharpest;
}

namespace {

/// Bounds those of the triangles that are named, eight at a time: use(k, bound) for each.
template <class Use> void in_lanes(const PolynomialCell& cell, std::span<const CornerData> triangles, std::span<const int> which, const LanesAsked& asked, Use use) {
    constexpr std::size_t lanes = TriangleLanes::size;
    TriangleLanes eight;
    TriangleBound bounds[lanes];
    for (std::size_t first = 0; first < which.size(); first += lanes) {
        const std::size_t n = std::min(lanes, which.size() - first);
        for (std::size_t i = 0; i < lanes; ++i) eight.set(int(i), triangles[std::size_t(which[first + std::min(i, n - 1)])]);
        bound_lanes(cell, {&eight, 1}, int(n), asked, bounds);
        for (std::size_t i = 0; i < n; ++i) use(which[first + i], bounds[i]);
    }
}

}  // namespace

/// Bounds that are above the tolerance, in the order of bound(): third derivatives over pieces where that may help, first derivatives in the end.
void BoundCell::sharpen(const Patch& patch, std::span<const CornerData> triangles, std::span<const int> which, double tolerance, const LanesAsked& asked,
                        TriangleBound* bounds) const {
    std::vector<int> near, rough;
    const auto room = [&](int k) { return tolerance - triangles[std::size_t(k)].slack; };
    const auto own = [&](int k) { return bounds[k].own(asked.measure); };
    LanesAsked least = asked, pieces = asked;
    least.least = true, least.turns = false, pieces.parts = SecondDerivatives::pieces;
    in_lanes(*polynomial_, triangles, which, least, [&](int k, const TriangleBound& b) {
        if (!(b.own(asked.measure) > (1 - kClear) * own(k)) && own(k) <= kNear * room(k)) near.push_back(k);
    });
    in_lanes(*polynomial_, triangles, near, pieces, [&](int k, const TriangleBound& b) {
        if (b.own(asked.measure) < own(k)) bounds[k] = b;
        if (!(own(k) <= room(k)) && !bounds[k].quiet) rough.push_back(k);
    });
    for (const int k : rough) {
        const TriangleBound b = bound_triangle(patch, triangles[std::size_t(k)].uv, triangles[std::size_t(k)].points);
        if (!(b.parametric < bounds[k].parametric)) continue;
        bounds[k].parametric = b.parametric;
        bounds[k].worst_edge = bounds[k].worst_across = b.worst_edge;
    }
}

namespace {

LanesAsked asked_of(Measure measure, double turn) { return {measure, 1, false, turn != TriangleBound::unasked}; }
std::vector<int> all_of(std::span<const CornerData> triangles) {
    std::vector<int> all(triangles.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
}

}  // namespace

void BoundCell::sharpen(const Patch& patch, std::span<const CornerData> triangles, double tolerance, Measure measure, double turn, TriangleBound* bounds) const {
    sharpen(patch, triangles, all_of(triangles), tolerance, asked_of(measure, turn), bounds);
}

void BoundCell::bound_all(const Patch& patch, std::span<const CornerData> triangles, double tolerance, Measure measure, double turn, bool quick, TriangleBound* bounds) const {
    const LanesAsked asked = asked_of(measure, turn);
    std::vector<int> above;
    in_lanes(*polynomial_, triangles, all_of(triangles), asked, [&](int k, const TriangleBound& b) {
        bounds[k] = b;
        if (!(b.own(measure) <= tolerance - triangles[std::size_t(k)].slack)) above.push_back(k);
    });
    if (!quick && !above.empty()) sharpen(patch, triangles, above, tolerance, asked, bounds);
}

}  // namespace isoparm
