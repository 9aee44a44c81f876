#include "tessellation/optimize_worker.h"

#include <algorithm>
#include <limits>

namespace isoparm {
namespace {

constexpr float kLeastStep = 0.01f, kMostStep = 0.4f;  // of moves, relative to the edges
constexpr double kGain = 1 - 1e-4;     // a move lowers the energy at least by this factor
constexpr double kEnough = 0.995;      // tolerances: what estimates should say before a proof is tried
constexpr double kLess = 0.015;        // of which there should be less after a proof in vain
constexpr int kMostProofs = 4;         // of a removal
constexpr int kSweeps = 12;            // of relaxation
constexpr double kProgress = 0.9;      // of what is above that, after each sweep but the first
constexpr double kNear = 1.03;         // tolerances: what is left where one more ring of corners may help
constexpr double kIdle = 0.85;         // of the largest error: corners with less around them do not move in a sweep

/// Of the removal of a corner, to be tried again: `cost` was too much, as relaxation left `left`. Near misses may fit when something else has moved.
float most_cost_after(double cost, double left) { return left < 1.02 ? kMostCost : float((left < 1.1 ? 1 : 0.95) * cost); }

}  // namespace

bool Worker::mine(std::uint32_t point) const {
    const RimPoint& p = all_.rim_points()[point];
    const auto& uses = all_.rim_of(p).uses;
    for (std::size_t use = 0; use < uses.size(); ++use) {
        if (std::find(members_.begin(), members_.end(), uses[use].member) == members_.end()) return false;
        if (all_.patches()[uses[use].member].corners()[p.corner[use]].freedom != Freedom::rim) return false;
    }
    return true;
}

std::vector<Site> Worker::sites_of(Site site) const {
    const FreeCorner& c = all_.patches()[site.patch].corners()[site.corner];
    if (c.freedom != Freedom::rim) return {site};
    const RimPoint& p = all_.rim_points()[c.rim_point];
    std::vector<Site> list;
    for (std::size_t use = 0; use < all_.rim_of(p).uses.size(); ++use) list.push_back({all_.rim_of(p).uses[use].member, p.corner[use]});
    return list;
}

void Worker::begin() {
    for (const auto m : members_) all_.patches()[m].begin();
    old_points_.clear();
}

bool Worker::certify() {
    return std::all_of(members_.begin(), members_.end(), [&](auto m) { return all_.patches()[m].certify(); });
}

bool Worker::finish(bool good) {
    if (good && certify()) return true;
    for (const auto m : members_) all_.patches()[m].take_back();
    for (auto it = old_points_.rbegin(); it != old_points_.rend(); ++it) all_.rim_points()[it->first] = it->second;
    return false;
}

double Worker::worst() const {
    double most = 0;
    for (const auto m : members_) most = std::max(most, all_.patches()[m].worst_change());
    return most;
}

bool Worker::move_rim(std::uint32_t index) {
    if (!mine(index)) return false;
    const RimPoint p = all_.rim_points()[index];
    const auto& uses = all_.rim_of(p).uses;
    const auto patch = [&](std::size_t use) -> FreePatch& { return all_.patches()[uses[use].member]; };
    std::vector<Ring> rings;
    double start = 0;
    for (std::size_t use = 0; use < uses.size(); ++use) {
        rings.push_back(patch(use).ring(p.corner[use]));
        start += patch(use).energy(rings.back());
    }
    const float step = patch(0).corners()[p.corner[0]].step;
    RimPoint best = p;
    std::array<Vec2, 2> best_uv, uv;
    double least = start * kGain;
    for (const auto toward : {p.before, p.after}) {
        RimPoint q = p;
        q.f = p.f + double(step) * (all_.rim_points()[toward].f - p.f);
        all_.place(p, q.f, q.x, uv);
        double sum = 0;
        for (std::size_t use = 0; use < uses.size() && sum < least; ++use) sum += patch(use).energy_at(rings[use], p.corner[use], uv[use], q.x, least - sum);
        if (sum < least) least = sum, best = q, best_uv = uv;
    }
    const bool moved = best.f != p.f;
    if (moved) {
        old_points_.push_back({index, p});
        all_.rim_points()[index] = best;
        for (std::size_t use = 0; use < uses.size(); ++use) patch(use).move(p.corner[use], best_uv[use], best.x);
    }
    patch(0).set_step(p.corner[0], moved ? std::min(kMostStep, step * 1.3f) : std::max(kLeastStep, step * 0.5f));
    return moved;
}

/// A step toward one of the corners around, whichever lowers the energy most.
bool Worker::move_once(Site site) {
    FreePatch& patch = all_.patches()[site.patch];
    const FreeCorner c = patch.corners()[site.corner];
    if (c.freedom == Freedom::fixed || !c.live()) return false;
    if (c.freedom == Freedom::rim) return move_rim(c.rim_point);
    const Ring ring = patch.ring(site.corner);
    if (patch.settled(ring, site.corner)) return false;
    double least = patch.energy(ring) * kGain;
    bool moved = false;
    Vec2 best;
    for (const auto l : ring.links) {
        const Vec2 to = patch.corners()[l].uv;
        if ((c.freedom == Freedom::along_u && to.y != c.uv.y) || (c.freedom == Freedom::along_v && to.x != c.uv.x)) continue;
        const Vec2 p{c.uv.x + double(c.step) * (to.x - c.uv.x), c.uv.y + double(c.step) * (to.y - c.uv.y)};
        const double sum = patch.energy_at(ring, site.corner, p, patch.point_near(site.corner, p), least);
        if (sum < least) least = sum, best = p, moved = true;
    }
    if (moved) patch.move(site.corner, best, patch.patch().point(best.x, best.y));
    else if (c.step == kLeastStep) patch.settle(site.corner);
    patch.set_step(site.corner, moved ? std::min(kMostStep, c.step * 1.3f) : std::max(kLeastStep, c.step * 0.5f));
    return moved;
}

bool Worker::flip_once(Site site) {
    FreePatch& patch = all_.patches()[site.patch];
    if (!patch.corners()[site.corner].live()) return false;
    bool any = false;
    for (const auto t : patch.ring(site.corner).triangles)
        for (int k = 0; k < 3; ++k) any = patch.flip(t, k) || any;
    return any;
}

void Worker::improve(Site site) {
    begin();
    const bool moved = move_once(site);
    const float step = all_.patches()[site.patch].corners()[site.corner].step;
    if (!(moved && finish(true)) && moved) all_.patches()[site.patch].set_step(site.corner, std::max(kLeastStep, step * 0.3f));
}

void Worker::flip_around(Site site) {
    begin();
    if (flip_once(site)) finish(true);
}

double Worker::cost_of_removal(Site site) const {
    const FreeCorner& c = all_.patches()[site.patch].corners()[site.corner];
    if (c.freedom == Freedom::rim && !mine(c.rim_point)) return std::numeric_limits<double>::infinity();  // others may be changing what lies behind
    double most = 0;
    for (const Site& s : sites_of(site)) most = std::max(most, all_.patches()[s.patch].cost_of_removal(s.corner));
    return most;
}

/// These corners and those around them that may move.
std::vector<Site> Worker::around(const std::vector<Site>& links) const {
    std::vector<Site> list;
    const auto add = [&](Site s) {
        const FreeCorner& c = all_.patches()[s.patch].corners()[s.corner];
        if (c.freedom == Freedom::fixed || !c.live()) return;
        if (std::none_of(list.begin(), list.end(), [&](Site o) { return o.patch == s.patch && o.corner == s.corner; })) list.push_back(s);
    };
    for (const Site& s : links) add(s);
    for (const Site& s : links)
        if (all_.patches()[s.patch].corners()[s.corner].live())
            for (const auto l : all_.patches()[s.patch].ring(s.corner).links) add({s.patch, l});
    return list;
}

/// Moves and flips until the largest error is `enough`, or little is gained, or `sweeps`, which are counted on, are too many: what it is then.
double Worker::relax(const std::vector<Site>& around, double enough, int& sweeps) {
    double now = worst();
    for (int done = 0; now > enough && sweeps < kSweeps; ++done, ++sweeps) {
        const double last = now;
        for (const Site& s : around)
            if (const FreePatch& patch = all_.patches()[s.patch]; patch.worst_of(patch.ring(s.corner)) > kIdle * last) move_once(s);
        for (const Site& s : around) flip_once(s);
        now = worst();
        if (done >= 2 && now - enough > kProgress * (last - enough)) break;
    }
    return now;
}

void Worker::take_off_rim(std::uint32_t index) {
    auto& points = all_.rim_points();
    const RimPoint p = points[index];
    for (const auto i : {index, p.before, p.after}) old_points_.push_back({i, points[i]});
    points[index].live = false;
    points[p.before].after = p.after, points[p.after].before = p.before;
}

bool Worker::remove(Site site, bool relax) {
    const FreeCorner corner = all_.patches()[site.patch].corners()[site.corner];
    if (!corner.live() || (corner.freedom == Freedom::rim && !mine(corner.rim_point))) return false;
    const std::vector<Site> sites = sites_of(site);
    std::vector<Site> links;
    for (const Site& s : sites)
        for (const auto l : all_.patches()[s.patch].ring(s.corner).links) links.push_back({s.patch, l});
    begin();
    for (const Site& s : sites)
        if (!all_.patches()[s.patch].remove(s.corner)) return finish(false);
    if (corner.freedom == Freedom::rim) take_off_rim(corner.rim_point);
    const double cost = worst();
    if (!relax) return finish(cost <= kEnough);
    if (!(cost < corner.most_cost)) return finish(false);
    std::vector<Site> movable = around(links);
    int sweeps = 0;
    double enough = kEnough, left = this->relax(movable, enough, sweeps);
    if (left > enough && left < kNear) {
        movable = around(movable), sweeps = 0;
        left = this->relax(movable, enough, sweeps);
    }
    for (int proofs = 0; left <= enough && proofs < kMostProofs; ++proofs) {
        if (certify()) return true;
        enough = left - kLess;
        left = this->relax(movable, enough, sweeps);
    }
    finish(false);
    all_.patches()[site.patch].set_most_cost(site.corner, most_cost_after(cost, left));
    return false;
}

}  // namespace isoparm
