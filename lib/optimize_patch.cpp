#include "optimize_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <cstdio>
#include <cstdlib>
struct Stats { long n[8]={}; ~Stats(){ if(getenv("OPT_SAY")) printf("est-off %ld  near %ld nonquiet-unexpected %ld own-nb %ld other-nb %ld ok %ld nonquiet %ld\n",n[0],n[1],n[2],n[3],n[4],n[5],n[6]); } } stats;
#define STAT(k) (++stats.n[k])
namespace isoparm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostRing = 32;
constexpr std::size_t kMostLinks = 16;  // corners with more around them stay

double turn(const Vec2& a, const Vec2& b, const Vec2& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }
/// Counter-clockwise, and not by rounding only.
bool turns_left(const std::array<Vec2, 3>& p) {
    double most = 0;
    for (int k = 0; k < 3; ++k) {
        const Vec2 &a = p[k], &b = p[(k + 1) % 3];
        most = std::max(most, (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
    }
    return turn(p[0], p[1], p[2]) > 1e-9 * most;
}
double power(double e) {
    const double e2 = e * e, e4 = e2 * e2;
    return e4 * e4;
}

}  // namespace

Estimate estimate(const SecondDerivatives& s, const Places& t) {
    Estimate result;
    const auto& p = t.uv;
    const auto [u0, u1] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [v0, v1] = std::minmax({p[0].y, p[1].y, p[2].y});
    const double mu = 0.5 * (u0 + u1), mv = 0.5 * (v0 + v1), ru = 0.5 * (u1 - u0), rv = 0.5 * (v1 - v0), du = mu - s.u, dv = mv - s.v;
    const Point sides[3] = {t.x[1] - t.x[0], t.x[2] - t.x[1], t.x[0] - t.x[2]};
    const Point normal = cross(sides[0], sides[1]);
    const double twice_area = length(normal);
    if (!(twice_area > 0)) return result;
    const Point n = normal / twice_area;
    Point h[3];
    double along[4], all[4];
    for (int k = 0; k < 4; ++k) along[k] = std::fabs(dot(n, s.t[k])), all[k] = s.t_size[k] - s.t_rad[k];
    for (int k = 0; k < 3; ++k) h[k] = s.h[k] + du * s.t[k] + dv * s.t[k + 1];
    const double aspect = rv / ru;
    const auto diagonal = [&](const double* size) {
        const double suv = size[1] * ru + size[2] * rv;
        return Vec2{size[0] * ru + size[1] * rv + suv * aspect, size[2] * ru + size[3] * rv + suv / aspect};
    };
    const Vec2 qn = diagonal(along), qs = diagonal(all);
    double plus[3], minus[3], lengths[3], bends[3], strays[3];
    Point forms[3], inward[3];
    for (int k = 0; k < 3; ++k) lengths[k] = length(sides[k]);
    result.quiet = true;
    for (int k = 0; k < 3; ++k) {
        const double eu = p[(k + 1) % 3].x - p[k].x, ev = p[(k + 1) % 3].y - p[k].y;
        const Point b = eu * eu * h[0] + 2 * eu * ev * h[1] + ev * ev * h[2];
        const double bn = dot(n, b), q = qn.x * eu * eu + qn.y * ev * ev, qb = qs.x * eu * eu + qs.y * ev * ev;
        plus[k] = q + bn, minus[k] = q - bn;
        forms[k] = b, strays[k] = qb, inward[k] = cross(n, sides[k]) / lengths[k];
        const double across = std::fabs(dot(inward[k], b)) + qb, bend = bends[k] = length(b) + qb;
        const double lens = (across + 0.32 * (std::fabs(bn) + q)) * std::max(lengths[(k + 1) % 3], lengths[(k + 2) % 3]) * lengths[k];
        result.quiet = result.quiet && bend <= lengths[k] && lens <= 0.39 * twice_area * (2 * lengths[k] - bend);
        result.across[k] = across / 8;
    }
    // As in bound_cell.cpp: the map to the plane keeps its orientation.
    const int base = lengths[0] >= lengths[1] && lengths[0] >= lengths[2] ? 0 : lengths[1] >= lengths[2] ? 1 : 2, i = (base + 1) % 3, j = (base + 2) % 3;
    const auto at = [&](int k, int c) -> Point {
        const int after = (k + 1) % 3, last = (k + 2) % 3;
        if (c == k) return sides[k] - 0.5 * forms[k];
        if (c == after) return sides[k] + 0.5 * forms[k];
        return sides[k] + 0.5 * (forms[last] - forms[after]);
    };
    Point ai[3], aj[3];
    for (int c = 0; c < 3; ++c) ai[c] = at(i, c), aj[c] = at(j, c);
    double least = kInfinity;
    for (int c = 0; c < 3; ++c) {
        const int d = (c + 1) % 3;
        least = std::min({least, dot(n, cross(ai[c], aj[c])), 0.5 * (dot(n, cross(ai[c], aj[d])) + dot(n, cross(ai[d], aj[c])))});
    }
    const auto most = [&](int k) { return lengths[k] + 0.5 * (bends[0] + bends[1] + bends[2] + bends[k]); };
    const auto off = [&](int k) { return 0.5 * (strays[0] + strays[1] + strays[2] + strays[k]); };
    result.quiet = result.quiet && most(i) * off(j) + most(j) * off(i) + off(i) * off(j) < least;
    result.unit = n;
    result.normal = 0.5 * std::max(simplex_maximum(plus[0], plus[1], plus[2]), simplex_maximum(minus[0], minus[1], minus[2]));
    return result;
}

FreePatch::FreePatch(const Patch& patch, const PatchMesh& mesh, const std::vector<Point>& positions, double tolerance, Measure measure)
    : patch_(patch), tolerance_(tolerance), measure_(measure), breaks_u_(mesh.breaks_u), breaks_v_(mesh.breaks_v) {
    const std::vector<double> us = patch.lines_u(), vs = patch.lines_v();
    const auto column = [](const std::vector<double>& lines, double x) {
        const auto i = std::upper_bound(lines.begin(), lines.end(), x) - lines.begin() - 1;
        return std::clamp<std::ptrdiff_t>(i, 0, std::ptrdiff_t(lines.size()) - 2);
    };
    const auto is_break = [](const std::vector<double>& lines, double x) { return std::binary_search(lines.begin(), lines.end(), x); };
    corners_.resize(mesh.uv.size());
    for (std::size_t i = 0; i < corners_.size(); ++i) {
        FreeCorner& c = corners_[i];
        c.uv = mesh.uv[i], c.vertex = mesh.vertex[i], c.slack = mesh.slack[i], c.x = positions[c.vertex];
        const bool u = is_break(breaks_u_, c.uv.x), v = is_break(breaks_v_, c.uv.y);
        if (u || v) c.freedom = u && v ? Freedom::fixed : u ? Freedom::along_v : Freedom::along_u;
    }
    triangles_.resize(mesh.triangles.size());
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
        const PatchTriangle& from = mesh.triangles[i];
        FreeTriangle& t = triangles_[i];
        t.corner = from.corner, t.cell = from.cell, t.proof = from.proof, t.proved = true, t.left_out = mesh.left_out(from);
        Vec2 middle;
        for (int k = 0; k < 3; ++k) {
            const auto& side = mesh.edges[from.edge[k]].side;
            t.beside[k] = side[0] == i ? side[1] : side[0];
            corners_[t.corner[k]].triangle = i;
            middle.x += mesh.uv[t.corner[k]].x / 3, middle.y += mesh.uv[t.corner[k]].y / 3;
            if (t.left_out) corners_[t.corner[k]].freedom = Freedom::fixed;
        }
        const auto cell = patch.domain() == Domain::triangle ? 0 : column(us, middle.x) * (std::ptrdiff_t(vs.size()) - 1) + column(vs, middle.y);
        t.root = mesh.cells[std::size_t(cell)].get();
    }
    for (auto& t : triangles_)
        if (!t.left_out) t.own = estimate_of(places(t.corner), t);
    for (auto& t : triangles_) t.error = t.left_out ? 0 : error_of(t);
    triangle_epoch_.assign(triangles_.size(), 0);
    corner_epoch_.assign(corners_.size(), 0);
}

