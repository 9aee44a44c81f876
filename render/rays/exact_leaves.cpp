// The leaves of a patch: boxes over which it is a linear map plus a remainder with a proved bound.
#include <algorithm>
#include <cmath>
#include <limits>

#include "error.h"
#include "rays/exact_patch.h"

namespace isoparm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFlat = 0.25;         // |I - Y J| of leaves, seen face on
constexpr double kLargest = 1.0 / 8;   // half a leaf's side, in sizes of the scene
constexpr double kSmallest = 5e-4;     // leaves below this are not cut any further before there is a ray
constexpr int kDepth = 12;             // bisections of the domain to leaves
constexpr int kKept = 20;              // bisections of leaves that are kept for other rays,
constexpr std::size_t kMostKept = 100'000;  // and how many of a patch: 30 MB
constexpr double kSlender = 6;         // sides of a leaf: the longer one is halved beyond this
constexpr double kRounding = 1e-14;    // relative: far above that of a few operations in double

double length_of(const Vec3<Interval>& d) { return rounding::length_up(mag(d.x), mag(d.y), mag(d.z)); }
Point middle(const Vec3<Interval>& x) { return {mid(x.x), mid(x.y), mid(x.z)}; }
double radius(const Vec3<Interval>& x) { return rounding::length_up(rad(x.x), rad(x.y), rad(x.z)); }
bool bounded(const Vec3<Interval>& x) { return x.x.bounded() && x.y.bounded() && x.z.bounded(); }

/// The Taylor coefficient of a jet with index k.
template <class Jets> Vec3<Interval> coefficient(const Jets& j, int k) { return {j.x.c[k], j.y.c[k], j.z.c[k]}; }

/// Of patches that are moved, and know their polynomials but not how to run them.
PolynomialCells cells_of(const Patch& patch) {
    const auto us = patch.lines_u(), vs = patch.lines_v();
    std::vector<PolynomialCells::Form> forms;
    for (std::size_t i = 0; i + 1 < us.size(); ++i)
        for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
            forms.push_back(patch.exact_cell(i, j));
            if (forms.back().size() < 3 || forms.back().size() != forms.front().size()) return {};
        }
    return {us, vs, forms};
}

Interval part_of(const Interval& t, bool upper) { return upper ? Interval(mid(t), t.hi) : Interval(t.lo, mid(t)); }

}  // namespace

ExactPatch::Leaf::~Leaf() {
    for (const auto& half : halves) delete half.load(std::memory_order_acquire);
}

void ExactPatch::set(Leaf& leaf, const Box& given, std::uint32_t cell) const {
    leaf.box = given, leaf.cell = cell;
    if (patch_.domain() == Domain::triangle) {
        leaf.box.u.hi = std::min(given.u.hi, 1 - given.v.lo);
        leaf.box.v.hi = std::min(given.v.hi, 1 - given.u.lo);
        leaf.slanted = leaf.box.u.hi + leaf.box.v.hi > 1;
    }
    const auto outer = [](const std::vector<double>& lines, double x) { return std::find(lines.begin(), lines.end(), x) != lines.end(); };
    leaf.outer[0] = outer(lines_u_, leaf.box.u.lo), leaf.outer[1] = leaf.box.u.hi != given.u.hi || outer(lines_u_, leaf.box.u.hi);
    leaf.outer[2] = outer(lines_v_, leaf.box.v.lo), leaf.outer[3] = leaf.box.v.hi != given.v.hi || outer(lines_v_, leaf.box.v.hi);
    const auto by_model = pieces_ ? pieces_->enclose(leaf.top, leaves_[leaf.top].box, leaf.box) : std::nullopt;
    const Enclosure e = by_model ? *by_model : patch_.enclose(leaf.box);
    leaf.u = e.u, leaf.v = e.v;
    leaf.hu = rad(leaf.box.u), leaf.hv = rad(leaf.box.v);
    const auto s = coefficient(e.centre, 0), su = coefficient(e.centre, 1), sv = coefficient(e.centre, 2);
    Vec3<Interval> values = coefficient(e.over, 0);
    const auto over_u = coefficient(e.over, 1), over_v = coefficient(e.over, 2);
    leaf.bend = leaf.turn_u = leaf.turn_v = leaf.uu = leaf.uv = leaf.vv = kInfinity;
    if (bounded(s) && bounded(su) && bounded(sv) && bounded(over_u) && bounded(over_v)) {
        leaf.s = middle(s), leaf.a = leaf.hu * middle(su), leaf.b = leaf.hv * middle(sv);
        leaf.size_s = length(leaf.s), leaf.size_a = length(leaf.a), leaf.size_b = length(leaf.b);
        // The middle of the derivatives lies in their range: that is what continues S beyond the leaf (docs/exact.md).
        const double turn_u = leaf.hu * length_of(over_u - Vec3<Interval>(middle(su))) * (1 + kRounding);
        const double turn_v = leaf.hv * length_of(over_v - Vec3<Interval>(middle(sv))) * (1 + kRounding);
        leaf.turn_u = turn_u + (leaf.slanted ? turn_v : 0), leaf.turn_v = turn_v;
        const double uu = 2 * length_of(coefficient(e.over, 3)) * leaf.hu * leaf.hu, uv = length_of(coefficient(e.over, 4)) * leaf.hu * leaf.hv,
                     vv = 2 * length_of(coefficient(e.over, 5)) * leaf.hv * leaf.hv;
        const double second = 0.5 * uu + uv + 0.5 * vv;
        const double known = radius(s) + leaf.hu * radius(su) + leaf.hv * radius(sv);
        leaf.bend = (std::min(second, turn_u + turn_v) + known) * (1 + kRounding) + kRounding * (leaf.size_s + leaf.size_a + leaf.size_b);
        if (std::isfinite(second)) leaf.uu = uu * (1 + kRounding), leaf.uv = uv * (1 + kRounding), leaf.vv = vv * (1 + kRounding);
        const auto suu = coefficient(e.centre, 3), suv = coefficient(e.centre, 4), svv = coefficient(e.centre, 5);
        if (std::isfinite(second) && bounded(suu) && bounded(suv) && bounded(svv))
            leaf.second[0] = (2 * leaf.hu * leaf.hu) * middle(suu), leaf.second[1] = (leaf.hu * leaf.hv) * middle(suv), leaf.second[2] = (2 * leaf.hv * leaf.hv) * middle(svv);
        if (!std::isfinite(leaf.bend)) leaf.bend = leaf.turn_u = leaf.turn_v = kInfinity;
        for (int k = 0; k < 3 && std::isfinite(leaf.bend); ++k) {
            const double reach = (std::fabs(leaf.a[k]) + std::fabs(leaf.b[k]) + leaf.bend) * (1 + kRounding);
            values[k] = {std::max(values[k].lo, leaf.s[k] - reach), std::min(values[k].hi, leaf.s[k] + reach)};
        }
    }
    leaf.values = {{values.x.lo - slack_, values.y.lo - slack_, values.z.lo - slack_}, {values.x.hi + slack_, values.y.hi + slack_, values.z.hi + slack_}};
}

