#include "exact_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "error.h"

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
constexpr int kPlaces = 200;           // boxes that a ray may look at in one leaf
constexpr double kPoint = 1e-9;        // boxes of this size, in sizes of the scene, are not halved again
constexpr double kSharp = 5e-12;       // proved errors, in sizes of the scene, that need not be sharper
constexpr int kSteps = 24;
constexpr double kRounding = 1e-14;    // relative: far above that of a few operations in double

double length_of(const Vec3<Interval>& d) { return rounding::length_up(mag(d.x), mag(d.y), mag(d.z)); }
Point middle(const Vec3<Interval>& x) { return {mid(x.x), mid(x.y), mid(x.z)}; }
double radius(const Vec3<Interval>& x) { return rounding::length_up(rad(x.x), rad(x.y), rad(x.z)); }
bool bounded(const Vec3<Interval>& x) { return x.x.bounded() && x.y.bounded() && x.z.bounded(); }

/// The Taylor coefficient of a jet with index k.
template <class Jets> Vec3<Interval> coefficient(const Jets& j, int k) { return {j.x.c[k], j.y.c[k], j.z.c[k]}; }

/// Of the place of the leaf's map.
Vec2 nearest_parameters(const LeafMap& leaf, double x, double y) {
    const double u = std::clamp(leaf.u + x * leaf.hu, leaf.box.u.lo, leaf.box.u.hi), v = std::clamp(leaf.v + y * leaf.hv, leaf.box.v.lo, leaf.box.v.hi);
    return {u, leaf.slanted && u + v > 1 ? 1 - u : v};
}

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

// ---- leaves ---------------------------------------------------------------------------------------------------------
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
    const Enclosure e = patch_.enclose(leaf.box);
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
    set(*made, box, leaf.cell);
    made->depth = leaf.depth + 1;
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
        if (!finite_box) throw_input("--exact: the positions of the patch have no bound near u = " + to_text(leaf.u) + ", v = " + to_text(leaf.v));
        return;
    }
    const auto parts = halves(leaf);
    leaves_.pop_back();
    for (const Box& half : parts) add_leaves(half, cell, depth - 1);
}

ExactPatch::ExactPatch(const Patch& patch, double size)
    : patch_(patch), own_cells_(patch.batch() ? PolynomialCells() : cells_of(patch)), cells_(patch_.batch() ? patch_.batch() : own_cells_.exist() ? &own_cells_ : nullptr), kernel_(exact_kernel(chosen_isa())), size_(size), slack_(slack(size)) {
    const auto us = patch.lines_u(), vs = patch.lines_v();
    std::uint32_t cell = 0;
    for (std::size_t i = 0; i + 1 < us.size(); ++i)
        for (std::size_t j = 0; j + 1 < vs.size(); ++j) add_leaves({{us[i], us[i + 1]}, {vs[j], vs[j + 1]}}, cell++, kDepth);
}

// ---- rays, one leaf -------------------------------------------------------------------------------------------------
void ExactPatch::aim(const Leaf& leaf, const RayPacket& rays, double const* farthest, int n, AimPacket& out) const {
    if (std::isfinite(leaf.bend)) return kernel_.aim(leaf, rays, slack_, farthest, n, out);
    std::fill_n(out.verdict, RayPacket::lanes, AimPacket::open);
}

/// Of the lanes that need them.
void ExactPatch::frames(const Leaf& leaf, int n, NewtonPacket& p) const {
    if (cells_) {
        double* rows[9];
        for (int i = 0; i < 9; ++i) rows[i] = p.frame[i];
        return cells_->frames_in(leaf.cell, chosen_isa(), static_cast<std::size_t>(n), p.u, p.v, rows);
    }
    double u[packet], v[packet], out[9][packet];
    int lane[packet];
    std::size_t count = 0;
    for (int i = 0; i < n; ++i)
        if (p.state[i] == NewtonPacket::active) u[count] = p.u[i], v[count] = p.v[i], lane[count++] = i;
    const auto three = [&](int of) { return std::array<std::span<double>, 3>{{{out[of], count}, {out[of + 1], count}, {out[of + 2], count}}}; };
    patch_.frames({u, count}, {v, count}, {three(0), three(3), three(6)});
    for (std::size_t k = 0; k < count; ++k)
        for (int i = 0; i < 9; ++i) p.frame[i][lane[k]] = out[i][k];
}