Places FreePatch::places(const std::array<std::uint32_t, 3>& corner) const {
    Places p;
    for (int k = 0; k < 3; ++k) {
        const FreeCorner& c = corners_[corner[k]];
        p.uv[k] = c.uv, p.x[k] = c.x, p.slack = std::max(p.slack, c.slack);
    }
    return p;
}

Estimate FreePatch::estimate_of(const Places& p, const FreeTriangle& like) const {
    Estimate result;
    result.parametric = kInfinity;
    if (!turns_left(p.uv)) return result;
    const SecondDerivatives& model = like.cell->model();
    if (model.bounded && measure_ == Measure::geometric) {
        result = estimate(model, p);
    }
    if (!result.quiet) {
        TriangleBound b;
        const CornerData data{p.uv, p.x, p.slack};
        if (model.bounded) b = bound_triangle(model, data, measure_);
        else {
            const BoundCell* cell = like.root;
            b = BoundCell::bound(patch_, cell, data, tolerance_ - p.slack, measure_);
        }
        result = {b.parametric, b.normal, b.across, b.unit, measure_ == Measure::geometric && b.quiet};
    }
    result.parametric = (result.parametric + p.slack) / tolerance_;
    result.normal = (result.normal + p.slack) / tolerance_;
    for (double& x : result.across) x /= tolerance_;
    return result;
}

