#include "optimize_worker.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isoparm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kLeastStep = 0.01f, kMostStep = 0.4f;
int kSweeps = 12;             // of relaxation
constexpr double kEnough = 0.995;

bool same(Site a, Site b) { return a.patch == b.patch && a.corner == b.corner; }

}  // namespace

bool Worker::mine(std::uint32_t point) const {
    const Rim& rim = all_.rim_of(all_.rim_points()[point]);
    const RimPoint& p = all_.rim_points()[point];
    for (std::size_t use = 0; use < rim.uses.size(); ++use) {
        const auto m = rim.uses[use].member;
        if (std::find(members_.begin(), members_.end(), m) == members_.end()) return false;
        if (all_.patches()[m].corners()[p.corner[use]].freedom != Freedom::rim) return false;
    }
    return true;
}

std::vector<Site> Worker::sites_of(Site site) const {
    const FreeCorner& c = all_.patches()[site.patch].corners()[site.corner];
    if (c.freedom != Freedom::rim) return {site};
    const RimPoint& p = all_.rim_points()[c.rim_point];
    const Rim& rim = all_.rim_of(p);
    std::vector<Site> list;
    for (std::size_t use = 0; use < rim.uses.size(); ++use) list.push_back({rim.uses[use].member, p.corner[use]});
    return list;
}

void Worker::begin() {
    for (const auto m : members_) all_.patches()[m].begin();
    old_points_.clear();
}

bool Worker::finish(bool good) {
    if (good)
        for (const auto m : members_) good = good && all_.patches()[m].certify();
    for (const auto m : members_) {
        if (good) all_.patches()[m].keep();
        else all_.patches()[m].take_back();
    }
    if (!good)
        for (auto it = old_points_.rbegin(); it != old_points_.rend(); ++it) all_.rim_points()[it->first] = it->second;
    return good;
}

double Worker::worst() const {
    double most = 0;
    for (const auto m : members_) most = std::max(most, all_.patches()[m].worst_change());
    return most;
}

bool Worker::move_rim(std::uint32_t index) {
    if (!mine(index)) return false;
    const RimPoint p = all_.rim_points()[index];
    const Rim& rim = all_.rim_of(p);
    std::vector<Ring> rings;
    double least = 0;
    for (std::size_t use = 0; use < rim.uses.size(); ++use) {
        const FreePatch& patch = all_.patches()[rim.uses[use].member];
        rings.push_back(patch.ring(p.corner[use]));
        least += patch.energy(rings.back());
    }
    const std::uint32_t first = rim.uses[0].member;
    const float step = all_.patches()[first].corners()[p.corner[0]].step;
    RimPoint best = p;
    std::array<Vec2, 2> best_uv;
    const double start = least;
    for (const auto toward : {p.before, p.after}) {
        RimPoint q = p;
        q.f = p.f + step * (all_.rim_points()[toward].f - p.f);
        std::array<Vec2, 2> uv;
        all_.place(p, q.f, q.x, uv);
        double sum = 0;
        for (std::size_t use = 0; use < rim.uses.size() && sum < least; ++use)
            sum += all_.patches()[rim.uses[use].member].energy_at(rings[use], p.corner[use], uv[use], q.x);
        if (sum < least) least = sum, best = q, best_uv = uv;
    }
    const bool moved = least < start * (1 - 1e-4);
    if (moved) {
        old_points_.push_back({index, p});
        all_.rim_points()[index] = best;
        for (std::size_t use = 0; use < rim.uses.size(); ++use) all_.patches()[rim.uses[use].member].move(p.corner[use], best_uv[use], best.x);
    }
    all_.patches()[first].set_step(p.corner[0], moved ? std::min(kMostStep, step * 1.3f) : std::max(kLeastStep, step * 0.5f));
    return moved;
}

