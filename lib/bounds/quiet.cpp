#include "bounds/quiet.h"

#include <algorithm>

#include "bound.h"
#include "scalar/safe.h"

namespace isoparm {

double largest_form(const std::array<double, 3>& b, const std::array<double, 3>& q) {
    return std::max(simplex_maximum(q[0] + b[0], q[1] + b[1], q[2] + b[2]), simplex_maximum(q[0] - b[0], q[1] - b[1], q[2] - b[2]));
}

CubicForm::CubicForm(const Point& n, const std::array<double, 3>& b, const std::array<Point, 4>& t, const std::array<Vec2, 3>& uv, const Vec2& m) {
    const std::array<double, 4> f{dot(n, t[0]), dot(n, t[1]), dot(n, t[2]), dot(n, t[3])};
    const auto blossom = [&f](const Vec2& x, const Vec2& y, const Vec2& z) {
        const double uu = x.x * y.x, uv = x.x * y.y + x.y * y.x, vv = x.y * y.y;
        return z.x * (uu * f[0] + uv * f[1] + vv * f[2]) + z.y * (uu * f[1] + uv * f[2] + vv * f[3]);
    };
    const Vec2 g{(uv[0].x + uv[1].x + uv[2].x) * kThird, (uv[0].y + uv[1].y + uv[2].y) * kThird};
    std::array<Vec2, 3> v;
    std::array<double, 3> corner;
    for (int c = 0; c < 3; ++c) v[c] = {uv[c].x - g.x, uv[c].y - g.y}, corner[c] = blossom(v[c], v[c], v[c]);
    // Bernstein coefficients of the cubic's own deviation from its linear interpolant; the even parts of those on edges are quadratic.
    double inner = 6 * ((corner[0] + corner[1] + corner[2]) * kThird - blossom(v[0], v[1], v[2])), odd = 0;
    for (int k = 0; k < 3; ++k) {
        const Vec2 &x = v[k], &y = v[kNext[k]], e{y.x - x.x, y.y - x.y};
        const double first = (2 * corner[k] + corner[kNext[k]]) * kThird - blossom(x, x, y), second = (corner[k] + 2 * corner[kNext[k]]) * kThird - blossom(x, y, y);
        const double even = 1.5 * (first + second);
        form_[k] = b[k] + blossom(e, e, {g.x - m.x, g.y - m.y}) + even * kThird;
        inner -= even;
        odd += 1.5 * std::fabs(first - second);
    }
    rest_ = std::fabs(inner) * kInner + kOdd / 6 * odd;
}

double CubicForm::largest(const std::array<double, 3>& q) const { return 0.5 * largest_form(form_, q) + rest_; }

double CubicForm::beside(int k, const std::array<double, 3>& q, double wide) const {
    const auto size = [&](int i) { return std::fabs(form_[i]) + q[i]; };
    return 0.125 * size(k) + 0.5 * wide * std::max(size(kNext[k]), size(kNext[kNext[k]])) + rest_;
}

std::array<Point, 3> along_edge(int k, const std::array<Point, 3>& x, const std::array<Point, 3>& b) {
    const int after = kNext[k], last = kNext[after];
    std::array<Point, 3> at;
    at[k] = x[k] - 0.5 * b[k];
    at[after] = x[k] + 0.5 * b[k];
    at[last] = x[k] + 0.5 * (b[last] - b[after]);
    return at;
}

bool lenses_apart(const std::array<double, 3>& lens, const std::array<double, 3>& side, double twice_area) {
    for (int c = 0; c < 3; ++c) {
        const int before = kNext[kNext[c]];
        if (!((lens[c] * side[before] + lens[before] * side[c]) * kSafe <= 2 * kLens * twice_area)) return false;
    }
    return true;
}

bool keeps_orientation(const Point& n, const std::array<Point, 3>& x, const std::array<Point, 3>& b, const std::array<double, 3>& q, const std::array<double, 3>& bend, double tilt) {
    const std::array<double, 3> side{length(x[0]), length(x[1]), length(x[2])};
    const int base = side[0] >= side[1] && side[0] >= side[2] ? 0 : side[1] >= side[2] ? 1 : 2, i = kNext[base], j = kNext[i];
    const std::array<Point, 3> along_i = along_edge(i, x, b), along_j = along_edge(j, x, b);
    double least = dot(n, cross(along_i[0], along_j[0]));
    for (int c = 0; c < 3; ++c) {
        const int d = kNext[c];
        least = std::min({least, dot(n, cross(along_i[c], along_j[c])), 0.5 * (dot(n, cross(along_i[c], along_j[d])) + dot(n, cross(along_i[d], along_j[c])))});
    }
    const auto most = [&](int k) { return side[k] + 0.5 * (bend[0] + bend[1] + bend[2] + bend[k]); };
    const auto off = [&](int k) { return 0.5 * (q[0] + q[1] + q[2] + q[k]); };
    const double mi = most(i), mj = most(j), oi = off(i), oj = off(j);
    return (mi * oj + mj * oi + oi * oj + (tilt + 1e-13) * mi * mj + 2 * tilt * dot(n, cross(x[i], x[j]))) * kSafe + kUnderflow < least;
}

}  // namespace isoparm