double FreePatch::beyond(const Estimate& t, int k, const Estimate* other) const {
    if (other && other->quiet) {
        const Point d = t.unit - other->unit;
        const double square = dot(d, d), cosine = 1 - 0.5 * square;
        if (cosine >= 0.95) return std::max(t.normal, other->normal / cosine) + t.across[k] * (std::sqrt(square) / cosine);
    }
    return std::sqrt(t.normal * t.normal + t.across[k] * t.across[k]);
}

/// As geometric_bound().
double FreePatch::error_of(const FreeTriangle& t) const {
    if (!t.own.quiet) return t.own.parametric;
    double most = t.own.normal;
    for (int k = 0; k < 3; ++k) {
        const auto j = t.beside[k];
        const bool open = j == kNone || triangles_[j].left_out || triangles_[j].root != t.root;
        most = std::max(most, beyond(t.own, k, open ? nullptr : &triangles_[j].own));
    }
    return most;
}

/// The errors of triangles whose own estimates are new, and of those beside them.
void FreePatch::update(const std::vector<std::uint32_t>& changed) {
    for (const auto i : changed) {
        triangles_[i].error = error_of(triangles_[i]);
        for (const auto j : triangles_[i].beside)
            if (j != kNone && !triangles_[j].left_out) touch(j), triangles_[j].error = error_of(triangles_[j]);
    }
}

Ring FreePatch::ring(std::uint32_t corner) const {
    Ring r;
    const auto first = corners_[corner].triangle;
    const auto place = [&](std::uint32_t t) {
        const auto& c = triangles_[t].corner;
        return c[0] == corner ? 0 : c[1] == corner ? 1 : 2;
    };
    // Clockwise to the rim, or once around.
    auto t = first;
    for (;;) {
        const auto before = triangles_[t].beside[place(t)];
        if (before == kNone) break;
        t = before;
        if (t == first) break;
    }
    const auto begin = t;
    for (;;) {
        const int k = place(t);
        r.triangles.push_back(t);
        r.links.push_back(triangles_[t].corner[(k + 1) % 3]);
        const auto next = triangles_[t].beside[(k + 2) % 3];
        if (next == begin) return r;
        if (next == kNone) {
            r.links.push_back(triangles_[t].corner[(k + 2) % 3]);
            r.closed = false;
            return r;
        }
        t = next;
    }
}

