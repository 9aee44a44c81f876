// scalar/vec.h -- points and vectors of space over any scalar.
#pragma once
#include <cmath>
#include <numbers>

namespace isoparm {

template <class T> struct Vec3 {
    T x{}, y{}, z{};
    Vec3() = default;
    Vec3(T a, T b, T c) : x(std::move(a)), y(std::move(b)), z(std::move(c)) {}
    template <class S> explicit Vec3(const Vec3<S>& o) : x(o.x), y(o.y), z(o.z) {}
    T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};

struct Vec2 {
    double x = 0, y = 0;
};

template <class A, class B> auto operator+(const Vec3<A>& a, const Vec3<B>& b) { return Vec3<decltype(a.x + b.x)>{a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class A, class B> auto operator-(const Vec3<A>& a, const Vec3<B>& b) { return Vec3<decltype(a.x - b.x)>{a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class A> Vec3<A> operator-(const Vec3<A>& a) { return {-a.x, -a.y, -a.z}; }
template <class S, class B> auto operator*(const S& s, const Vec3<B>& b) { return Vec3<decltype(s * b.x)>{s * b.x, s * b.y, s * b.z}; }
template <class A, class S> auto operator/(const Vec3<A>& a, const S& s) { return Vec3<decltype(a.x / s)>{a.x / s, a.y / s, a.z / s}; }
template <class A, class B> Vec3<A>& operator+=(Vec3<A>& a, const Vec3<B>& b) { return a = a + b; }
template <class A, class B> auto dot(const Vec3<A>& a, const Vec3<B>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class A, class B> auto cross(const Vec3<A>& a, const Vec3<B>& b) {
    return Vec3<decltype(a.x * b.x)>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

using Point = Vec3<double>;

inline double length(const Point& a) { return std::sqrt(dot(a, a)); }
inline double distance(const Point& a, const Point& b) { return length(a - b); }
inline Point normalized(const Point& a) { return a / length(a); }
/// The angle between two directions of any length, 0 to 180.
inline double degrees_between(const Point& a, const Point& b) { return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi; }
inline bool finite(const Point& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
inline bool operator==(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

}  // namespace isoparm