/// Across the direction that gains more: q of a leaf seen face on is turn_u / a + turn_v / b.
std::array<Box, 2> ExactPatch::halves(const Leaf& leaf) {
    const double a = leaf.size_a, b = leaf.size_b;
    bool along_u = std::isfinite(leaf.bend) ? a >= b : leaf.hu >= leaf.hv;
    if (std::isfinite(leaf.uu) && a > 0 && b > 0) {
        const double by_u = leaf.uu / a + leaf.uv / b, by_v = leaf.vv / b + leaf.uv / a;
        const bool slender = std::max(a, b) > kSlender * std::min(a, b);  // near a pole, where ranges say little
        if (std::max(by_u, by_v) > 1e-2 && !slender) along_u = by_u > by_v;
    }
    if (along_u) return {{{part_of(leaf.box.u, false), leaf.box.v}, {part_of(leaf.box.u, true), leaf.box.v}}};
    return {{{leaf.box.u, part_of(leaf.box.v, false)}, {leaf.box.u, part_of(leaf.box.v, true)}}};
}

const ExactPatch::Leaf* ExactPatch::half_of(const Leaf& leaf, int k, std::vector<std::unique_ptr<const Leaf>>& kept) const {
    std::atomic<const Leaf*>& known = leaf.halves[static_cast<std::size_t>(k)];
    if (const Leaf* half = known.load(std::memory_order_acquire)) return half;
    const Box box = halves(leaf)[static_cast<std::size_t>(k)];
    if (outside(box)) return nullptr;
    auto made = std::make_unique<Leaf>();
    made->top = leaf.top, made->depth = leaf.depth + 1;
    set(*made, box, leaf.cell);
    if (made->depth > kKept || kept_.fetch_add(1, std::memory_order_relaxed) >= kMostKept) return kept.emplace_back(std::move(made)).get();
    const Leaf* none = nullptr;
    if (known.compare_exchange_strong(none, made.get(), std::memory_order_acq_rel, std::memory_order_acquire)) return made.release();
    return none;  // another thread was faster, with the same numbers
}

void ExactPatch::add_leaves(const Box& box, std::uint32_t cell, int depth) {
    if (outside(box)) return;
    Leaf& leaf = leaves_.emplace_back();
    set(leaf, box, cell);
    const double a = leaf.size_a, b = leaf.size_b, area = length(cross(leaf.a, leaf.b));
    const bool flat = b * leaf.turn_u + a * leaf.turn_v <= kFlat * area && std::max(a, b) <= kLargest * size_;
    const bool finite_box = finite(leaf.values.low) && finite(leaf.values.high);
    if (flat || depth == 0 || (finite_box && leaf.values.diagonal() <= kSmallest * size_)) {
        leaf.top = static_cast<std::uint32_t>(leaves_.size() - 1);
        if (!finite_box) throw_input("--exact: the positions of the patch have no bound near u = " + to_text(leaf.u) + ", v = " + to_text(leaf.v));
        return;
    }
    const auto parts = halves(leaf);
    leaves_.pop_back();
    for (const Box& half : parts) add_leaves(half, cell, depth - 1);
}

ExactPatch::ExactPatch(const Patch& patch, double size)
    : patch_(patch), own_cells_(patch.batch() ? PolynomialCells() : cells_of(patch)), cells_(patch_.batch() ? patch_.batch() : own_cells_.exist() ? &own_cells_ : nullptr), kernel_(exact_kernel(chosen_isa())), lines_u_(patch.lines_u()), lines_v_(patch.lines_v()), size_(size), slack_(slack(size)) {
    std::uint32_t cell = 0;
    for (std::size_t i = 0; i + 1 < lines_u_.size(); ++i)
        for (std::size_t j = 0; j + 1 < lines_v_.size(); ++j) add_leaves({{lines_u_[i], lines_u_[i + 1]}, {lines_v_[j], lines_v_[j + 1]}}, cell++, kDepth);
    if (!cells_) pieces_ = std::make_unique<ExactPieces>(patch_, size_, leaves_.size());
}

}  // namespace isoparm
