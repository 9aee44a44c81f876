#include "transform.h"

#include "error.h"

namespace isoparm {

Transform Transform::translate(const Point& by) {
    Transform t;
    for (int i = 0; i < 3; ++i) t.m[i][3] = by[i];
    return t;
}

Transform Transform::scale(const Point& by) {
    Transform t;
    for (int i = 0; i < 3; ++i) t.m[i][i] = by[i];
    return t;
}

Transform Transform::rotate(const Point& axis, double degrees) {
    const double size = length(axis);
    if (!(size > 0) || !std::isfinite(size)) throw_input("found a rotation axis of length " + to_text(size) + ", expected a direction");
    // Quarter turns exactly, the rest through sine and cosine of at most 90 degrees.
    const double turns = std::floor(degrees / 90), rest = (degrees - 90 * turns) * (M_PI / 180);
    double c = rest == 0 ? 1 : std::cos(rest), s = rest == 0 ? 0 : std::sin(rest);
    for (int k = 0, n = static_cast<int>(std::fmod(std::fmod(turns, 4) + 4, 4)); k < n; ++k) {
        const double t = c;
        c = -s;
        s = t;
    }
    const Point a = axis / size;
    Transform t;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) t.m[i][j] = (i == j ? c : 0) + (1 - c) * a[i] * a[j];
    t.m[0][1] -= s * a.z, t.m[0][2] += s * a.y;
    t.m[1][0] += s * a.z, t.m[1][2] -= s * a.x;
    t.m[2][0] -= s * a.y, t.m[2][1] += s * a.x;
    return t;
}

Transform Transform::mirror(const Point& normal, double offset) {
    const double n2 = dot(normal, normal);
    if (!(n2 > 0) || !std::isfinite(n2)) throw_input("found a mirror plane with normal of length " + to_text(std::sqrt(n2)) + ", expected a direction");
    Transform t;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) t.m[i][j] = (i == j ? 1 : 0) - 2 * normal[i] * normal[j] / n2;
        t.m[i][3] = 2 * offset * normal[i] / n2;
    }
    return t;
}

double Transform::determinant() const {
    const Point a{m[0][0], m[1][0], m[2][0]}, b{m[0][1], m[1][1], m[2][1]}, c{m[0][2], m[1][2], m[2][2]};
    return dot(cross(a, b), c);
}

Transform operator*(const Transform& a, const Transform& b) {
    Transform r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j) {
            r.m[i][j] = j == 3 ? a.m[i][3] : 0;
            for (int k = 0; k < 3; ++k) r.m[i][j] += a.m[i][k] * b.m[k][j];
        }
    return r;
}

}  // namespace isoparm