/// Newton's method for rays that have one root at most in the leaf, all of them at once.
void ExactPatch::solve(const Leaf& leaf, const RayPacket& rays, const double* farthest, const AimPacket& aim, int n, Roots* found) const {
    NewtonPacket p;
    kernel_.begin(leaf, rays, aim, n, p);
    bool going = true;
    for (int step = 0; step < kSteps && going; ++step) {
        frames(leaf, n, p);
        going = kernel_.step(leaf, rays, aim, step < 8, n, p);
    }
    for (int i = 0; i < n; ++i) {
        Roots& to = found[i];
        if (p.state[i] == NewtonPacket::active || p.state[i] == NewtonPacket::undecided) to.undecided = true;
        if (p.state[i] != NewtonPacket::found || !(p.distance[i] >= 0 && p.distance[i] <= farthest[i]) || to.count == Roots::most) continue;
        const double error = proved_error(leaf, rays, aim, p, i);
        to.undecided = to.undecided || !std::isfinite(error);
        to.root[to.count++] = {p.distance[i], p.u[i], p.v[i], error};
    }
}

/// Krawczyk's operator about what Newton found: the root is no farther than this from S(u,v). S(u,v) is known to the error that is proved of
/// the patch's polynomials; where that does not say enough, as for grazing rays, it is enclosed.
double ExactPatch::proved_error(const Leaf& leaf, const RayPacket& rays, const AimPacket& aim, const NewtonPacket& p, int lane) const {
    const auto distance_to_root = [&](double step_x, double step_y, double off) {
        const double mx = std::fabs(step_x) + (std::fabs(aim.y11[lane]) + std::fabs(aim.y12[lane])) * off;
        const double my = std::fabs(step_y) + (std::fabs(aim.y21[lane]) + std::fabs(aim.y22[lane])) * off;
        const double within = std::max(mx / aim.wx[lane], my / aim.wy[lane]) * aim.growth[lane] * (1 + 1e-9);
        return within * (aim.wx[lane] * (leaf.size_a + leaf.turn_u) + aim.wy[lane] * (leaf.size_b + leaf.turn_v));
    };
    const RayPlanes ray = rays.at(lane);
    const double rounding = 1e-15 * (std::fabs(p.distance[lane]) + leaf.size_s + leaf.size_a + leaf.size_b + leaf.bend + length(ray.origin));
    double beyond = p.beyond[lane];
    if (beyond > 0 && cells_) {  // the last step was by derivatives that are known to an error, and parameters are rounded
        const FrameError& of = cells_->error();
        beyond += 1.7320509 * kLastStep * (leaf.hu * of.du + leaf.hv * of.dv);
        beyond += 2.3e-16 * (std::fabs(p.u[lane]) / leaf.hu * (leaf.size_a + leaf.turn_u) + std::fabs(p.v[lane]) / leaf.hv * (leaf.size_b + leaf.turn_v));
    }
    if (cells_) {
        const double error = distance_to_root(p.step_x[lane], p.step_y[lane], 1.7320509 * cells_->error().position + beyond + rounding);
        if (error < kSharp * size_) return error;
    }
    const Vec3<Interval> s = patch_.enclose_point(p.u[lane], p.v[lane]);
    const Point to = middle(s) - ray.origin + (p.x[lane] - p.cx[lane]) * leaf.a + (p.y[lane] - p.cy[lane]) * leaf.b;
    const double f1 = dot(ray.n1, to), f2 = dot(ray.n2, to);
    const double error = distance_to_root(aim.y11[lane] * f1 + aim.y12[lane] * f2, aim.y21[lane] * f1 + aim.y22[lane] * f2, radius(s) + rounding);
    return error < 1e-6 * size_ ? error : kInfinity;
}

/// Finds the roots of rays that have one at most in the leaf; those that can have more.
ExactPatch::Lanes ExactPatch::visit(const Leaf& leaf, const RayPacket& rays, const double* farthest, int n, Lanes active, Roots* found) const {
    AimPacket to;
    aim(leaf, rays, farthest, n, to);
    Lanes open = 0;
    bool any = false;
    for (int i = 0; i < packet; ++i) {
        if (!(active >> i & 1)) to.verdict[i] = AimPacket::miss;
        open |= Lanes(to.verdict[i] == AimPacket::open) << i;
        any = any || to.verdict[i] == AimPacket::one;
    }
    if (any) solve(leaf, rays, farthest, to, n, found);
    return open;
}

