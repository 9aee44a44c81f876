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

/// sin x = x + x^3 (s0 + s1 x^2 + ...), cos x = 1 - x^2 / 2 + x^4 (c0 + c1 x^2 + ...) for |x| <= pi/4, within an ulp: fdlibm's (Sun Microsystems, 1993).
/// Those of C's library differ from machine to machine, and take one number at a time.
inline constexpr double kSine[] = {-1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04, 2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10};
inline constexpr double kCosine[] = {4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05, -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11};

/// Square to unit disc, area preserving (Shirley and Chiu 1997).
inline Vec2 on_disc(const Vec2& s) {
    const double a = 2 * s.x - 1, b = 2 * s.y - 1;
    const bool wide = std::fabs(a) > std::fabs(b);
    const double r = wide ? a : b, t = r != 0 ? std::numbers::pi / 4 * ((wide ? b : a) / r) : 0, z = t * t;
    double sine = kSine[5], cosine = kCosine[5];
    for (int i = 4; i >= 0; --i) sine = kSine[i] + z * sine, cosine = kCosine[i] + z * cosine;
    sine = r * (t + t * z * sine), cosine = r * (1 - 0.5 * z + z * z * cosine);
    return wide ? Vec2{cosine, sine} : Vec2{sine, cosine};
}

/// Square to the hemisphere about z, its density the cosine over pi (Malley).
inline Point on_hemisphere(const Vec2& s) {
    const Vec2 d = on_disc(s);
    return {d.x, d.y, std::sqrt(std::max(0.0, 1 - d.x * d.x - d.y * d.y))};
}

inline Vec3<double> product(const Vec3<double>& a, const Vec3<double>& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

}  // namespace isoparm
