#include "rays/exact_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace isoparm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kPlaces = 1000, kSingularPlaces = 200;  // boxes that a ray may look at in one leaf; where derivatives vanish in it, more find nothing more
constexpr double kPoint = 1e-9;        // boxes of this size, in sizes of the scene, are not halved again
constexpr double kSharp = 5e-12, kSharpPiece = 1e-11, kSharpGrazing = 1e-10;  // proved errors, in sizes of the scene, that need not be sharper
constexpr double kBetweenLeaves = 1e-3;  // of what counts as meeting a border: between leaves only rounding must not lose a root
constexpr double kSpace = 1.7320509;     // at least the length of a vector of coordinates 1
constexpr int kSteps = 24;

Point middle(const Vec3<Interval>& x) { return {mid(x.x), mid(x.y), mid(x.z)}; }
double radius(const Vec3<Interval>& x) { return rounding::length_up(rad(x.x), rad(x.y), rad(x.z)); }

/// Of the place of the leaf's map.
Vec2 nearest_parameters(const LeafMap& leaf, double x, double y) {
    const double u = std::clamp(leaf.u + x * leaf.hu, leaf.box.u.lo, leaf.box.u.hi), v = std::clamp(leaf.v + y * leaf.hv, leaf.box.v.lo, leaf.box.v.hi);
    return {u, leaf.slanted && u + v > 1 ? 1 - u : v};
}

}  // namespace

// ---- rays, one leaf -------------------------------------------------------------------------------------------------
void ExactPatch::aim(const Leaf& leaf, const RayPacket& rays, double const* farthest, int n, AimPacket& out) const {
    if (std::isfinite(leaf.bend)) return kernel_.aim(leaf, rays, slack_, farthest, n, out);
    std::fill_n(out.verdict, RayPacket::lanes, AimPacket::open);
}