double FreePatch::energy(const Ring& ring) const {
    double sum = 0;
    for (const auto t : ring.triangles) sum += power(triangles_[t].error);
    return sum;
}

double FreePatch::energy_at(const Ring& ring, std::uint32_t corner, const Vec2& uv, const Point& x) const {
    const std::size_t n = ring.triangles.size();
    std::array<Estimate, kMostRing> own;
    if (n > kMostRing) return kInfinity;
    for (std::size_t i = 0; i < n; ++i) {
        const FreeTriangle& t = triangles_[ring.triangles[i]];
        if (t.left_out) return kInfinity;
        Places p = places(t.corner);
        const int k = t.corner[0] == corner ? 0 : t.corner[1] == corner ? 1 : 2;
        p.uv[k] = uv, p.x[k] = x;
        own[i] = estimate_of(p, t);
        if (!(own[i].least() < kInfinity)) return kInfinity;
    }
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const FreeTriangle& t = triangles_[ring.triangles[i]];
        const int k = t.corner[0] == corner ? 0 : t.corner[1] == corner ? 1 : 2;
        double most = own[i].least();
        if (own[i].quiet) {
            const auto inner = [&](bool exists, std::size_t j) { return exists && triangles_[ring.triangles[j % n]].root == t.root ? &own[j % n] : nullptr; };
            const auto out = t.beside[(k + 1) % 3];
            const bool open = out == kNone || triangles_[out].left_out || triangles_[out].root != t.root;
            most = std::max({most, beyond(own[i], k, inner(ring.closed || i > 0, i + n - 1)), beyond(own[i], (k + 2) % 3, inner(ring.closed || i + 1 < n, i + 1)),
                             beyond(own[i], (k + 1) % 3, open ? nullptr : &triangles_[out].own)});
        }
        sum += power(most);
    }
    return sum;
}

void FreePatch::begin() {
    open_ = true;
    ++epoch_;
    old_triangles_.clear();
    old_corners_.clear();
}
void FreePatch::touch(std::uint32_t t) {
    if (triangle_epoch_[t] == epoch_) return;
    triangle_epoch_[t] = epoch_;
    old_triangles_.push_back({t, triangles_[t]});
}
void FreePatch::touch_corner(std::uint32_t c) {
    if (corner_epoch_[c] == epoch_) return;
    corner_epoch_[c] = epoch_;
    old_corners_.push_back({c, corners_[c]});
}
void FreePatch::take_back() {
    for (const auto& [i, t] : old_triangles_) triangles_[i] = t;
    for (const auto& [i, c] : old_corners_) corners_[i] = c;
    open_ = false;
}

void FreePatch::move(std::uint32_t corner, const Vec2& uv, const Point& x) {
    touch_corner(corner);
    FreeCorner& c = corners_[corner];
    c.uv = uv, c.x = x;
    const Ring r = ring(corner);
    for (const auto i : r.triangles) {
        touch(i);
        FreeTriangle& t = triangles_[i];
        t.proved = false;
        t.own = estimate_of(places(t.corner), t);
    }
    update(r.triangles);
}

bool FreePatch::on_break(std::uint32_t a, std::uint32_t b) const {
    const auto along = [](double x, double y, const std::vector<double>& breaks) { return x == y && std::binary_search(breaks.begin(), breaks.end(), x); };
    return along(corners_[a].uv.x, corners_[b].uv.x, breaks_u_) || along(corners_[a].uv.y, corners_[b].uv.y, breaks_v_);
}

