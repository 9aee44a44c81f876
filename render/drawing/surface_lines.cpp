#include "drawing/surface_lines.h"

#include <algorithm>
#include <cmath>

#include "drawing/flat_lines.h"
#include "drawing/isolines.h"

namespace isoparm {
namespace {

constexpr double kFadeSteps = 6;

/// A line on a patch: its parameters at t in [0,1], and which of u, v and w is constant on it.
struct ParameterLine {
    Vec2 from, to;
    int constant = 0;
    double step = 1;  // to the next of its family, in its parameter
    bool at_edge = false;
    Vec2 at(double t) const { return {(1 - t) * from.x + t * to.x, (1 - t) * from.y + t * to.y}; }
};

std::vector<ParameterLine> lines_on(const Patch& patch, const Isolines& lines) {
    const Rect r = patch.rect();
    const bool triangle = patch.domain() == Domain::triangle;
    std::vector<ParameterLine> all;
    const auto family = [&](int count, double low, double high, int constant, auto ends) {
        if (count <= 0) return;
        const double step = isoline_step(count, low, high);
        for (const double x : isoline_places(count, low, high)) {
            const auto [a, b] = ends(x);
            all.push_back({a, b, constant, step, x == low || x == high});
        }
    };
    using Ends = std::pair<Vec2, Vec2>;
    family(lines.u, r.u0, r.u1, 0, [&](double u) { return Ends{{u, r.v0}, {u, triangle ? 1 - u : r.v1}}; });
    family(lines.v, r.v0, r.v1, 1, [&](double v) { return Ends{{r.u0, v}, {triangle ? 1 - v : r.u1, v}}; });
    if (triangle) family(std::max(lines.u, lines.v), 0, 1, 2, [&](double w) { return Ends{{1 - w, 0}, {0, 1 - w}}; });
    return all;
}

/// Lines on edges that were drawn already, with another patch.
class Known {
public:
    explicit Known(double size) : near_(1e-7 * size) {}
    bool add(const Patch& patch, const ParameterLine& line) {
        std::array<Point, 3> p;
        for (int i = 0; i < 3; ++i) {
            const Vec2 at = line.at(0.5 * i);
            p[i] = patch.point(at.x, at.y);
        }
        for (const auto& q : edges_)
            if (same(p[1], q[1]) && ((same(p[0], q[0]) && same(p[2], q[2])) || (same(p[0], q[2]) && same(p[2], q[0])))) return false;
        edges_.push_back(p);
        return true;
    }

private:
    bool same(const Point& a, const Point& b) const { return distance(a, b) <= near_; }
    double near_;
    std::vector<std::array<Point, 3>> edges_;
};

double fade_at(const Patch& patch, const ParameterLine& line, const Vec2& at, double width, const Camera& camera) {
    const PointFrame f = patch.frame(at.x, at.y);
    const auto of = [&](int i, int k) { return Point{f.x.coefficient(i, k), f.y.coefficient(i, k), f.z.coefficient(i, k)}; };
    const Point p = of(0, 0);
    const PatchPlace place{patch.domain(), patch.rect(), at.x, at.y, of(1, 0), of(0, 1)};
    if (!finite(p) || !finite(place.du) || !finite(place.dv)) return 0;
    const Point direction = camera.orthographic ? camera.forward : normalized(p - camera.eye);
    const double a_pixel = parameters_a_pixel(place, camera, p, direction)[static_cast<std::size_t>(line.constant)];
    if (!std::isfinite(a_pixel)) return 0;
    return std::round(kFadeSteps * isoline_fade(a_pixel, line.step, width)) / kFadeSteps;
}

}  // namespace

void add_isolines(const Composite& patches, const Isolines& lines, double pixel, double size, const Sight& sight, Drawing& drawing) {
    if ((lines.u <= 0 && lines.v <= 0) || !(lines.opacity > 0) || !(lines.width > 0)) return;
    const LineLook look{lines.color, lines.opacity, lines.width * pixel, {}, Hidden::hide};
    const std::size_t first = drawing.size();
    Known known(size);
    for (const Member& m : patches)
        for (const ParameterLine& line : lines_on(m.patch, lines)) {
            if (line.at_edge && !known.add(m.patch, line)) continue;
            const auto at = [&](double t) {
                const Vec2 uv = line.at(t);
                return m.patch.point(uv.x, uv.y);
            };
            std::vector<Point> points;
            std::vector<double> fade;
            for (const double t : fine_parameters(at, 0, 1, sight.camera())) {
                const Point p = at(t);
                if (!finite(p) || !(sight.camera().depth(p) > 0)) continue;
                points.push_back(p);
                fade.push_back(fade_at(m.patch, line, line.at(t), look.width, sight.camera()));
            }
            add_line(points, look, sight, 0, drawing, fade);
        }
    join_lines(drawing, first);
}

}  // namespace isoparm
