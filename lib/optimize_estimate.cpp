#include "optimize_estimate.h"

#include <algorithm>
#include <cmath>

namespace isoparm {

double Estimate::beyond(int k, const Estimate* other) const {
    if (other && other->quiet) {
        const Point d = unit - other->unit;
        const double square = dot(d, d), cosine = 1 - 0.5 * square;
        if (cosine >= 0.95) return std::max(normal, other->normal / cosine) + across[k] * (std::sqrt(square) / cosine);
    }
    return std::sqrt(normal * normal + across[k] * across[k]);
}

double Estimate::with(const std::array<const Estimate*, 3>& neighbours) const {
    return quiet ? std::max({beyond(0, neighbours[0]), beyond(1, neighbours[1]), beyond(2, neighbours[2])}) : parametric;
}

Estimate estimate(const SecondDerivatives& s, const Places& places) {
    Estimate result;
    const auto& p = places.uv;
    const Box box = box_of(p);
    const double ru = 0.5 * (box.u.hi - box.u.lo), rv = 0.5 * (box.v.hi - box.v.lo), du = 0.5 * (box.u.lo + box.u.hi) - s.u, dv = 0.5 * (box.v.lo + box.v.hi) - s.v;
    std::array<Point, 3> x;
    std::array<double, 3> side;
    for (int k = 0; k < 3; ++k) x[k] = places.x[(k + 1) % 3] - places.x[k], side[k] = length(x[k]);
    const Point normal = cross(x[0], x[1]);
    const double twice_area = length(normal);
    if (!(twice_area > 0)) return result;
    const Point n = result.unit = normal / twice_area;
    std::array<Point, 3> h, b;
    std::array<double, 4> along, all;  // of third derivatives
    for (int k = 0; k < 3; ++k) h[k] = s.h[k] + du * s.t[k] + dv * s.t[k + 1];
    for (int k = 0; k < 4; ++k) along[k] = std::fabs(dot(n, s.t[k])), all[k] = s.t_size[k] - s.t_rad[k];
    const double aspect = rv / ru;
    const auto diagonal = [&](const std::array<double, 4>& size) {  // of the form that bounds how far H strays
        const double suv = size[1] * ru + size[2] * rv;
        return Vec2{size[0] * ru + size[1] * rv + suv * aspect, size[2] * ru + size[3] * rv + suv / aspect};
    };
    const Vec2 form = diagonal(along), whole = diagonal(all);
    std::array<double, 3> plus, minus, q, bend;
    result.quiet = true;
    for (int k = 0; k < 3; ++k) {
        const double eu = p[(k + 1) % 3].x - p[k].x, ev = p[(k + 1) % 3].y - p[k].y;
        b[k] = eu * eu * h[0] + 2 * eu * ev * h[1] + ev * ev * h[2];
        q[k] = whole.x * eu * eu + whole.y * ev * ev, bend[k] = length(b[k]) + q[k];
        const double bn = dot(n, b[k]), qn = form.x * eu * eu + form.y * ev * ev;
        plus[k] = qn + bn, minus[k] = qn - bn;
        const double across = std::fabs(dot(cross(n, x[k]), b[k])) / side[k] + q[k];
        result.across[k] = across / 8;
        const double lens = (across + 0.32 * (std::fabs(bn) + qn)) * std::max(side[(k + 1) % 3], side[(k + 2) % 3]) * side[k];
        result.quiet = result.quiet && bend[k] <= side[k] && lens <= 0.39 * twice_area * (2 * side[k] - bend[k]);
    }
    result.quiet = result.quiet && keeps_orientation(n, x, b, q, bend, 0);
    result.normal = 0.5 * std::max(simplex_maximum(plus[0], plus[1], plus[2]), simplex_maximum(minus[0], minus[1], minus[2]));
    return result;
}

}  // namespace isoparm
