#include "exact_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "error.h"
#include "local_frame.h"

namespace isoparm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRegular = 0.9;       // of |I - Y J|, which must be below 1: far enough from it for rounding not to matter
constexpr double kFlat = 0.4;          // the same of leaves, seen face on
constexpr double kLargest = 1.0 / 8;   // half a leaf's side, in sizes of the scene
constexpr double kSmallest = 5e-4;     // leaves below this are not cut any further before there is a ray
constexpr double kEdgeOn = 1e-9;       // det / (|a| |b|) below which rounding would count
constexpr int kDepth = 12;             // bisections of the domain to leaves
constexpr int kKept = 20;              // bisections of leaves that are kept for other rays,
constexpr std::size_t kMostKept = 100'000;  // and how many of a patch: 30 MB
constexpr double kSlender = 6;         // sides of a leaf: the longer one is halved beyond this
constexpr int kPlaces = 200;           // boxes that a ray may look at in one leaf
constexpr double kPoint = 1e-9;        // boxes of this size, in sizes of the scene, are not halved again
constexpr int kSteps = 24;
constexpr double kRounding = 1e-14;    // relative: far above that of a few operations in double

double length_of(const Vec3<Interval>& d) { return rounding::length_up(mag(d.x), mag(d.y), mag(d.z)); }
Point middle(const Vec3<Interval>& x) { return {mid(x.x), mid(x.y), mid(x.z)}; }
double radius(const Vec3<Interval>& x) { return rounding::length_up(rad(x.x), rad(x.y), rad(x.z)); }
bool bounded(const Vec3<Interval>& x) { return x.x.bounded() && x.y.bounded() && x.z.bounded(); }

/// The Taylor coefficient of a jet with index k.
template <class Jets> Vec3<Interval> coefficient(const Jets& j, int k) { return {j.x.c[k], j.y.c[k], j.z.c[k]}; }

Interval part_of(const Interval& t, bool upper) { return upper ? Interval(mid(t), t.hi) : Interval(t.lo, mid(t)); }

}  // namespace

RayPlanes::RayPlanes(const Ray& ray) : origin(ray.origin), direction(ray.direction) {
    const LocalFrame frame(direction);
    n1 = frame.x, n2 = frame.y;
}

// ---- leaves ---------------------------------------------------------------------------------------------------------
ExactPatch::Leaf::~Leaf() {
    for (const auto& half : halves) delete half.load(std::memory_order_acquire);
}

void ExactPatch::set(Leaf& leaf, const Box& given) const {
    leaf.box = given;
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
        // The middle of the derivatives lies in their range: that is what continues S beyond the leaf (docs/exact.md).
        const double turn_u = leaf.hu * length_of(over_u - Vec3<Interval>(middle(su))) * (1 + kRounding);
        const double turn_v = leaf.hv * length_of(over_v - Vec3<Interval>(middle(sv))) * (1 + kRounding);
        leaf.turn_u = turn_u + (leaf.slanted ? turn_v : 0), leaf.turn_v = turn_v;
        const double uu = 2 * length_of(coefficient(e.over, 3)) * leaf.hu * leaf.hu, uv = length_of(coefficient(e.over, 4)) * leaf.hu * leaf.hv,
                     vv = 2 * length_of(coefficient(e.over, 5)) * leaf.hv * leaf.hv;
        const double second = 0.5 * uu + uv + 0.5 * vv;
        const double known = radius(s) + leaf.hu * radius(su) + leaf.hv * radius(sv);
        leaf.bend = (std::min(second, turn_u + turn_v) + known) * (1 + kRounding) + kRounding * (length(leaf.s) + length(leaf.a) + length(leaf.b));
        if (std::isfinite(second)) leaf.uu = uu, leaf.uv = uv, leaf.vv = vv;
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
    const double a = length(leaf.a), b = length(leaf.b);
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
    set(*made, box);
    made->depth = leaf.depth + 1;
    if (made->depth > kKept || kept_.fetch_add(1, std::memory_order_relaxed) >= kMostKept) return kept.emplace_back(std::move(made)).get();
    const Leaf* none = nullptr;
    if (known.compare_exchange_strong(none, made.get(), std::memory_order_acq_rel, std::memory_order_acquire)) return made.release();
    return none;  // another thread was faster, with the same numbers
}