bool Worker::move_once(Site site) {
    FreePatch& patch = all_.patches()[site.patch];
    const FreeCorner c = patch.corners()[site.corner];
    if (c.freedom == Freedom::fixed || c.triangle == kNone) return false;
    if (c.freedom == Freedom::rim) return move_rim(c.rim_point);
    const Ring ring = patch.ring(site.corner);
    const double start = patch.energy(ring);
    double least = start;
    Vec2 best;
    Point best_x;
    const auto consider = [&](const Vec2& p) {
        const Point x = patch.patch().point(p.x, p.y);
        const double sum = patch.energy_at(ring, site.corner, p, x);
        if (sum < least) least = sum, best = p, best_x = x;
    };
    for (const auto l : ring.links) {
        const Vec2 to = patch.corners()[l].uv;
        Vec2 p{c.uv.x + c.step * (to.x - c.uv.x), c.uv.y + c.step * (to.y - c.uv.y)};
        if (c.freedom == Freedom::along_u) {
            if (to.y != c.uv.y) continue;
            p.y = c.uv.y;
        }
        if (c.freedom == Freedom::along_v) {
            if (to.x != c.uv.x) continue;
            p.x = c.uv.x;
        }
        consider(p);
    }
    const bool moved = least < start * (1 - 1e-4);
    if (moved) patch.move(site.corner, best, best_x);
    patch.set_step(site.corner, moved ? std::min(kMostStep, c.step * 1.3f) : std::max(kLeastStep, c.step * 0.5f));
    return moved;
}

bool Worker::flip_once(Site site) {
    FreePatch& patch = all_.patches()[site.patch];
    if (patch.corners()[site.corner].triangle == kNone) return false;
    bool any = false;
    for (const auto t : patch.ring(site.corner).triangles)
        for (int k = 0; k < 3; ++k)
            if (patch.flip(t, k)) any = true;
    return any;
}

bool Worker::improve(Site site) {
    begin();
    const bool moved = move_once(site);
    const float step = all_.patches()[site.patch].corners()[site.corner].step;
    if (!moved) {
        finish(false);
        all_.patches()[site.patch].set_step(site.corner, step);
        return false;
    }
    const bool good = finish(true);
    if (!good) all_.patches()[site.patch].set_step(site.corner, std::max(kLeastStep, step * 0.3f));
    return good;
}

bool Worker::flip_around(Site site) {
    begin();
    return finish(flip_once(site));
}

double Worker::cost_of_removal(Site site) const {
    double most = 0;
    for (const Site& s : sites_of(site)) most = std::max(most, all_.patches()[s.patch].cost_of_removal(s.corner));
    return most;
}

std::vector<Site> Worker::around(const std::vector<Site>& links) const {
    std::vector<Site> list;
    const auto add = [&](Site s) {
        const FreePatch& patch = all_.patches()[s.patch];
        const FreeCorner& c = patch.corners()[s.corner];
        if (c.freedom == Freedom::fixed || c.triangle == kNone) return;
        if (std::find(members_.begin(), members_.end(), s.patch) == members_.end()) return;
        if (std::none_of(list.begin(), list.end(), [&](Site o) { return same(o, s); })) list.push_back(s);
    };
    for (const Site& s : links) add(s);
    for (const Site& s : links)
        if (all_.patches()[s.patch].corners()[s.corner].triangle != kNone)
            for (const auto l : all_.patches()[s.patch].ring(s.corner).links) add({s.patch, l});
    return list;
}

bool Worker::relax(const std::vector<Site>& around) {
    double last = worst();
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (const Site& s : around) move_once(s);
        for (const Site& s : around) flip_once(s);
        const double now = worst();
        if (now <= kEnough) return true;
        // What is left has to go down fast enough.
        if (sweep >= 2 && (now - kEnough) > 0.9 * (last - kEnough) ) return false;
        last = now;
    }
    return false;
}

bool Worker::remove(Site site, bool relaxed) {
    const FreeCorner& corner = all_.patches()[site.patch].corners()[site.corner];
    if (corner.triangle == kNone || (corner.freedom == Freedom::rim && !mine(corner.rim_point))) return false;
    const std::vector<Site> sites = sites_of(site);
    std::vector<Site> links;
    for (const Site& s : sites)
        for (const auto l : all_.patches()[s.patch].ring(s.corner).links) links.push_back({s.patch, l});
    begin();
    for (const Site& s : sites)
        if (!all_.patches()[s.patch].remove(s.corner)) return finish(false);
    const FreeCorner& c = all_.patches()[site.patch].corners()[site.corner];
    if (c.freedom == Freedom::rim) {
        RimPoint& p = all_.rim_points()[c.rim_point];
        for (const auto i : {c.rim_point, p.before, p.after}) old_points_.push_back({i, all_.rim_points()[i]});
        p.live = false;
        all_.rim_points()[p.before].after = p.after, all_.rim_points()[p.after].before = p.before;
    }
    last_worst = worst();
    last_kind = 1;
    if (last_worst <= kEnough) return finish(true);
    last_kind = 2;
    if (!relaxed) return finish(false);
    const auto region = around(links);
    last_kind = 3;
    bool r = relax(region); last_worst = worst(); if (r) last_kind = 4;
    return finish(r);
}

}  // namespace isoparm
