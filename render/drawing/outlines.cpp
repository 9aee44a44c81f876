#include "drawing/outlines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "drawing/flat_lines.h"
#include "topology.h"

namespace isoparm {
namespace {

constexpr double kCell = 4, kStep = 1.5;          // pixels
constexpr int kLeastCells = 12, kMostCells = 200;  // a patch has along u or v
constexpr double kFold = 0.01;                     // radians between patches that count as smooth
constexpr double kInside = 1e-7;                   // of the domain: poles and apexes have no normal of their own

Point unit_normal_at(const Patch& patch, const Vec2& at) {
    const PointFrame f = patch.frame(at.x, at.y);
    const Point n = cross(Point{f.x.coefficient(1, 0), f.y.coefficient(1, 0), f.z.coefficient(1, 0)}, Point{f.x.coefficient(0, 1), f.y.coefficient(0, 1), f.z.coefficient(0, 1)});
    return n / length(n);
}
Point toward(const Camera& camera, const Point& p) { return camera.orthographic ? camera.forward : normalized(p - camera.eye); }

/// Contours of one patch, on a grid over its domain. Places count cells: (x,y) is u0 + x (u1 - u0) / columns ...
class Contours {
public:
    Contours(const Patch& patch, const Camera& camera) : patch_(patch), camera_(camera), rect_(patch.rect()) {
        const int columns = cells(true), rows = cells(false);
        columns_ = columns, rows_ = rows;
        if (triangle()) columns_ = rows_ = std::max(columns_, rows_);
        for (int j = 0; j <= rows_; ++j)
            for (int i = 0; i <= columns_; ++i) side_.push_back(inside(i, j) && facing({double(i), double(j)}) >= 0);
        for (int j = 0; j < rows_; ++j)
            for (int i = 0; i < columns_; ++i) {
                if (inside(i + 1, j) && inside(i, j + 1)) add_triangle({number(i, j), number(i + 1, j), number(i, j + 1)});
                if (inside(i + 1, j + 1)) add_triangle({number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)});
            }
    }

    std::vector<std::vector<Point>> lines() {
        std::vector<std::vector<Point>> all;
        for (const bool loops : {false, true})  // first what begins and ends somewhere
            for (std::size_t k = 0; k < places_.size(); ++k)
                if (!used_[k] && (loops || next_[k].size() == 1)) all.push_back(walk(k, loops));
        return all;
    }

private:
    bool triangle() const { return patch_.domain() == Domain::triangle; }
    bool inside(int i, int j) const { return !triangle() || i + j <= rows_; }
    int number(int i, int j) const { return j * (columns_ + 1) + i; }
    Vec2 place(int number) const { return {double(number % (columns_ + 1)), double(number / (columns_ + 1))}; }
    Vec2 parameters(const Vec2& p) const {
        double x = std::clamp(p.x / columns_, kInside, 1 - kInside), y = std::clamp(p.y / rows_, kInside, 1 - kInside);
        if (triangle() && x + y > 1 - kInside) {
            const double scale = (1 - kInside) / (x + y);
            x *= scale, y *= scale;
        }
        return {rect_.u0 + x * (rect_.u1 - rect_.u0), rect_.v0 + y * (rect_.v1 - rect_.v0)};
    }
    Point point(const Vec2& p) const {
        const Vec2 uv = parameters(p);
        return patch_.point(uv.x, uv.y);
    }
    /// Cosine between normal and view.
    double facing(const Vec2& p) const {
        const Vec2 uv = parameters(p);
        const double f = dot(unit_normal_at(patch_, uv), toward(camera_, patch_.point(uv.x, uv.y)));
        return std::isfinite(f) ? f : 1;
    }
    int cells(bool along_u) {
        constexpr int kLines = 5, kSteps = 16;
        double longest = 0;
        columns_ = rows_ = kSteps;
        for (int line = 0; line < kLines; ++line) {
            double pixels = 0;
            for (int i = 0; i < kSteps; ++i) {
                const double across = double(line) / (kLines - 1) * kSteps;
                const auto at = [&](int k) {
                    Vec2 p = along_u ? Vec2{double(k), across} : Vec2{across, double(k)};
                    if (triangle() && p.x + p.y > kSteps) (along_u ? p.x : p.y) = kSteps - across;
                    return point(p);
                };
                const Point a = at(i), b = at(i + 1);
                if (camera_.depth(a) > 0 && camera_.depth(b) > 0) pixels += apart(camera_.project(a), camera_.project(b));
            }
            longest = std::max(longest, std::isfinite(pixels) ? pixels : 0);
        }
        return static_cast<int>(std::clamp(longest / kCell, double(kLeastCells), double(kMostCells)));
    }