/// Of the lanes that need them.
void ExactPatch::frames(const Leaf& leaf, const ExactPiece* quotient, int n, NewtonPacket& p) const {
    double* rows[9];
    for (int i = 0; i < 9; ++i) rows[i] = p.frame[i];
    const auto points = static_cast<std::size_t>(n);
    if (cells_) return cells_->frames_in(leaf.cell, chosen_isa(), points, p.u, p.v, rows);
    if (quotient) return quotient->frames(points, p.u, p.v, rows);
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
    const ExactPiece* known = quotient(leaf);
    // Quotients of leaves differ by their errors.
    const double between = std::max(kBetweenLeaves, known ? 2 * kSpace * known->error.position / slack_ : 0);
    for (int step = 0; step < kSteps && going; ++step) {
        frames(leaf, known, n, p);
        going = kernel_.step(leaf, rays, aim, step < 8, between, n, p);
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
    // A root a little beyond the leaf is one of what continues S there.
    const double outside = std::fabs(p.x[lane] - p.cx[lane]) * leaf.size_a + std::fabs(p.y[lane] - p.cy[lane]) * leaf.size_b;
    const RayPlanes ray = rays.at(lane);
    const double rounding = 1e-15 * (std::fabs(p.distance[lane]) + leaf.size_s + leaf.size_a + leaf.size_b + leaf.bend + length(ray.origin));
    double beyond = p.beyond[lane];
    if (beyond > 0 && cells_) {  // the last step was by derivatives that are known to an error, and parameters are rounded
        const FrameError& of = cells_->error();
        beyond += kSpace * kLastStep * (leaf.hu * of.du + leaf.hv * of.dv);
        beyond += 2.3e-16 * (std::fabs(p.u[lane]) / leaf.hu * (leaf.size_a + leaf.turn_u) + std::fabs(p.v[lane]) / leaf.hv * (leaf.size_b + leaf.turn_v));
    }
    if (cells_) {
        const double error = distance_to_root(p.step_x[lane], p.step_y[lane], kSpace * cells_->error().position + beyond + rounding);
        if (error < kSharp * size_) return error + outside;
    }
    const auto error_of = [&](const Point& s, double off) {
        const Point to = s - ray.origin + (p.x[lane] - p.cx[lane]) * leaf.a + (p.y[lane] - p.cy[lane]) * leaf.b;
        const double f1 = dot(ray.n1, to), f2 = dot(ray.n2, to);
        return distance_to_root(aim.y11[lane] * f1 + aim.y12[lane] * f2, aim.y21[lane] * f1 + aim.y22[lane] * f2, off + rounding);
    };
    // Of grazing rays pieces do not tell as much; and those of parts of leaves are not made for the few rays that meet halves.
    const bool grazing = distance_to_root(0, 0, kSpace * ExactPieces::wanted * size_) >= kSharpPiece * size_;
    const auto known_by = [&](const ExactPiece* piece) {
        double s[9], *rows[9];
        for (int i = 0; i < 9; ++i) rows[i] = s + i;
        piece->frames(1, p.u + lane, p.v + lane, rows);
        return error_of({s[0], s[1], s[2]}, kSpace * piece->error.position);
    };
    for (const bool whole : {true, false}) {
        const ExactPiece* known = whole ? rough(leaf) : grazing || leaf.depth > 0 ? nullptr : piece(leaf.top, p.u[lane], p.v[lane]);
        if (!known) continue;
        const double error = known_by(known);
        if (error < (grazing ? kSharpGrazing : kSharpPiece) * size_) return error + outside;
    }
    const Vec3<Interval> s = patch_.enclose_point(p.u[lane], p.v[lane]);
    const double error = error_of(middle(s), radius(s));
    return error < 1e-6 * size_ ? error + outside : kInfinity;
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
    const int most = leaf.turn_u < leaf.size_a && leaf.turn_v < leaf.size_b ? kPlaces : kSingularPlaces;
    int places[packet] = {};
    while (!open.empty()) {
        const auto [at, lanes] = open.back();
        open.pop_back();
        const bool point = (std::isfinite(at->bend) && at->size_a + at->size_b + at->bend < kPoint * size_) || at->size_a + at->size_b < 1e-12 * at->size_s ||
                           std::max(at->hu, at->hv) < 1e-15 * std::max({1.0, std::fabs(at->u), std::fabs(at->v)});
        Lanes more = 0;
        for (int i = 0; i < n; ++i) {
            if (!(lanes >> i & 1)) continue;
            if (point || places[i] > most) settle(*at, rays.at(i), farthest[i], found[i]);
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

/// Frames of the lanes that need them, with what they are off where that is known: in the lanes returned.
ExactPatch::Lanes ExactPatch::set_frames(const std::uint32_t* leaf, Lanes active, CertainPacket& p) const {
    const ExactPiece* in[packet];
    for (int i = 0; i < packet; ++i) {
        if (!(active >> i & 1)) continue;
        // A rounded parameter may lie beyond the leaf.
        const Box& box = leaves_[leaf[i]].box;
        p.u[i] = std::clamp(p.u[i], box.u.lo, box.u.hi), p.v[i] = std::clamp(p.v[i], box.v.lo, box.v.hi);
        in[i] = piece(leaf[i], p.u[i], p.v[i]);
    }
    Lanes known = 0;
    while (active) {  // lanes of one piece
        const ExactPiece* one = in[__builtin_ctz(active)];
        double u[packet], v[packet], out[9][packet], *rows[9];
        int lane[packet], count = 0;
        for (Lanes m = active; m; m &= m - 1)
            if (const int i = __builtin_ctz(m); in[i] == one) u[count] = p.u[i], v[count] = p.v[i], lane[count++] = i, active &= ~(Lanes(1) << i);
        int n = count;
        for (; one && n % RayPacket::group != 0; ++n) u[n] = u[0], v[n] = v[0];  // whole vectors
        const auto points = static_cast<std::size_t>(n);
        for (int k = 0; k < 9; ++k) rows[k] = out[k];
        const auto three = [&](int of) { return std::array<std::span<double>, 3>{{{rows[of], points}, {rows[of + 1], points}, {rows[of + 2], points}}}; };
        if (one) one->frames(points, u, v, rows);
        else patch_.frames({u, points}, {v, points}, {three(0), three(3), three(6)});
        const FrameError off = one ? one->error : FrameError{};
        for (int k = 0; k < count; ++k) {
            const int i = lane[k];
            for (int row = 0; row < 9; ++row) p.frame[row][i] = out[row][k];
            p.off[p.of_s][i] = off.position, p.off[p.of_su][i] = off.du, p.off[p.of_sv][i] = off.dv;
            known |= Lanes(one != nullptr) << i;
        }
    }
    return known;
}

ExactPatch::Lanes ExactPatch::certify(const std::uint32_t* leaf, const RayPacket& rays, const float* x, const float* y, Lanes active, Root* root) const {
    Lanes proved = 0;
    const double sharp = (cells_ ? kSharp : kSharpPiece) * size_;
    CertainPacket p;
    while (active) {  // lanes of one cell, where there are cells
        const int first = __builtin_ctz(active);
        const std::uint32_t cell = leaves_[leaf[first]].cell;
        Lanes some = 0;
        for (int i = 0; i < packet; ++i) {
            const bool in = (active >> i & 1) && (!cells_ || leaves_[leaf[i]].cell == cell);
            const int from = in ? i : first;
            p.put(i, leaves_[leaf[from]]), p.x[i] = x[from], p.y[i] = y[from];
            some |= Lanes(in) << i;
        }
        active &= ~some;
        kernel_.parameters(p);
        if (cells_) p.set_off(cells_->error());
        double* rows[9];
        for (int i = 0; i < 9; ++i) rows[i] = p.frame[i];
        for (int step = 0; step < 3 && some; ++step) {
            Lanes known = some;
            if (!cells_) known = set_frames(leaf, some, p);
            else cells_->frames_in(cell, chosen_isa(), packet, p.u, p.v, rows);
            kernel_.certify(rays, p);
            for (int i = 0; i < packet; ++i) {
                if (!(some >> i & 1)) continue;
                if (!std::isfinite(p.error[i]) || (patch_.domain() == Domain::triangle && p.u[i] + p.v[i] > 1)) some &= ~(Lanes(1) << i);
                else if (p.error[i] < sharp || (!cells_ && step > 0)) {  // pieces do not tell enough of grazing rays
                    const double error = (known >> i & 1) && p.error[i] < sharp ? p.error[i] : enclosed_error(i, rays, p);
                    some &= ~(Lanes(1) << i);
                    if (!(error < sharp)) continue;
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