/// A new edge inside the patch: not between two vertices that another edge may join, and not across a break.
bool FreePatch::may_join(std::uint32_t a, std::uint32_t b) const {
    const FreeCorner &p = corners_[a], &q = corners_[b];
    if (p.vertex == q.vertex || on_break(a, b)) return false;
    const auto on_rim = [](const FreeCorner& c) { return c.freedom == Freedom::rim || c.freedom == Freedom::fixed; };
    return !(on_rim(p) && on_rim(q));
}

bool FreePatch::flip(std::uint32_t i, int k) {
    const std::uint32_t j = triangles_[i].beside[k];
    if (j == kNone || triangles_[i].left_out || triangles_[j].left_out) return false;
    const FreeTriangle ti = triangles_[i], tj = triangles_[j];
    const auto a = ti.corner[k], b = ti.corner[(k + 1) % 3], c = ti.corner[(k + 2) % 3];
    const int m = tj.corner[0] == b ? 0 : tj.corner[1] == b ? 1 : 2;  // edge m of tj is b to a
    const auto d = tj.corner[(m + 2) % 3];
    if (on_break(a, b) || ti.root != tj.root || !may_join(c, d)) return false;
    const Estimate first = estimate_of(places({a, d, c}), ti), second = estimate_of(places({d, b, c}), tj);
    const auto outer = [&](const FreeTriangle& t, int edge) {
        const auto o = t.beside[edge % 3];
        return o == kNone || triangles_[o].left_out || triangles_[o].root != t.root ? nullptr : &triangles_[o].own;
    };
    const auto with = [&](const Estimate& e, const Estimate* x, const Estimate* y, const Estimate& z, int kx, int ky, int kz) {
        return e.quiet ? std::max({e.normal, beyond(e, kx, x), beyond(e, ky, y), beyond(e, kz, &z)}) : e.parametric;
    };
    const double after = power(with(first, outer(tj, m + 1), outer(ti, k + 2), second, 0, 2, 1)) + power(with(second, outer(tj, m + 2), outer(ti, k + 1), first, 0, 1, 2));
    if (!(after < (power(ti.error) + power(tj.error)) * (1 - 1e-6))) return false;
    touch(i), touch(j);
    for (const auto x : {a, b, c, d}) touch_corner(x);
    FreeTriangle &ni = triangles_[i], &nj = triangles_[j];
    ni.corner = {a, d, c}, ni.beside = {tj.beside[(m + 1) % 3], j, ti.beside[(k + 2) % 3]}, ni.own = first, ni.proved = false;
    nj.corner = {d, b, c}, nj.beside = {tj.beside[(m + 2) % 3], ti.beside[(k + 1) % 3], i}, nj.own = second, nj.proved = false;
    const auto rename = [&](std::uint32_t t, std::uint32_t from, std::uint32_t to) {
        if (t == kNone) return;
        touch(t);
        for (auto& x : triangles_[t].beside)
            if (x == from) x = to;
    };
    rename(ni.beside[0], j, i);
    rename(nj.beside[1], i, j);
    corners_[a].triangle = i, corners_[b].triangle = j, corners_[c].triangle = i, corners_[d].triangle = i;
    update({i, j});
    return true;
}

double FreePatch::worst_change() const {
    double worst = 0;
    for (const auto& [i, old] : old_triangles_)
        if (triangles_[i].live && !triangles_[i].left_out) worst = std::max(worst, triangles_[i].error);
    return worst;
}

void FreePatch::prove(std::uint32_t i) {
    FreeTriangle& t = triangles_[i];
    const Places p = places(t.corner);
    t.cell = t.root;
    t.proof = BoundCell::bound(patch_, t.cell, {p.uv, p.x, p.slack}, tolerance_ - p.slack, measure_);
    t.proved = true, t.sharp = false;
}

