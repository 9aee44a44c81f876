// local_frame.h -- directions relative to a normal, and points of a square on a disc.
#pragma once
#include <cmath>
#include <numbers>

#include "scalar/vec.h"

namespace isoparm {

/// A right-handed orthonormal frame whose z is the unit vector n (Duff et al., JCGT 2017).
struct LocalFrame {
    Point x, y, z;
    explicit LocalFrame(const Point& n) : z(n) {
        const double s = std::copysign(1.0, n.z), a = -1 / (s + n.z), b = n.x * n.y * a;
        x = {1 + s * n.x * n.x * a, s * b, -s * n.x};
        y = {b, s + n.y * n.y * a, -n.y};
    }
    Point to_world(const Point& d) const { return d.x * x + d.y * y + d.z * z; }
    Point to_local(const Point& d) const { return {dot(d, x), dot(d, y), dot(d, z)}; }
};

/// Square to unit disc, area preserving (Shirley and Chiu 1997).
inline Vec2 on_disc(const Vec2& s) {
    const double a = 2 * s.x - 1, b = 2 * s.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    const bool wide = std::fabs(a) > std::fabs(b);
    const double r = wide ? a : b, phi = wide ? std::numbers::pi / 4 * (b / a) : std::numbers::pi / 2 - std::numbers::pi / 4 * (a / b);
    return {r * std::cos(phi), r * std::sin(phi)};
}

/// Square to the hemisphere about z, its density the cosine over pi (Malley).
inline Point on_hemisphere(const Vec2& s) {
    const Vec2 d = on_disc(s);
    return {d.x, d.y, std::sqrt(std::max(0.0, 1 - d.x * d.x - d.y * d.y))};
}

inline Vec3<double> product(const Vec3<double>& a, const Vec3<double>& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

}  // namespace isoparm
