#include "rays/tubes.h"

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

Point at(const CubicPiece& b, double t) {
    const double s = 1 - t;
    return (s * s * s) * b[0] + (3 * s * s * t) * b[1] + (3 * s * t * t) * b[2] + (t * t * t) * b[3];
}

/// One-sided derivatives at both ends of a span are taken a hair inside it, so that breaks are not crossed.
CubicPiece hermite(const DrawnCurve& c, double from, double to) {
    const double h = to - from, inside = 1e-9 * h;
    const Point a = c.position(from), d = c.position(to);
    const auto handle = [&](double t) {
        const Point v = (h / 3) * c.derivative(t);
        return finite(v) ? v : (1.0 / 3) * (d - a);
    };
    return {a, a + handle(from + inside), d - handle(to - inside), d};
}

void split(const DrawnCurve& c, double from, double to, double tolerance, int depth, std::vector<CubicPiece>& out) {
    const CubicPiece piece = hermite(c, from, to);
    const auto off = [&](double t) { return distance(at(piece, t), c.position(from + t * (to - from))); };
    const double error = std::max({off(0.25), off(0.5), off(0.75), off(0.4)});
    if (depth == 0 || error <= tolerance) {
        if (finite(piece[0]) && finite(piece[3])) out.push_back(piece);
        return;
    }
    const double middle = 0.5 * (from + to);
    split(c, from, middle, tolerance, depth - 1, out);
    split(c, middle, to, tolerance, depth - 1, out);
}

bool collapsed(const std::vector<CubicPiece>& pieces, double tolerance) {
    for (const CubicPiece& piece : pieces)
        for (const Point& p : piece)
            if (distance(p, pieces.front()[0]) > tolerance) return false;
    return true;
}

}  // namespace

DrawnCurve drawn(const Curve& curve) {
    DrawnCurve d{curve.begin(),
                 curve.end(),
                 {},
                 [curve](double t) { return curve(t); },
                 [curve](double t) { return curve.derivative(t); }};
    for (const Break& b : curve.breaks()) d.breaks.push_back(b.t);
    return d;
}

DrawnCurve drawn_edge(const Patch& patch, int k) {
    const Vec2 a = patch.edge_point(k, 0), b = patch.edge_point(k, 1);
    const double du = b.x - a.x, dv = b.y - a.y;
    DrawnCurve d{0, 1, patch.edge_breaks(k), {}, {}};
    d.position = [patch, k](double t) {
        const Vec2 uv = patch.edge_point(k, t);
        return patch.point(uv.x, uv.y);
    };
    d.derivative = [patch, k, du, dv](double t) {
        const Vec2 uv = patch.edge_point(k, t);
        const PointJet j = patch.jet(uv.x, uv.y);
        return Point{du * j.x.coefficient(1, 0) + dv * j.x.coefficient(0, 1),
                     du * j.y.coefficient(1, 0) + dv * j.y.coefficient(0, 1),
                     du * j.z.coefficient(1, 0) + dv * j.z.coefficient(0, 1)};
    };
    return d;
}

std::vector<DrawnCurve> drawn_edges(const Composite& patches, double size) {
    std::vector<DrawnCurve> edges;
    std::vector<std::array<Point, 3>> seen;
    const auto same = [&](const Point& a, const Point& b) { return distance(a, b) <= 1e-7 * size; };
    for (const Member& m : patches)
        for (int k = 0; k < m.patch.edges(); ++k) {
            DrawnCurve edge = drawn_edge(m.patch, k);
            const std::array<Point, 3> p{edge.position(0), edge.position(0.5), edge.position(1)};
            const bool known = std::any_of(seen.begin(), seen.end(), [&](const auto& q) {
                return same(p[1], q[1]) &&
                       ((same(p[0], q[0]) && same(p[2], q[2])) || (same(p[0], q[2]) && same(p[2], q[0])));
            });
            if (known) continue;
            seen.push_back(p);
            edges.push_back(std::move(edge));
        }
    return edges;
}

std::vector<CubicPiece> cubic_pieces(const DrawnCurve& curve, double tolerance) {
    constexpr int kDepth = 12;
    std::vector<double> ends{curve.begin};
    for (const double t : curve.breaks)
        if (t > ends.back() && t < curve.end) ends.push_back(t);
    ends.push_back(curve.end);
    std::vector<CubicPiece> pieces;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) split(curve, ends[i], ends[i + 1], tolerance, kDepth, pieces);
    if (!pieces.empty() && collapsed(pieces, tolerance)) pieces.clear();
    return pieces;
}

}  // namespace isoparm