    /// Where on the way from a to b, whose sides differ, the surface turns.
    Vec2 turn(Vec2 a, Vec2 b) const {
        const bool side = facing(a) >= 0;
        for (int i = 0; i < 40; ++i) {
            const Vec2 m{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
            ((facing(m) >= 0) == side ? a : b) = m;
        }
        return {0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
    }
    std::size_t crossing(int a, int b) {
        const auto [known, fresh] = crossings_.try_emplace(std::pair{std::min(a, b), std::max(a, b)}, places_.size());
        if (fresh) {
            places_.push_back(turn(place(a), place(b)));
            next_.emplace_back();
            used_.push_back(false);
        }
        return known->second;
    }
    void add_triangle(const std::array<int, 3>& corners) {
        std::vector<std::size_t> found;
        for (std::size_t k = 0; k < 3; ++k)
            if (side_[corners[k]] != side_[corners[(k + 1) % 3]]) found.push_back(crossing(corners[k], corners[(k + 1) % 3]));
        if (found.size() != 2) return;
        next_[found[0]].push_back(found[1]);
        next_[found[1]].push_back(found[0]);
    }

    std::vector<Point> walk(std::size_t k, bool loop) {
        const std::size_t first = k;
        std::vector<Point> points{point(places_[k])};
        used_[k] = true;
        for (bool more = true; more;) {
            more = false;
            for (const std::size_t other : next_[k])
                if (!used_[other]) {
                    refine(places_[k], places_[other], 6, points);
                    used_[other] = true;
                    k = other;
                    more = true;
                    break;
                }
        }
        if (loop && next_[first].size() == 2 && k != first) refine(places_[k], places_[first], 6, points);
        std::erase_if(points, [&](const Point& p) { return !finite(p) || !(camera_.depth(p) > 0); });
        return points;
    }
    /// From a to b along the contour, without a.
    void refine(const Vec2& a, const Vec2& b, int depth, std::vector<Point>& out) const {
        const Point pa = point(a), pb = point(b);
        const bool visible = camera_.depth(pa) > 0 && camera_.depth(pb) > 0;
        if (depth > 0 && visible && apart(camera_.project(pa), camera_.project(pb)) > kStep) {
            const Vec2 m = between(a, b);
            refine(a, m, depth - 1, out);
            refine(m, b, depth - 1, out);
        } else {
            out.push_back(pb);
        }
    }
    /// On the contour, across the middle of a and b; the middle itself where it is not found there.
    Vec2 between(const Vec2& a, const Vec2& b) const {
        const Vec2 m{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)}, across{b.y - a.y, a.x - b.x};
        for (const double reach : {0.1, 0.5}) {
            const Vec2 left{m.x - reach * across.x, m.y - reach * across.y}, right{m.x + reach * across.x, m.y + reach * across.y};
            if ((facing(left) >= 0) != (facing(right) >= 0)) return turn(left, right);
        }
        return m;
    }

    const Patch& patch_;
    const Camera& camera_;
    Rect rect_;
    int columns_ = 1, rows_ = 1;
    std::vector<char> side_;  // of each grid point: whether the normal points away from the eye
    std::map<std::pair<int, int>, std::size_t> crossings_;
    std::vector<Vec2> places_;
    std::vector<std::vector<std::size_t>> next_;
    std::vector<char> used_;
};

/// Borders, and folds between patches.
class Edges {
public:
    Edges(const Composite& patches, const Camera& camera, double size) : patches_(patches), camera_(camera), topology_(find_topology(patches, 1e-7 * size)) {}

    void add(bool borders, std::vector<std::vector<Point>>& lines) const {
        for (const Rim& rim : topology_.rims) {
            if (rim.collapsed || rim.uses.empty()) continue;
            if (rim.uses.size() == 1 && borders) add(rim, [](double) { return true; }, lines);
            if (rim.uses.size() == 2) add(rim, [&](double s) { return folds(rim, s); }, lines);
        }
    }

private:
    double parameter(const RimUse& use, double s) const { return (1 - s) * use.t0 + s * use.t1; }
    Point point(const Rim& rim, double s) const {
        const RimUse& use = rim.uses[0];
        const Patch& patch = patches_[use.member].patch;
        const Vec2 uv = patch.edge_point(use.edge, parameter(use, s));
        return patch.point(uv.x, uv.y);
    }
    Point normal(const RimUse& use, double t) const {
        const Patch& patch = patches_[use.member].patch;
        const Vec2 uv = patch.edge_point(use.edge, t);
        const Point n = unit_normal_at(patch, uv);
        return topology_.flipped[use.member] ? -n : n;
    }
    bool folds(const Rim& rim, double s) const {
        const RimUse& other = rim.uses[1];
        const Point p = point(rim, s), view = toward(camera_, p);
        const double t = other.affine ? parameter(other, s) : nearest_on_edge(patches_[other.member].patch, other.edge, p, std::min(other.t0, other.t1), std::max(other.t0, other.t1));
        const Point a = normal(rim.uses[0], parameter(rim.uses[0], s)), b = normal(other, t);
        return length(a - b) > kFold && dot(a, view) * dot(b, view) < 0;
    }
    template <class Drawn> void add(const Rim& rim, Drawn drawn, std::vector<std::vector<Point>>& lines) const {
        std::vector<Point> points;
        const auto close = [&] {
            if (points.size() > 1) lines.push_back(points);
            points.clear();
        };
        for (const double s : fine_parameters([&](double x) { return point(rim, x); }, 0, 1, camera_)) {
            const Point p = point(rim, s);
            if (finite(p) && camera_.depth(p) > 0 && drawn(s)) points.push_back(p);
            else close();
        }
        close();
    }

    const Composite& patches_;
    const Camera& camera_;
    Topology topology_;
};

}  // namespace

std::vector<std::vector<Point>> outline_of(const Composite& patches, const Camera& camera, double size, bool borders) {
    std::vector<std::vector<Point>> lines;
    for (const Member& m : patches) {
        auto own = Contours(m.patch, camera).lines();
        lines.insert(lines.end(), own.begin(), own.end());
    }
    Edges(patches, camera, size).add(borders, lines);
    return lines;
}

}  // namespace isoparm
