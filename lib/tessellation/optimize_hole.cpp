// optimize_hole.cpp -- how a FreePatch removes a corner: the triangles around it leave a hole, which others fill.
//
// A corner on a break leaves a hole on either side. The filling of a polygon by triangles that turn counter-clockwise covers it once.
#include <algorithm>
#include <limits>

#include "tessellation/optimize_patch.h"

namespace isoparm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostLinks = 16;  // corners with more around them stay

}  // namespace

/// A polygon without anything inside, and the triangles that will fill it.
struct FreePatch::Hole {
    std::vector<std::uint32_t> corners;                 // counter-clockwise
    std::vector<std::uint32_t> outside;                 // the triangle behind each side, from corner k to k + 1
    std::vector<std::uint32_t> free;                    // triangles that were there
    std::vector<std::array<std::uint32_t, 3>> filling;  // places in `corners`, ascending
    double worst = 0;                                   // error of these
};

bool FreePatch::find_holes(std::uint32_t corner, std::vector<Hole>& holes) const {
    const FreeCorner& c = corners_[corner];
    if (c.freedom == Freedom::fixed || !c.live()) return false;
    const Ring r = ring(corner);
    const std::size_t n = r.triangles.size();
    if (r.links.size() > kMostLinks || r.closed == (c.freedom == Freedom::rim)) return false;
    for (const auto t : r.triangles)
        if (triangles_[t].left_out) return false;
    const auto outside = [&](std::size_t i) {
        const FreeTriangle& t = triangles_[r.triangles[i % n]];
        return t.beside[(t.place(corner) + 1) % 3];
    };
    const auto piece = [&](std::size_t from, std::size_t to) {  // the links from..to, which a chord closes: the last side
        Hole h;
        for (std::size_t i = from; i <= to; ++i) h.corners.push_back(r.links[i % r.links.size()]);
        for (std::size_t i = from; i < to; ++i) h.outside.push_back(outside(i)), h.free.push_back(r.triangles[i % n]);
        h.outside.push_back(kNone);
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
    return std::all_of(holes.begin(), holes.end(), [](const Hole& h) { return h.corners.size() >= 3; });
}

/// The filling of the least energy, by dynamic programming over its diagonals.
bool FreePatch::plan(Hole& hole) const {
    const std::size_t n = hole.corners.size();
    const FreeTriangle& like = triangles_[hole.free[0]];
    const auto outside = [&](std::size_t side) { return behind(like, hole.outside[side]); };
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
                    if (k == i + 1) error = std::max(error, e.beyond(0, outside(i)));
                    if (j == k + 1) error = std::max(error, e.beyond(1, outside(k)));
                    if (width == n - 1) error = std::max(error, e.beyond(2, outside(j)));
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

/// The fillings on the two sides of a break meet in their chords.
void FreePatch::join_chords(const std::vector<Hole>& holes) {
    std::array<std::uint32_t, 2> triangle{kNone, kNone};
    for (int side = 0; side < 2; ++side) {
        const Hole& h = holes[std::size_t(side)];
        for (std::size_t f = 0; f < h.filling.size(); ++f)
            if (h.filling[f][0] == 0 && h.filling[f][2] + 1 == h.corners.size()) triangle[side] = h.free[f];
    }
    for (int side = 0; side < 2; ++side) triangles_[triangle[side]].beside[2] = triangle[1 - side];
}

bool FreePatch::remove(std::uint32_t corner) {
    std::vector<Hole> holes;
    if (!find_holes(corner, holes)) return false;
    for (Hole& h : holes)
        if (!plan(h)) return false;
    std::vector<std::uint32_t> changed;
    for (const Hole& h : holes) {
        fill(h);
        changed.insert(changed.end(), h.free.begin(), h.free.begin() + std::ptrdiff_t(h.filling.size()));
    }
    if (holes.size() == 2) join_chords(holes);
    estimate_anew(changed);
    update(changed);
    touch_corner(corner);
    corners_[corner].triangle = kNone;
    return true;
}

}  // namespace isoparm