void ExactPatch::add_leaves(const Box& box, int depth) {
    if (outside(box)) return;
    Leaf& leaf = leaves_.emplace_back();
    set(leaf, box);
    const double a = length(leaf.a), b = length(leaf.b), area = length(cross(leaf.a, leaf.b));
    const bool flat = b * leaf.turn_u + a * leaf.turn_v <= kFlat * area && std::max(a, b) <= kLargest * size_;
    const bool finite_box = finite(leaf.values.low) && finite(leaf.values.high);
    if (flat || depth == 0 || (finite_box && leaf.values.diagonal() <= kSmallest * size_)) {
        if (!finite_box) throw_input("--exact: the positions of the patch have no bound near u = " + to_text(leaf.u) + ", v = " + to_text(leaf.v));
        return;
    }
    const auto parts = halves(leaf);
    leaves_.pop_back();
    for (const Box& half : parts) add_leaves(half, depth - 1);
}

ExactPatch::ExactPatch(const Patch& patch, double size) : patch_(patch), size_(size), slack_(slack(size)) {
    const auto us = patch.lines_u(), vs = patch.lines_v();
    for (std::size_t i = 0; i + 1 < us.size(); ++i)
        for (std::size_t j = 0; j + 1 < vs.size(); ++j) add_leaves({{us[i], us[i + 1]}, {vs[j], vs[j + 1]}}, kDepth);
}

// ---- one ray, one leaf ----------------------------------------------------------------------------------------------
ExactPatch::Aim ExactPatch::aim(const Leaf& leaf, const RayPlanes& ray, double farthest) const {
    Aim r;
    if (!std::isfinite(leaf.bend)) return r;
    const Point to = leaf.s - ray.origin;
    const double f1 = dot(ray.n1, to), f2 = dot(ray.n2, to);
    const double a1 = dot(ray.n1, leaf.a), a2 = dot(ray.n2, leaf.a), b1 = dot(ray.n1, leaf.b), b2 = dot(ray.n2, leaf.b);
    const double bend = leaf.bend + slack_ + kRounding * (std::fabs(to.x) + std::fabs(to.y) + std::fabs(to.z));
    r.verdict = Aim::Verdict::miss;
    if (std::fabs(f1) > std::fabs(a1) + std::fabs(b1) + bend || std::fabs(f2) > std::fabs(a2) + std::fabs(b2) + bend) return r;
    const double along = dot(ray.direction, to), da = std::fabs(dot(ray.direction, leaf.a)), db = std::fabs(dot(ray.direction, leaf.b));
    if (along + da + db + bend < 0 || along - da - db - bend > farthest) return r;

    // Seen from the ray, the leaf is a parallelogram, grown by bend: across its sides too, also where it is seen edge on. This is K(X)
    // that does not meet X, times det.
    const double det = a1 * b2 - a2 * b1, a = std::sqrt(a1 * a1 + a2 * a2), b = std::sqrt(b1 * b1 + b2 * b2);
    const double af = a2 * f1 - a1 * f2, bf = b1 * f2 - b2 * f1;
    if (std::fabs(bf) > std::fabs(det) + b * bend || std::fabs(af) > std::fabs(det) + a * bend) return r;
    r.verdict = Aim::Verdict::open;
    r.q = (b * leaf.turn_u + a * leaf.turn_v) / std::fabs(det);  // |Y (J - J(c))| <= (b, a) (turn_u, turn_v) / det, entry by entry: of rank 1
    if (!(r.q < kRegular) || !(std::fabs(det) > kEdgeOn * a * b)) return r;
    r.y11 = b2 / det, r.y12 = -b1 / det, r.y21 = -a2 / det, r.y22 = a1 / det;
    r.x = bf / det, r.y = af / det;
    r.verdict = Aim::Verdict::one;
    r.wx = b, r.wy = a;
    r.noise = 1e-15 * (length(to) + length(leaf.s)) / std::fabs(det);
    r.slack = slack_ / std::fabs(det);
    return r;
}

/// The parameters of (x,y), or of the nearest place in the leaf and the domain, which is (cx,cy).
Vec2 ExactPatch::place(const Leaf& leaf, double x, double y, double& cx, double& cy) const {
    cx = std::clamp(x, -1.0, 1.0), cy = std::clamp(y, -1.0, 1.0);
    Vec2 p{std::clamp(leaf.u + cx * leaf.hu, leaf.box.u.lo, leaf.box.u.hi), std::clamp(leaf.v + cy * leaf.hv, leaf.box.v.lo, leaf.box.v.hi)};
    if (leaf.slanted && p.x + p.y > 1) {
        p.y = 1 - p.x;
        cy = (p.y - leaf.v) / leaf.hv;
    }
    return p;
}