/// As Refinement::bound_of, which has the last word.
bool FreePatch::holds(std::uint32_t i) const {
    const FreeTriangle& t = triangles_[i];
    double slack = places(t.corner).slack;
    if (measure_ == Measure::parametric || !t.proof.quiet) return rounding::up(t.proof.parametric + slack) <= tolerance_;
    std::array<const TriangleBound*, 3> neighbours{};
    for (int k = 0; k < 3; ++k) {
        const auto j = t.beside[k];
        if (j == kNone || triangles_[j].left_out || on_break(t.corner[k], t.corner[(k + 1) % 3])) continue;
        neighbours[k] = &triangles_[j].proof;
        slack = std::max(slack, places(triangles_[j].corner).slack);
    }
    return rounding::up(geometric_bound(t.proof, neighbours) + slack) <= tolerance_;
}

/// The proof of a triangle by its own box, which is the sharpest; what is proved may be far above what had to be.
void FreePatch::sharpen(std::uint32_t i) {
    FreeTriangle& t = triangles_[i];
    if (t.sharp || !t.proof.quiet) return;
    touch(i);
    t.sharp = true;
    const Places p = places(t.corner);
    const auto [u0, u1] = std::minmax({p.uv[0].x, p.uv[1].x, p.uv[2].x});
    const auto [v0, v1] = std::minmax({p.uv[0].y, p.uv[1].y, p.uv[2].y});
    const TriangleBound b = bound_triangle(SecondDerivatives(patch_, {{u0, u1}, {v0, v1}}, 3), {p.uv, p.x, p.slack}, measure_);
    if (b.quiet && b.normal < t.proof.normal) t.proof = b;
}

bool FreePatch::holds_sharply(std::uint32_t i) {
    if (holds(i)) return true;
    sharpen(i);
    if (holds(i)) return true;
    for (const auto j : triangles_[i].beside)
        if (j != kNone && !triangles_[j].left_out) sharpen(j);
    return holds(i);
}

bool FreePatch::certify() {
    for (const auto& [c, old] : old_corners_) {
        FreeCorner& corner = corners_[c];
        if (corner.triangle == kNone || (corner.uv.x == old.uv.x && corner.uv.y == old.uv.y)) continue;
        const auto s = patch_.enclose_point(corner.uv.x, corner.uv.y);
        corner.slack = rounding::length_up(mag(Interval(corner.x.x) - s.x), mag(Interval(corner.x.y) - s.y), mag(Interval(corner.x.z) - s.z));
    }
    for (const auto& [i, old] : old_triangles_) {
        FreeTriangle& t = triangles_[i];
        if (!t.live || t.left_out || t.proved) continue;
        prove(i);
        if (!(t.proof.own(measure_) <= tolerance_)) { STAT(t.proof.quiet ? (t.proof.normal/tolerance_ > t.error*1.05 ? 0 : 1) : t.own.quiet ? 2:6); return false; }
    }
    for (std::size_t k = 0, n = old_triangles_.size(); k < n; ++k) {
        const auto i = old_triangles_[k].first;
        const FreeTriangle& t = triangles_[i];
        if (!t.live || t.left_out) continue;
        if (!holds_sharply(i)) { STAT(3); return false; }
        for (const auto j : t.beside)
            if (j != kNone && !triangles_[j].left_out && !holds_sharply(j)) { STAT(4); return false;}
    }
    STAT(5);
    return true;
}

std::size_t FreePatch::count() const {
    return std::size_t(std::count_if(triangles_.begin(), triangles_.end(), [](const FreeTriangle& t) { return t.live; }));
}

/// A polygon without anything inside, to be filled with triangles.
struct FreePatch::Hole {
    std::vector<std::uint32_t> corners;   // counter-clockwise
    std::vector<std::uint32_t> outside;   // the triangle across each side, from corner k to k + 1
    std::vector<std::uint32_t> free;      // triangles whose places in the list may be used
    std::uint32_t chord = kNone;          // side that replaces two edges on a line
    std::vector<std::array<std::uint32_t, 3>> filling;  // places in `corners`
    double worst = 0;
};

