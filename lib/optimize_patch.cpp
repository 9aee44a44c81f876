#include "optimize_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isoparm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostRing = 32;  // corners with more triangles around them do not move

/// Counter-clockwise, and not by rounding only.
bool turns_left(const std::array<Vec2, 3>& p) {
    double most = 0;
    for (int k = 0; k < 3; ++k) {
        const double du = p[(k + 1) % 3].x - p[k].x, dv = p[(k + 1) % 3].y - p[k].y;
        most = std::max(most, du * du + dv * dv);
    }
    return (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x) > 1e-9 * most;
}

}  // namespace

FreePatch::FreePatch(const Patch& patch, const PatchMesh& mesh, const std::vector<Point>& positions, double tolerance, Measure measure)
    : patch_(patch), tolerance_(tolerance), measure_(measure), breaks_u_(mesh.breaks_u), breaks_v_(mesh.breaks_v), corners_(mesh.uv.size()), triangles_(mesh.triangles.size()),
      triangle_epoch_(triangles_.size(), 0), corner_epoch_(corners_.size(), 0) {
    const auto is_break = [](const std::vector<double>& breaks, double x) { return std::binary_search(breaks.begin(), breaks.end(), x); };
    for (std::size_t i = 0; i < corners_.size(); ++i) {
        FreeCorner& c = corners_[i];
        c.uv = mesh.uv[i], c.vertex = mesh.vertex[i], c.slack = mesh.slack[i], c.x = positions[c.vertex];
        const bool u = is_break(breaks_u_, c.uv.x), v = is_break(breaks_v_, c.uv.y);
        if (u || v) c.freedom = u && v ? Freedom::fixed : u ? Freedom::along_v : Freedom::along_u;
    }
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
        const PatchTriangle& from = mesh.triangles[i];
        FreeTriangle& t = triangles_[i];
        const auto corner = [&](int k) { return mesh.uv[from.corner[k]]; };
        t.corner = from.corner, t.cell = from.cell->around(patch, box_of({corner(0), corner(1), corner(2)})), t.proof = from.proof, t.proved = true, t.left_out = mesh.left_out(from) || mesh.in_fan(from);
        for (int k = 0; k < 3; ++k) {
            const auto& side = mesh.edges[from.edge[k]].side;
            t.beside[k] = side[0] == i ? side[1] : side[0];
            FreeCorner& c = corners_[t.corner[k]];
            c.triangle = i;
            // Where second derivatives have no bound, proofs cost too much to try.
            if (t.left_out || !t.cell->model().bounded) c.freedom = Freedom::fixed;
        }
        t.root = mesh.root_of(t.corner);
        if (!t.left_out) t.own = estimate_of(places(t.corner), t);
    }
    begin();
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) update({i});
}

std::size_t FreePatch::count() const {
    return std::size_t(std::count_if(triangles_.begin(), triangles_.end(), [](const FreeTriangle& t) { return t.live; }));
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
    Estimate e;
    e.parametric = kInfinity;
    if (!turns_left(p.uv)) return e;
    const SecondDerivatives& model = like.cell->model();
    if (!model.bounded) return e;
    if (measure_ == Measure::geometric) e = estimate(model, p);
    if (!e.quiet) {
        const TriangleBound b = bound_triangle(model, p.corners(), measure_);
        e = {b.parametric, b.normal, b.beside, b.across, b.unit, measure_ == Measure::geometric && b.quiet};
    }
    e.parametric = (e.parametric + p.slack) / tolerance_;
    e.normal = (e.normal + p.slack) / tolerance_;
    for (double& x : e.across) x /= tolerance_;
    for (double& x : e.beside) x = (x + p.slack) / tolerance_;
    return e;
}

const Estimate* FreePatch::behind(const FreeTriangle& like, std::uint32_t other) const {
    return other == kNone || triangles_[other].left_out || triangles_[other].root != like.root ? nullptr : &triangles_[other].own;
}

/// The errors of triangles whose own estimates are new, and of those beside them.
void FreePatch::update(const std::vector<std::uint32_t>& changed) {
    const auto refresh = [&](std::uint32_t i) {
        FreeTriangle& t = triangles_[i];
        if (!t.left_out) t.error = t.own.with({behind(t, t.beside[0]), behind(t, t.beside[1]), behind(t, t.beside[2])});
    };
    for (const auto i : changed) {
        refresh(i);
        for (const auto j : triangles_[i].beside)
            if (j != kNone) touch(j), refresh(j);
    }
}

