#include "drawing/flat_lines.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

constexpr double kStep = 1.5;      // pixels between points
constexpr double kShort = 2;       // shorter runs, pixels, are noise of the depth test
constexpr double kFlat = 0.02;     // pixels by which a line may be off when points are left out

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

std::vector<Run> runs_of(const std::vector<double>& seen, const std::vector<Vec2>& at) {
    const auto is_short = [&](const Run& r) {
        double pixels = 0;
        for (std::size_t i = r.first; i < r.last && pixels <= kShort; ++i) pixels += apart(at[i], at[i + 1]);
        return pixels <= kShort;
    };
    std::vector<Run> runs;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (!runs.empty() && std::fabs(runs.back().seen - seen[i]) < 1e-6)
            runs.back().last = i;
        else
            runs.push_back({i == 0 ? 0 : i - 1, i, seen[i]});
    }
    std::vector<Run> kept;
    for (const Run& r : runs) {
        if (!kept.empty() && (is_short(r) || std::fabs(kept.back().seen - r.seen) < 1e-6))
            kept.back().last = r.last;
        else if (kept.size() == 1 && is_short(kept[0]))
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

namespace {

/// A line on the picture, and how much of each of its points is seen.
struct SeenLine {
    std::vector<Vec2> at;
    std::vector<double> seen;
    void add(const Vec2& p, double s) {
        at.push_back(p);
        seen.push_back(s);
    }
};

/// Where between a and b what is seen changes, as far on as it is still as at a.
Point change(const Point& a, const Point& b, double seen_at_a, const Sight& sight, double clear) {
    double low = 0, high = 1;
    for (int i = 0; i < 5; ++i) {
        const double middle = 0.5 * (low + high);
        (std::fabs(sight.of((1 - middle) * a + middle * b, clear) - seen_at_a) < 1e-6 ? low : high) = middle;
    }
    const double t = 0.5 * (low + high);
    return (1 - t) * a + t * b;
}

SeenLine seen_line(const std::vector<Point>& points, const Sight& sight, bool all, double clear, const std::vector<double>& fade) {
    SeenLine line;
    double before = 1;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double now = all ? 1 : sight.of(points[i], clear), f = fade.empty() ? 1 : fade[i];
        if (i > 0 && std::fabs(now - before) > 1e-6) line.add(sight.camera().project(change(points[i - 1], points[i], before, sight, clear)), line.seen.back());
        line.add(sight.camera().project(points[i]), now * f);
        before = now;
    }
    return line;
}

void refine(const std::function<Point(double)>& curve, double a, const Point& pa, double b, const Point& pb, const Camera& camera, int depth, std::vector<double>& out) {
    const bool before = camera.depth(pa) > 0 && camera.depth(pb) > 0 && finite(pa) && finite(pb);
    if (depth > 0 && before && apart(camera.project(pa), camera.project(pb)) > kStep) {
        const double m = 0.5 * (a + b);
        const Point pm = curve(m);
        refine(curve, a, pa, m, pm, camera, depth - 1, out);
        refine(curve, m, pm, b, pb, camera, depth - 1, out);
        return;
    }
    out.push_back(b);
}

bool alike(const DrawingItem& a, const DrawingItem& b) {
    const auto *x = std::get_if<Polyline>(&a.shape), *y = std::get_if<Polyline>(&b.shape);
    return x && y && a.color == b.color && a.opacity == b.opacity && x->width == y->width && x->dash == y->dash;
}

}  // namespace

std::vector<double> fine_parameters(const std::function<Point(double)>& curve, double from, double to, const Camera& camera) {
    constexpr int kSpans = 16, kDepth = 10;
    std::vector<double> all{from};
    Point last = curve(from);
    for (int i = 1; i <= kSpans; ++i) {
        const double t = i == kSpans ? to : from + (to - from) * i / kSpans;
        const Point p = curve(t);
        refine(curve, all.back(), last, t, p, camera, kDepth, all);
        last = p;
    }
    return all;
}

void add_line(const std::vector<Point>& points, const LineLook& look, const Sight& sight, double clear,
              Drawing& drawing, const std::vector<double>& fade) {
    if (points.size() < 2 || !(look.width > 0) || !(look.opacity > 0)) return;
    const auto [at, seen] = seen_line(points, sight, look.hidden == Hidden::show, clear, fade);
    const auto runs = runs_of(seen, at);
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

void join_lines(Drawing& drawing, std::size_t first) {
    Drawing joined(drawing.begin(), drawing.begin() + static_cast<std::ptrdiff_t>(std::min(first, drawing.size())));
    for (std::size_t i = first; i < drawing.size(); ++i) {
        const auto same = std::find_if(joined.begin() + static_cast<std::ptrdiff_t>(first), joined.end(), [&](const DrawingItem& other) { return alike(other, drawing[i]); });
        if (same == joined.end()) {
            joined.push_back(std::move(drawing[i]));
            continue;
        }
        Polyline &line = std::get<Polyline>(same->shape), &more = std::get<Polyline>(drawing[i].shape);
        line.more.push_back(std::move(more.points));
    }
    drawing = std::move(joined);
}

}  // namespace isoparm
