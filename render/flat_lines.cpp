#include "flat_lines.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

constexpr double kStep = 1.5;      // pixels between points
constexpr std::size_t kShort = 3;  // runs of fewer steps are noise of the depth test
constexpr double kFlat = 0.02;     // pixels by which a line may be off when points are left out

double apart(const Vec2& a, const Vec2& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// From a to b as straight as makes no difference? Then the points between are not needed.
bool straight(const std::vector<Vec2>& p, std::size_t a, std::size_t b) {
    const double x = p[b].x - p[a].x, y = p[b].y - p[a].y, length = std::hypot(x, y);
    for (std::size_t i = a + 1; i < b; ++i) {
        const double px = p[i].x - p[a].x, py = p[i].y - p[a].y;
        if (std::fabs(x * py - y * px) > kFlat * length || x * px + y * py < 0) return false;
    }
    return length > 0;
}

std::vector<Vec2> thinned(const std::vector<Vec2>& p) {
    constexpr std::size_t kMost = 64;
    std::vector<Vec2> kept{p.front()};
    for (std::size_t a = 0; a + 1 < p.size();) {
        std::size_t b = a + 1;
        while (b + 1 < p.size() && b + 1 - a <= kMost && straight(p, a, b + 1)) ++b;
        kept.push_back(p[b]);
        a = b;
    }
    return kept;
}

struct Run {
    std::size_t first, last;  // points; neighbouring runs share one
    double seen;
};

std::vector<Run> runs_of(const std::vector<double>& seen) {
    std::vector<Run> runs;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (!runs.empty() && std::fabs(runs.back().seen - seen[i]) < 1e-6)
            runs.back().last = i;
        else
            runs.push_back({i == 0 ? 0 : i - 1, i, seen[i]});
    }
    std::vector<Run> kept;
    for (const Run& r : runs) {
        if (!kept.empty() && (r.last - r.first <= kShort || std::fabs(kept.back().seen - r.seen) < 1e-6))
            kept.back().last = r.last;
        else if (kept.size() == 1 && kept[0].last - kept[0].first <= kShort)
            kept[0] = {kept[0].first, r.last, r.seen};
        else
            kept.push_back(r);
    }
    return kept;
}

}  // namespace

double opacity_of(Hidden hidden, double seen) {
    switch (hidden) {
        case Hidden::hide:
            return seen;
        case Hidden::show:
            return 1;
        case Hidden::ghost:
            return 0.4 + 0.6 * seen;
        case Hidden::dash:
            return 0.6 + 0.4 * seen;
    }
    return 1;
}

std::vector<Point> fine_points(const std::vector<CubicPiece>& pieces, const Camera& camera) {
    std::vector<Point> points;
    for (const CubicPiece& b : pieces) {
        double length = 0;  // of the polygon on the picture, which is not shorter than the curve
        for (int k = 0; k < 3; ++k)
            if (camera.depth(b[k]) > 0 && camera.depth(b[k + 1]) > 0)
                length += apart(camera.project(b[k]), camera.project(b[k + 1]));
        const int steps = static_cast<int>(std::clamp(std::ceil(length / kStep), 1.0, 20000.0));
        for (int i = points.empty() ? 0 : 1; i <= steps; ++i) {
            const double t = static_cast<double>(i) / steps, s = 1 - t;
            const Point p = (s * s * s) * b[0] + (3 * s * s * t) * b[1] + (3 * s * t * t) * b[2] + (t * t * t) * b[3];
            if (camera.depth(p) > 0) points.push_back(p);
        }
    }
    return points;
}

void add_line(const std::vector<Point>& points, const LineLook& look, const Sight& sight, double clear,
              Drawing& drawing) {
    if (points.size() < 2 || !(look.width > 0) || !(look.opacity > 0)) return;
    std::vector<Vec2> at;
    std::vector<double> seen;
    for (const Point& p : points) {
        at.push_back(sight.camera().project(p));
        seen.push_back(look.hidden == Hidden::show ? 1 : sight.of(p, clear));
    }
    const auto runs = runs_of(seen);
    for (const Run& r : runs) {
        const double opacity = look.opacity * opacity_of(look.hidden, r.seen);
        if (opacity < 0.02) continue;
        const bool behind = r.seen < 0.999 && look.hidden != Hidden::hide && look.hidden != Hidden::show;
        const double width = behind ? 0.75 * look.width : look.width;
        Polyline line{thinned({at.begin() + static_cast<std::ptrdiff_t>(r.first),
                               at.begin() + static_cast<std::ptrdiff_t>(r.last) + 1}),
                      width, look.dash, runs.size() == 1};
        if (behind && look.hidden == Hidden::dash && line.dash.empty()) line.dash = {4 * width, 3 * width};
        if (!line.dash.empty()) line.round = false;
        drawing.push_back({std::move(line), look.color, opacity});
    }
}

}  // namespace isoparm