/// Newton's method for rays that have one root at most in the leaf, all of them at once. Beyond the leaf, S goes on as S(nearest place)
/// + a (x - cx) + b (y - cy), whose difference quotients have the same bounds.
void ExactPatch::solve(const Leaf& leaf, const RayPlanes* const* rays, const double* farthest, const Aim* aims, int n, Roots* const* found) const {
    double x[packet], y[packet], before[packet];
    int active[packet], count = n;
    for (int i = 0; i < n; ++i) active[i] = i, x[i] = std::clamp(aims[i].x, -1.0, 1.0), y[i] = std::clamp(aims[i].y, -1.0, 1.0), before[i] = kInfinity;
    double u[packet], v[packet], cx[packet], cy[packet], out[9][packet];
    for (int step = 0; step < kSteps && count > 0; ++step) {
        for (int k = 0; k < count; ++k) {
            const Vec2 p = place(leaf, x[active[k]], y[active[k]], cx[k], cy[k]);
            u[k] = p.x, v[k] = p.y;
        }
        const std::size_t size = static_cast<std::size_t>(count);
        const auto three = [&](int of) { return std::array<std::span<double>, 3>{{{out[of], size}, {out[of + 1], size}, {out[of + 2], size}}}; };
        patch_.frames({u, size}, {v, size}, {three(0), three(3), three(6)});
        int left = 0;
        for (int k = 0; k < count; ++k) {
            const int i = active[k];
            const Aim& aim = aims[i];
            const RayPlanes& ray = *rays[i];
            const double px = x[i] - cx[k], py = y[i] - cy[k];
            Point to = Point{out[0][k], out[1][k], out[2][k]} - ray.origin;
            if (px != 0) to += px * leaf.a;
            if (py != 0) to += py * leaf.b;
            const double f1 = dot(ray.n1, to), f2 = dot(ray.n2, to);
            const double sx = aim.y11 * f1 + aim.y12 * f2, sy = aim.y21 * f1 + aim.y22 * f2, move = std::max(std::fabs(sx) / aim.wx, std::fabs(sy) / aim.wy);
            if (!std::isfinite(move)) {  // the formula has no value here
                found[i]->undecided = true;
                continue;
            }
            const double within = move / (1 - aim.q);  // the root is that close
            const double wide = within + aim.slack;
            if (std::fabs(x[i]) > 1 + wide * aim.wx || std::fabs(y[i]) > 1 + wide * aim.wy) continue;
            if (leaf.slanted && py > wide * (aim.wy + leaf.hu / leaf.hv * aim.wx)) continue;
            if (move <= aim.noise || (move < 1e3 * aim.noise && move > 0.25 * before[i])) {
                Root root{dot(ray.direction, to), u[k], v[k], 0};
                if (root.distance >= 0 && root.distance <= farthest[i] && found[i]->count < Roots::most) {
                    prove(leaf, ray, aim, x[i], y[i], root);
                    found[i]->undecided = found[i]->undecided || !std::isfinite(root.error);
                    found[i]->root[found[i]->count++] = root;
                }
                continue;
            }
            before[i] = move;
            const Point su = px == 0 ? leaf.hu * Point{out[3][k], out[4][k], out[5][k]} : leaf.a;
            const Point sv = py == 0 ? leaf.hv * Point{out[6][k], out[7][k], out[8][k]} : leaf.b;
            const double a1 = dot(ray.n1, su), a2 = dot(ray.n2, su), b1 = dot(ray.n1, sv), b2 = dot(ray.n2, sv), det = a1 * b2 - a2 * b1;
            const double dx = (b2 * f1 - b1 * f2) / det, dy = (a1 * f2 - a2 * f1) / det;
            const bool newton = step < 8 && std::isfinite(dx) && std::isfinite(dy);  // otherwise the map that is proved to contract
            x[i] -= newton ? dx : sx, y[i] -= newton ? dy : sy;
            active[left++] = i;
        }
        count = left;
    }
    for (int k = 0; k < count; ++k) found[active[k]]->undecided = true;
}

