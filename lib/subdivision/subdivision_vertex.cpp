#include "subdivision/subdivision_vertex.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace isoparm {
namespace {

constexpr int kLimitSteps = 400;  // the slowest neighbourhood shrinks by 0.66 a step

/// Normal at corner k, where that is a smooth inner vertex among quads or triangles: the cross product of the sums over its ring that are the eigenvectors
/// of the two tangents (Loop 1987; Halstead, Kass & DeRose 1993). None elsewhere, nor where rounding would be seen.
std::optional<Point> smooth_normal(const Ring<double>& ring, int k, Scheme scheme) {
    const int v = ring.faces[0][k];
    if (scheme == Scheme::bilinear || ring.sharpness[v] > 0) return {};
    for (const auto& c : ring.creases)
        if (c.a == v || c.b == v) return {};
    struct Sector {
        int across, last;  // the vertex opposite v, and the neighbour of v where the next face begins
    };
    std::map<int, Sector> sectors;  // by the neighbour where they begin
    for (const auto& f : ring.faces) {
        const std::size_t n = f.size(), at = std::find(f.begin(), f.end(), v) - f.begin();
        if (at < n) sectors[f[(at + 1) % n]] = {f[(at + 2) % n], f[(at + n - 1) % n]};
    }
    const int n = static_cast<int>(sectors.size());
    if (n < 3) return {};
    const auto angle = [&](int i) { return 2 * std::numbers::pi * i / n; };
    const double c = std::cos(angle(1)), near = scheme == Scheme::loop ? 1 : 1 + c + std::cos(angle(1) / 2) * std::sqrt(2 * (9 + c));
    Point x{0, 0, 0}, y{0, 0, 0};
    int next = sectors.begin()->first;
    for (int i = 0; i < n; ++i) {
        const auto s = sectors.find(next);
        if (s == sectors.end()) return {};
        const Point p = near * (ring.points[next] - ring.points[v]);
        x += std::cos(angle(i)) * p, y += std::sin(angle(i)) * p;
        if (scheme != Scheme::loop) {
            const Point q = ring.points[s->second.across] - ring.points[v];
            x += (std::cos(angle(i)) + std::cos(angle(i + 1))) * q, y += (std::sin(angle(i)) + std::sin(angle(i + 1))) * q;
        }
        next = s->second.last;
    }
    const Point z = cross(x, y);
    if (!(length(z) > 1e-2 * length(x) * length(y))) return {};
    return normalized(z);
}

}  // namespace

Box3 limit_position(Ring<Interval> ring, int k, Scheme scheme) {
    Box3 all = hull_of(ring);
    for (int step = 0; step < kLimitSteps; ++step) {
        Ring<Interval> next = Subdivider<Interval>(ring, scheme).child(k);
        const Box3 smaller = hull_of(next);
        if (!(size_of(smaller) < 0.99 * size_of(all))) break;
        ring = std::move(next), all = smaller;
    }
    return all;
}

/// The limit of the normals of the sub-faces at corner k. Linear maps commute with subdivision: after each step one moves the corner to 0 and makes the
/// sub-face's two diagonals, or median and side, the axes x and y, so that neither of them loses its digits to the other; the last row of the product of these maps tends
/// to the normal. Slowly so at high valences: none is given that has not come within some 1e-13 of it, and where there is a formula it is used.
std::optional<Point> limit_normal(const Ring<Interval>& exact, int k, Scheme scheme) {
    Ring<double> ring;
    for (const auto& p : exact.points) ring.points.push_back(middle(p));
    ring.sharpness = exact.sharpness, ring.faces = exact.faces;
    for (const auto& c : exact.creases) ring.creases.push_back({c.a, c.b, c.sharpness});
    std::array<Point, 3> rows{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
    std::optional<Point> last, halfway;
    for (int step = 0; step < kLimitSteps; ++step) {
        ring = Subdivider<double>(ring, scheme).child(k);
        const auto& f = ring.faces[0];
        const int n = static_cast<int>(f.size());
        const Point origin = ring.points[f[k]], a = ring.points[f[(k + 1) % n]] - origin, b = ring.points[f[(k + n - 1) % n]] - origin;
        const Point x = a - b, y = n == 4 ? ring.points[f[(k + 2) % n]] - origin : 0.5 * (a + b), z = normalized(cross(x, y));
        // The inverse of the matrix of the columns x, y, z: its rows.
        const double det = dot(cross(x, y), z);
        std::array<Point, 3> map{cross(y, z) / det, cross(z, x) / det, z};
        const auto image = [&](const Point& row) { return row.x * rows[0] + row.y * rows[1] + row.z * rows[2]; };
        map[2] = map[2] / length(image(z));
        for (Point& p : ring.points) p = {dot(map[0], p - origin), dot(map[1], p - origin), dot(map[2], p - origin)};
        rows = {image(map[0]), image(map[1]), image(map[2])};
        if (!finite(rows[0]) || !finite(rows[1]) || !finite(rows[2])) return {};
        if (const auto normal = smooth_normal(ring, k, scheme)) return normalized(image(*normal));
        if (last && length(rows[2] - *last) < 4e-16) return last;
        last = rows[2];
        if (2 * step == kLimitSteps) halfway = last;
    }
    // Errors shrink like powers: what was off halfway is off by some square of that now.
    return last && halfway && length(*last - *halfway) < 1e-7 ? last : std::nullopt;
}

}  // namespace isoparm
