#include "optimize_estimate.h"

#include <algorithm>
#include <cmath>

#include "quiet.h"

namespace isoparm {

double Estimate::beyond(int k, const Estimate* other) const {
    if (other && other->quiet) {
        const Point d = unit - other->unit;
        const double square = dot(d, d), cosine = 1 - 0.5 * square;
        if (cosine >= 0.95) return beside[k] / cosine + across[k] * (std::sqrt(square) / cosine);
    }
    return std::sqrt(beside[k] * beside[k] + across[k] * across[k]);
}

double Estimate::with(const std::array<const Estimate*, 3>& neighbours) const {
    return quiet ? std::max({normal, beyond(0, neighbours[0]), beyond(1, neighbours[1]), beyond(2, neighbours[2])}) : parametric;
}

Estimate estimate(const SecondDerivatives& s, const Places& places) {
    Estimate result;
    const auto& p = places.uv;
    const Box box = box_of(p);
    const double ru = 0.5 * (box.u.hi - box.u.lo), rv = 0.5 * (box.v.hi - box.v.lo);
    const Vec2 m{0.5 * (box.u.lo + box.u.hi), 0.5 * (box.v.lo + box.v.hi)};
    std::array<Point, 3> x;
    std::array<double, 3> side;
    for (int k = 0; k < 3; ++k) x[k] = places.x[kNext[k]] - places.x[k], side[k] = length(x[k]);
    const Point normal = cross(x[0], x[1]);
    const double twice_area = length(normal), longest = std::max({side[0], side[1], side[2]});
    if (!(twice_area > 0)) return result;
    const Point n = result.unit = normal / twice_area;
    const ThirdDerivatives third{s.t};
    std::array<Point, 3> h, b;
    for (int k = 0; k < 3; ++k) h[k] = s.h[k] + (m.x - s.u) * s.t[k] + (m.y - s.v) * s.t[k + 1];
    std::array<double, 4> all;  // sizes of third derivatives
    for (int k = 0; k < 4; ++k) all[k] = s.t_size[k] - s.t_rad[k];
    const double aspect = rv / ru, suv = all[1] * ru + all[2] * rv;
    const Vec2 stray{all[0] * ru + all[1] * rv + suv * aspect, all[2] * ru + all[3] * rv + suv / aspect};  // of the form that bounds how far H strays
    std::array<double, 3> q, bend, bn, lens;
    result.quiet = true;
    for (int k = 0; k < 3; ++k) {
        const Vec2 &from = p[k], &to = p[kNext[k]], e{to.x - from.x, to.y - from.y};
        b[k] = e.x * e.x * h[0] + 2 * e.x * e.y * h[1] + e.y * e.y * h[2];
        q[k] = stray.x * e.x * e.x + stray.y * e.y * e.y, bend[k] = length(b[k]) + q[k], bn[k] = dot(n, b[k]);
        const EdgeBend edge{b[k] + third(e, {0.5 * ((from.x - m.x) + (to.x - m.x)), 0.5 * ((from.y - m.y) + (to.y - m.y))}), 0.5 * third(e, e)};
        const double across = edge.along(cross(n, x[k]) / side[k]), any = edge.largest();
        result.across[k] = across / 8;
        lens[k] = (across + 0.32 * edge.along(n)) * side[k] / (2 * side[k] - any);
        result.quiet = result.quiet && any <= side[k] && bend[k] <= 1.5 * longest;
    }
    result.quiet = result.quiet && lenses_apart(lens, side, twice_area) && keeps_orientation(n, x, b, q, bend, 0);
    const CubicForm cubic(n, bn, s.t, p, m);
    result.normal = cubic.largest({});
    for (int k = 0; k < 3; ++k) result.beside[k] = std::min(result.normal, cubic.beside(k, {}, 0));
    return result;
}

}  // namespace isoparm