bool FreePatch::find_holes(std::uint32_t corner, std::vector<Hole>& holes) const {
    const FreeCorner& c = corners_[corner];
    if (c.freedom == Freedom::fixed || c.triangle == kNone) return false;
    const Ring r = ring(corner);
    const std::size_t n = r.triangles.size();
    if (r.links.size() > kMostLinks || r.closed == (c.freedom == Freedom::rim)) return false;
    for (const auto t : r.triangles)
        if (triangles_[t].left_out) return false;
    const auto outside = [&](std::size_t i) {
        const FreeTriangle& t = triangles_[r.triangles[i % n]];
        const int k = t.corner[0] == corner ? 0 : t.corner[1] == corner ? 1 : 2;
        return t.beside[(k + 1) % 3];
    };
    const auto piece = [&](std::size_t from, std::size_t to) {  // links from..to, where a chord closes them
        Hole h;
        for (std::size_t i = from; i <= to; ++i) h.corners.push_back(r.links[i % r.links.size()]);
        for (std::size_t i = from; i < to; ++i) h.outside.push_back(outside(i)), h.free.push_back(r.triangles[i % n]);
        h.outside.push_back(kNone);
        h.chord = std::uint32_t(to - from);
        return h;
    };
    if (c.freedom == Freedom::inside) {
        Hole h;
        h.corners = r.links, h.free = r.triangles;
        for (std::size_t i = 0; i < n; ++i) h.outside.push_back(outside(i));
        holes.push_back(std::move(h));
    } else if (c.freedom == Freedom::rim) {
        holes.push_back(piece(0, n));
    } else {
        std::vector<std::size_t> on;
        for (std::size_t i = 0; i < n; ++i)
            if (on_break(corner, r.links[i])) on.push_back(i);
        if (on.size() != 2) return false;
        holes.push_back(piece(on[0], on[1]));
        holes.push_back(piece(on[1], on[0] + n));
    }
    for (const Hole& h : holes)
        if (h.corners.size() < 3) return false;
    return true;
}

/// The filling of the least energy, by dynamic programming over its diagonals.
bool FreePatch::plan(Hole& hole) const {
    const std::size_t n = hole.corners.size();
    const FreeTriangle& like = triangles_[hole.free[0]];
    const auto outside = [&](std::size_t side) {
        const auto o = hole.outside[side];
        return o == kNone || triangles_[o].left_out || triangles_[o].root != like.root ? nullptr : &triangles_[o].own;
    };
    double cost[kMostLinks + 1][kMostLinks + 1], worst[kMostLinks + 1][kMostLinks + 1];
    std::size_t middle[kMostLinks + 1][kMostLinks + 1];
    for (std::size_t i = 0; i + 1 < n; ++i) cost[i][i + 1] = worst[i][i + 1] = 0;
    for (std::size_t width = 2; width < n; ++width)
        for (std::size_t i = 0; i + width < n; ++i) {
            const std::size_t j = i + width;
            cost[i][j] = kInfinity;
            if (width < n - 1 && !may_join(hole.corners[i], hole.corners[j])) continue;
            for (std::size_t k = i + 1; k < j; ++k) {
                if (!(cost[i][k] + cost[k][j] < cost[i][j])) continue;
                const Estimate e = estimate_of(places({hole.corners[i], hole.corners[k], hole.corners[j]}), like);
                double error = e.least();
                if (e.quiet) {  // what lies beyond a side is known where it is one of the hole
                    if (k == i + 1) error = std::max(error, beyond(e, 0, outside(i)));
                    if (j == k + 1) error = std::max(error, beyond(e, 1, outside(k)));
                    if (width == n - 1) error = std::max(error, beyond(e, 2, outside(j)));
                }
                const double sum = cost[i][k] + cost[k][j] + power(error);
                if (sum < cost[i][j]) cost[i][j] = sum, middle[i][j] = k, worst[i][j] = std::max({worst[i][k], worst[k][j], error});
            }
        }
    if (!(cost[0][n - 1] < kInfinity)) return false;
    hole.worst = worst[0][n - 1];
    std::vector<std::array<std::size_t, 2>> open{{0, n - 1}};
    while (!open.empty()) {
        const auto [i, j] = open.back();
        open.pop_back();
        if (j - i < 2) continue;
        const std::size_t k = middle[i][j];
        hole.filling.push_back({std::uint32_t(i), std::uint32_t(k), std::uint32_t(j)});
        open.push_back({i, k});
        open.push_back({k, j});
    }
    return true;
}