/// Krawczyk's operator about what Newton found, with an enclosure of S there: the root is no farther than error.
void ExactPatch::prove(const Leaf& leaf, const RayPlanes& ray, const Aim& aim, double x, double y, Root& root) const {
    double cx = 0, cy = 0;
    const Vec2 p = place(leaf, x, y, cx, cy);
    const Vec3<Interval> s = patch_.enclose_point(p.x, p.y);
    Point to = middle(s) - ray.origin;
    to += (x - cx) * leaf.a;
    to += (y - cy) * leaf.b;
    const double off = radius(s) + 1e-15 * (length(to) + length(middle(s)) + length(ray.origin));
    const double f1 = dot(ray.n1, to), f2 = dot(ray.n2, to);
    const double mx = std::fabs(aim.y11 * f1 + aim.y12 * f2) + (std::fabs(aim.y11) + std::fabs(aim.y12)) * off;
    const double my = std::fabs(aim.y21 * f1 + aim.y22 * f2) + (std::fabs(aim.y21) + std::fabs(aim.y22)) * off;
    const double within = std::max(mx / aim.wx, my / aim.wy) / (1 - aim.q) * (1 + 1e-9);
    const double error = within * (aim.wx * (length(leaf.a) + leaf.turn_u) + aim.wy * (length(leaf.b) + leaf.turn_v));
    root.error = error < 1e-6 * size_ ? error : kInfinity;
}

/// Halves what is neither missed nor met once.
void ExactPatch::search(const Leaf& leaf, const RayPlanes& ray, double farthest, Roots& found) const {
    std::vector<const Leaf*> open{&leaf};
    std::vector<std::unique_ptr<const Leaf>> kept;
    int places = 0;
    while (!open.empty()) {
        const Leaf& at = *open.back();
        open.pop_back();
        if (places > kPlaces || (std::isfinite(at.bend) && length(at.a) + length(at.b) + at.bend < kPoint * size_) || length(at.a) + length(at.b) < 1e-12 * length(at.s) ||
            std::max(at.hu, at.hv) < 1e-15 * std::max({1.0, std::fabs(at.u), std::fabs(at.v)})) {
            settle(at, ray, farthest, found);
            continue;
        }
        for (int k = 0; k < 2; ++k) {
            const Leaf* part = half_of(at, k, kept);
            if (!part) continue;
            ++places;
            const Aim a = aim(*part, ray, farthest);
            Roots* to = &found;
            const RayPlanes* rays = &ray;
            if (a.verdict == Aim::Verdict::one) solve(*part, &rays, &farthest, &a, 1, &to);
            if (a.verdict == Aim::Verdict::open) open.push_back(part);
        }
    }
    halved_.fetch_add(static_cast<std::uint64_t>(places), std::memory_order_relaxed);
}

/// What is left of a search: a hit, though not a proved one, where the patch comes as good as up to the ray in this box; undecided in any
/// case. Levenberg's and Marquardt's method: there may be no inverse.
void ExactPatch::settle(const Leaf& leaf, const RayPlanes& ray, double farthest, Roots& found) const {
    found.undecided = true;
    double x = 0, y = 0, best = kInfinity, damping = 1e-6;
    Root root;
    root.error = kInfinity;
    Point du, dv, best_to;
    for (int step = 0; step < kSteps && damping < 1e6; ++step) {
        double cx = 0, cy = 0;
        const Vec2 p = place(leaf, x, y, cx, cy);
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

void ExactPatch::meet(std::size_t which, const RayPlanes* const* rays, const double* farthest, int n, Roots* found) const {
    const Leaf& leaf = leaves_[which];
    const RayPlanes* one[packet];
    double far[packet];
    Aim aims[packet];
    Roots* to[packet];
    int count = 0;
    for (int i = 0; i < n; ++i) {
        found[i].count = 0, found[i].undecided = false;
        const Aim a = aim(leaf, *rays[i], farthest[i]);
        if (a.verdict == Aim::Verdict::open) search(leaf, *rays[i], farthest[i], found[i]);
        if (a.verdict == Aim::Verdict::one) one[count] = rays[i], far[count] = farthest[i], aims[count] = a, to[count] = &found[i], ++count;
    }
    if (count > 0) solve(leaf, one, far, aims, count, to);
}

}  // namespace isoparm
