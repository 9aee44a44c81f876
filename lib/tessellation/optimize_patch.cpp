#include "tessellation/optimize_patch.h"

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
      triangle_epoch_(triangles_.size(), 0), corner_epoch_(corners_.size(), 0), changed_(triangles_.size(), 0), tried_(triangles_.size()) {
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

void FreePatch::estimate(int n, const Places* places, const FreeTriangle* const* like, Estimate* estimates) const {
    if (measure_ == Measure::geometric) {
        for (int i = 0; i < n; ++i) lanes_.set(std::size_t(i), like[i]->cell->model(), places[i]);
        estimate_lanes(lanes_, n, tolerance_, estimates);
    }
    for (int i = 0; i < n; ++i) {
        Estimate& e = estimates[i];
        const Places& p = places[i];
        const SecondDerivatives& model = like[i]->cell->model();
        const bool fits = model.bounded && turns_left(p.uv);
        e.parametric = kInfinity, e.quiet = e.quiet && fits;
        if (e.quiet || !fits) continue;
        const TriangleBound b = bound_triangle(model, p.corners(), measure_);
        const auto relative = [&](double x) { return (x + p.slack) / tolerance_; };
        e = {relative(b.parametric), relative(b.normal), {}, {}, b.unit, measure_ == Measure::geometric && b.quiet};
        for (std::size_t k = 0; k < 3; ++k) e.beside[k] = relative(b.beside[k]), e.across[k] = b.across[k] / tolerance_;
    }
}

void FreePatch::estimate_anew(const std::vector<std::uint32_t>& triangles) {
    constexpr std::size_t lanes = EstimateLanes::size;
    std::array<Places, lanes> places_of;
    std::array<const FreeTriangle*, lanes> like;
    std::array<Estimate, lanes> own;
    for (std::size_t from = 0; from < triangles.size(); from += lanes) {
        const std::size_t some = std::min(lanes, triangles.size() - from);
        for (std::size_t i = 0; i < some; ++i) like[i] = &triangles_[triangles[from + i]], places_of[i] = places(like[i]->corner);
        estimate(int(some), places_of.data(), like.data(), own.data());
        for (std::size_t i = 0; i < some; ++i) triangles_[triangles[from + i]].own = own[i];
    }
}

Estimate FreePatch::estimate_of(const Places& p, const FreeTriangle& like) const {
    Estimate e;
    const FreeTriangle* as = &like;
    estimate(1, &p, &as, &e);
    return e;
}

const Estimate* FreePatch::behind(const FreeTriangle& like, std::uint32_t other) const {
    return other == kNone || triangles_[other].left_out || triangles_[other].root != like.root ? nullptr : &triangles_[other].own;
}

/// The errors of triangles whose own estimates are new, and of those beside them.
void FreePatch::update(const std::vector<std::uint32_t>& changed) {
    ++clock_;
    const auto refresh = [&](std::uint32_t i) {
        FreeTriangle& t = triangles_[i];
        changed_[i] = clock_;
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
    r.triangles.reserve(8), r.links.reserve(8);
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

double FreePatch::worst_of(const Ring& ring) const {
    double worst = 0;
    for (const auto t : ring.triangles) worst = std::max(worst, triangles_[t].error);
    return worst;
}

bool FreePatch::settled(const Ring& ring, std::uint32_t corner) const {
    return std::all_of(ring.triangles.begin(), ring.triangles.end(), [&](auto t) { return changed_[t] <= corners_[corner].settled; });
}

double FreePatch::energy_at(const Ring& ring, std::uint32_t corner, const Vec2& uv, const Point& x, double limit) const {
    const std::size_t n = ring.triangles.size();
    std::array<Estimate, kMostRing> own;
    if (n > kMostRing) return kInfinity;
    constexpr std::size_t lanes = EstimateLanes::size;
    std::array<Places, lanes> places_of;
    std::array<const FreeTriangle*, lanes> like;
    double least = 0;
    for (std::size_t from = 0; from < n; from += lanes) {
        const std::size_t some = std::min(lanes, n - from);
        for (std::size_t i = 0; i < some; ++i) {
            const FreeTriangle& t = triangles_[ring.triangles[from + i]];
            if (t.left_out) return kInfinity;
            Places& p = places_of[i] = places(t.corner);
            p.uv[t.place(corner)] = uv, p.x[t.place(corner)] = x;
            like[i] = &t;
        }
        estimate(int(some), places_of.data(), like.data(), &own[from]);
        for (std::size_t i = from; i < from + some; ++i) least += power(own[i].least());
        if (!(least < limit)) return kInfinity;
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

Point FreePatch::point_near(std::uint32_t corner, const Vec2& uv) const {
    const PolynomialCell& polynomial = triangles_[corners_[corner].triangle].root->polynomial();
    return polynomial.exact() ? polynomial.point(uv) : patch_.point(uv.x, uv.y);
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
    ++clock_;
    for (const auto& [i, t] : old_triangles_) triangles_[i] = t, changed_[i] = clock_;
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
        triangles_[i].proved = false;
    }
    estimate_anew(r.triangles);
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
    if (std::max(changed_[i], changed_[j]) <= tried_[i][k]) return false;  // in vain, and nothing is new
    const FreeTriangle &ti = triangles_[i], &tj = triangles_[j];
    const auto a = ti.corner[k], b = ti.corner[(k + 1) % 3], c = ti.corner[(k + 2) % 3];
    const int m = tj.place(b);  // edge m of the other one is b to a
    const auto d = tj.corner[(m + 2) % 3];
    tried_[i][k] = tried_[j][m] = clock_;
    if (!may_join(c, d)) return false;
    const std::array<Places, 2> p{places({a, d, c}), places({d, b, c})};
    const std::array<const FreeTriangle*, 2> like{&ti, &tj};
    std::array<Estimate, 2> own;
    estimate(2, p.data(), like.data(), own.data());
    const auto& [first, second] = own;
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