/// Halves what is neither missed nor met once. Each ray sees the halves that it would see alone, in the same order.
void ExactPatch::search(const Leaf& leaf, const RayPacket& rays, const double* farthest, int n, Lanes active, Roots* found) const {
    std::vector<std::pair<const Leaf*, Lanes>> open{{&leaf, active}};
    std::vector<std::unique_ptr<const Leaf>> kept;
    int places[packet] = {};
    while (!open.empty()) {
        const auto [at, lanes] = open.back();
        open.pop_back();
        const bool point = (std::isfinite(at->bend) && at->size_a + at->size_b + at->bend < kPoint * size_) || at->size_a + at->size_b < 1e-12 * at->size_s ||
                           std::max(at->hu, at->hv) < 1e-15 * std::max({1.0, std::fabs(at->u), std::fabs(at->v)});
        Lanes more = 0;
        for (int i = 0; i < n; ++i) {
            if (!(lanes >> i & 1)) continue;
            if (point || places[i] > kPlaces) settle(*at, rays.at(i), farthest[i], found[i]);
            else more |= Lanes(1) << i;
        }
        for (int k = 0; k < 2 && more; ++k) {
            const Leaf* part = half_of(*at, k, kept);
            if (!part) continue;
            for (int i = 0; i < n; ++i) places[i] += more >> i & 1;
            if (const Lanes rest = visit(*part, rays, farthest, n, more, found)) open.emplace_back(part, rest);
        }
    }
    halved_.fetch_add(std::accumulate(places, places + n, std::uint64_t(0)), std::memory_order_relaxed);
}

/// What is left of a search: a hit, though not a proved one, where the patch comes as good as up to the ray in this box; undecided in any
/// case. Levenberg's and Marquardt's method: there may be no inverse.
void ExactPatch::settle(const Leaf& leaf, const RayPlanes& ray, double farthest, Roots& found) const {
    found.undecided = true;
    double x = 0, y = 0, best = kInfinity, damping = 1e-6;
    Root root{0, 0, 0, kInfinity};
    Point du, dv, best_to;
    for (int step = 0; step < kSteps && damping < 1e6; ++step) {
        const Vec2 p = nearest_parameters(leaf, x, y);
        const PointFrame f = patch_.frame(p.x, p.y);
        const Point to = Point{f.x.c[0], f.y.c[0], f.z.c[0]} - ray.origin;
        const double off = std::hypot(dot(ray.n1, to), dot(ray.n2, to));
        if (off < best) {
            best = off, best_to = to, damping *= 0.1;
            root.u = p.x, root.v = p.y, root.distance = dot(ray.direction, to);
            du = leaf.hu * Point{f.x.c[1], f.y.c[1], f.z.c[1]}, dv = leaf.hv * Point{f.x.c[2], f.y.c[2], f.z.c[2]};
        } else {
            damping *= 10;
        }
        const double f1 = dot(ray.n1, best_to), f2 = dot(ray.n2, best_to), a1 = dot(ray.n1, du), a2 = dot(ray.n2, du), b1 = dot(ray.n1, dv), b2 = dot(ray.n2, dv);
        const double add = damping * (a1 * a1 + a2 * a2 + b1 * b1 + b2 * b2), aa = a1 * a1 + a2 * a2 + add, bb = b1 * b1 + b2 * b2 + add, ab = a1 * b1 + a2 * b2;
        const double af = a1 * f1 + a2 * f2, bf = b1 * f1 + b2 * f2, det = aa * bb - ab * ab;
        if (!(det > 0) || !std::isfinite(af + bf + det)) break;
        x = std::clamp((root.u - leaf.u) / leaf.hu - (bb * af - ab * bf) / det, -1.0, 1.0);
        y = std::clamp((root.v - leaf.v) / leaf.hv - (aa * bf - ab * af) / det, -1.0, 1.0);
    }
    if (!(best <= 4 * kPoint * size_) || root.distance < 0 || root.distance > farthest || found.count == Roots::most) return;
    for (int k = 0; k < found.count; ++k)
        if (std::fabs(found.root[k].distance - root.distance) <= 1e2 * kPoint * size_) return;
    found.root[found.count++] = root;
}

