// transform.h -- affine maps of space.
#pragma once
#include <array>

#include "scalar/vec.h"

namespace isoparm {

struct Transform {
    std::array<std::array<double, 4>, 3> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

    static Transform translate(const Point& by);
    static Transform scale(const Point& by);
    /// Rotation by `degrees` about an axis through the origin, right-handed; multiples of 90 degrees about an axis of
    /// coordinates are exact. Throws Error(input) for a zero axis.
    static Transform rotate(const Point& axis, double degrees);
    /// Mirror at the plane normal . x = offset.
    static Transform mirror(const Point& normal, double offset);
    double determinant() const;
    /// Of a position (affine), and of a derivative (linear part).
    template <class T> Vec3<T> point(const Vec3<T>& p) const {
        Vec3<T> r = vector(p);
        for (int i = 0; i < 3; ++i) r[i] = r[i] + m[i][3];
        return r;
    }
    template <class T> Vec3<T> vector(const Vec3<T>& p) const {
        Vec3<T> r;
        for (int i = 0; i < 3; ++i) r[i] = p.x * m[i][0] + p.y * m[i][1] + p.z * m[i][2];
        return r;
    }
};
/// First b, then a.
Transform operator*(const Transform& a, const Transform& b);

}  // namespace isoparm