Ring FreePatch::ring(std::uint32_t corner) const {
    Ring r;
    const auto first = corners_[corner].triangle;
    auto begin = first;  // clockwise to the rim, or once around
    for (;;) {
        const auto before = triangles_[begin].beside[triangles_[begin].place(corner)];
        if (before == kNone) break;
        begin = before;
        if (begin == first) break;
    }
    for (auto t = begin;;) {
        const int k = triangles_[t].place(corner);
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
        p.uv[t.place(corner)] = uv, p.x[t.place(corner)] = x;
        own[i] = estimate_of(p, t);
        if (!(own[i].least() < kInfinity)) return kInfinity;
    }
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const FreeTriangle& t = triangles_[ring.triangles[i]];
        const auto next = [&](bool exists, std::size_t j) { return exists && triangles_[ring.triangles[j % n]].root == t.root ? &own[j % n] : nullptr; };
        const int k = t.place(corner);
        std::array<const Estimate*, 3> neighbours;
        neighbours[k] = next(ring.closed || i > 0, i + n - 1);
        neighbours[(k + 1) % 3] = behind(t, t.beside[(k + 1) % 3]);
        neighbours[(k + 2) % 3] = next(ring.closed || i + 1 < n, i + 1);
        sum += power(own[i].with(neighbours));
    }
    return sum;
}

void FreePatch::begin() {
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
}

double FreePatch::worst_change() const {
    double worst = 0;
    for (const auto& [i, old] : old_triangles_)
        if (triangles_[i].live && !triangles_[i].left_out) worst = std::max(worst, triangles_[i].error);
    return worst;
}

void FreePatch::move(std::uint32_t corner, const Vec2& uv, const Point& x) {
    touch_corner(corner);
    corners_[corner].uv = uv, corners_[corner].x = x;
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

/// A new edge inside the patch may not join two vertices that another edge of the mesh may join.
bool FreePatch::may_join(std::uint32_t a, std::uint32_t b) const {
    const FreeCorner &p = corners_[a], &q = corners_[b];
    return p.vertex != q.vertex && !on_break(a, b) && !(p.on_rim() && q.on_rim());
}

void FreePatch::rename(std::uint32_t t, std::uint32_t from, std::uint32_t to) {
    if (t == kNone) return;
    touch(t);
    for (auto& x : triangles_[t].beside)
        if (x == from) x = to;
}

bool FreePatch::flip(std::uint32_t i, int k) {
    const auto j = triangles_[i].beside[k];
    if (j == kNone || triangles_[i].left_out || triangles_[j].left_out || triangles_[i].root != triangles_[j].root) return false;
    const FreeTriangle ti = triangles_[i], tj = triangles_[j];
    const auto a = ti.corner[k], b = ti.corner[(k + 1) % 3], c = ti.corner[(k + 2) % 3];
    const int m = tj.place(b);  // edge m of the other one is b to a
    const auto d = tj.corner[(m + 2) % 3];
    if (!may_join(c, d)) return false;
    const Estimate first = estimate_of(places({a, d, c}), ti), second = estimate_of(places({d, b, c}), tj);
    const auto ad = tj.beside[(m + 1) % 3], db = tj.beside[(m + 2) % 3], bc = ti.beside[(k + 1) % 3], ca = ti.beside[(k + 2) % 3];
    const double after = power(first.with({behind(ti, ad), &second, behind(ti, ca)})) + power(second.with({behind(tj, db), behind(tj, bc), &first}));
    if (!(after < (power(ti.error) + power(tj.error)) * (1 - 1e-6))) return false;
    touch(i), touch(j);
    for (const auto x : {a, b, c, d}) touch_corner(x);
    FreeTriangle &ni = triangles_[i], &nj = triangles_[j];
    ni.corner = {a, d, c}, ni.beside = {ad, j, ca}, ni.own = first, ni.proved = false;
    nj.corner = {d, b, c}, nj.beside = {db, bc, i}, nj.own = second, nj.proved = false;
    rename(ad, j, i);
    rename(bc, i, j);
    corners_[a].triangle = corners_[c].triangle = corners_[d].triangle = i, corners_[b].triangle = j;
    update({i, j});
    return true;
}

}  // namespace isoparm