// ---- rays that surely meet leaves -----------------------------------------------------------------------------------
/// As proved_error(), where there is no proved error of frames.
double ExactPatch::enclosed_error(int i, const RayPacket& rays, const CertainPacket& p) const {
    const RayPlanes ray = rays.at(i);
    const Vec3<Interval> s = patch_.enclose_point(p.u[i], p.v[i]);
    const Point to = middle(s) - ray.origin;
    const auto vector = [&](int k) { return Point{p.leaf[k][i], p.leaf[k + 1][i], p.leaf[k + 2][i]}; };
    const Point a = vector(p.Ax), b = vector(p.Bx);
    const double a1 = dot(ray.n1, a), a2 = dot(ray.n2, a), b1 = dot(ray.n1, b), b2 = dot(ray.n2, b), det = std::fabs(a1 * b2 - a2 * b1);
    const double size_a = std::hypot(a1, a2), size_b = std::hypot(b1, b2), q = (size_b * p.leaf[p.turn_u][i] + size_a * p.leaf[p.turn_v][i]) / det;
    const double rounding = 1e-15 * (std::fabs(p.distance[i]) + p.leaf[p.sizes][i] + length(ray.origin));
    const double off = std::hypot(dot(ray.n1, to), dot(ray.n2, to)) + radius(s) + rounding;
    return off / (det * (1 - q)) * (1 + 1e-9) * (size_b * p.leaf[p.far_a][i] + size_a * p.leaf[p.far_b][i]);
}

ExactPatch::Lanes ExactPatch::certify(const std::uint32_t* leaf, const RayPacket& rays, const float* x, const float* y, Lanes active, Root* root) const {
    Lanes proved = 0;
    CertainPacket p;
    while (active) {  // lanes of one cell
        const int first = __builtin_ctz(active);
        const std::uint32_t cell = leaves_[leaf[first]].cell;
        Lanes some = 0;
        for (int i = 0; i < packet; ++i) {
            const bool in = (active >> i & 1) && leaves_[leaf[i]].cell == cell;
            const int from = in ? i : first;
            p.put(i, leaves_[leaf[from]]), p.x[i] = x[from], p.y[i] = y[from];
            some |= Lanes(in) << i;
        }
        active &= ~some;
        kernel_.parameters(p);
        double* rows[9];
        for (int i = 0; i < 9; ++i) rows[i] = p.frame[i];
        for (int step = 0; step < 3 && some; ++step) {
            if (cells_) cells_->frames_in(cell, chosen_isa(), packet, p.u, p.v, rows);
            else {
                const auto three = [&](int of) { return std::array<std::span<double>, 3>{{{rows[of], packet}, {rows[of + 1], packet}, {rows[of + 2], packet}}}; };
                patch_.frames({p.u, packet}, {p.v, packet}, {three(0), three(3), three(6)});
            }
            kernel_.certify(rays, cells_ ? cells_->error() : FrameError{}, p);
            for (int i = 0; i < packet; ++i) {
                if (!(some >> i & 1)) continue;
                if (!std::isfinite(p.error[i]) || (patch_.domain() == Domain::triangle && p.u[i] + p.v[i] > 1)) some &= ~(Lanes(1) << i);
                else if (p.error[i] < kSharp * size_) {
                    const double error = cells_ ? p.error[i] : enclosed_error(i, rays, p);
                    some &= ~(Lanes(1) << i);
                    if (!(error < kSharp * size_)) continue;
                    root[i] = {p.distance[i], p.u[i], p.v[i], error};
                    proved |= Lanes(1) << i;
                }
            }
        }
    }
    return proved;
}

void ExactPatch::meet(std::size_t which, const RayPacket& rays, const double* farthest, int n, Lanes active, Roots* found) const {
    for (int i = 0; i < n; ++i) found[i].count = 0, found[i].undecided = false;
    const Leaf& leaf = leaves_[which];
    if (const Lanes open = visit(leaf, rays, farthest, n, active & ((Lanes(2) << (n - 1)) - 1), found)) search(leaf, rays, farthest, n, open, found);
}

}  // namespace isoparm