void FreePatch::fill(const Hole& hole) {
    const auto n = std::uint32_t(hole.corners.size());
    const FreeTriangle like = triangles_[hole.free[0]];
    for (const auto t : hole.free) touch(t), triangles_[t].live = false;
    // By the places of their ends, lower first: the triangle that waits for its neighbour there.
    std::vector<std::array<std::uint32_t, 4>> waiting;  // low, high, triangle, edge
    for (std::size_t f = 0; f < hole.filling.size(); ++f) {
        const auto index = hole.free[f];
        FreeTriangle& t = triangles_[index];
        t = FreeTriangle();
        t.root = like.root, t.cell = like.cell;
        for (int k = 0; k < 3; ++k) t.corner[k] = hole.corners[hole.filling[f][k]];
        t.own = estimate_of(places(t.corner), t);
        for (int k = 0; k < 3; ++k) {
            const auto a = hole.filling[f][k], b = hole.filling[f][(k + 1) % 3];
            touch_corner(t.corner[k]);
            corners_[t.corner[k]].triangle = index;
            if (b == (a + 1) % n) {
                const auto other = hole.outside[a];
                t.beside[k] = other;
                if (other == kNone) continue;
                touch(other);
                FreeTriangle& o = triangles_[other];
                for (int m = 0; m < 3; ++m)
                    if (o.corner[m] == hole.corners[b] && o.corner[(m + 1) % 3] == hole.corners[a]) o.beside[m] = index;
                continue;
            }
            const auto low = std::min(a, b), high = std::max(a, b);
            const auto found = std::find_if(waiting.begin(), waiting.end(), [&](const auto& w) { return w[0] == low && w[1] == high; });
            if (found == waiting.end()) waiting.push_back({low, high, index, std::uint32_t(k)});
            else t.beside[k] = (*found)[2], triangles_[(*found)[2]].beside[(*found)[3]] = index;
        }
    }
}

double FreePatch::cost_of_removal(std::uint32_t corner) const {
    std::vector<Hole> holes;
    if (!find_holes(corner, holes)) return kInfinity;
    double worst = 0;
    for (Hole& h : holes) {
        if (!plan(h)) return kInfinity;
        worst = std::max(worst, h.worst);
    }
    return worst;
}

bool FreePatch::remove(std::uint32_t corner) {
    std::vector<Hole> holes;
    if (!find_holes(corner, holes)) return false;
    for (Hole& h : holes)
        if (!plan(h)) return false;
    std::vector<std::uint32_t> changed;
    for (const Hole& h : holes) fill(h), changed.insert(changed.end(), h.free.begin(), h.free.begin() + std::ptrdiff_t(h.filling.size()));
    if (holes.size() == 2) {  // two sides of a break: the chords are one edge
        const auto chord = [&](const Hole& h) -> std::array<std::uint32_t, 2> {
            const auto a = h.corners[h.chord], b = h.corners[0];
            for (std::size_t f = 0; f < h.filling.size(); ++f)
                for (int k = 0; k < 3; ++k)
                    if (triangles_[h.free[f]].corner[k] == a && triangles_[h.free[f]].corner[(k + 1) % 3] == b) return {h.free[f], std::uint32_t(k)};
            return {kNone, 0};
        };
        const auto a = chord(holes[0]), b = chord(holes[1]);
        triangles_[a[0]].beside[a[1]] = b[0], triangles_[b[0]].beside[b[1]] = a[0];
    }
    update(changed);
    touch_corner(corner);
    corners_[corner].triangle = kNone;
    return true;
}

}  // namespace isoparm
