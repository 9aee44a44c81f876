// scalar/pack.h -- eight doubles side by side. Each lane computes bit for bit what a double would.
#pragma once
#include <cmath>

namespace isoparm {

struct Pack {
    static constexpr int lanes = 8;
    typedef double Lanes __attribute__((vector_size(lanes * sizeof(double))));
    Lanes v{};

    Pack() = default;
    Pack(double x) : v(x - Lanes{}) {}  // NOLINT: a number fills all lanes
    explicit Pack(const Lanes& l) : v(l) {}
    static Pack load(const double* x) {
        Pack p;
        for (int i = 0; i < lanes; ++i) p.v[i] = x[i];
        return p;
    }
    double operator[](int i) const { return v[i]; }
    void set(int i, double x) { v[i] = x; }
};

inline Pack operator-(const Pack& a) { return Pack(-a.v); }
inline Pack operator+(const Pack& a, const Pack& b) { return Pack(a.v + b.v); }
inline Pack operator-(const Pack& a, const Pack& b) { return Pack(a.v - b.v); }
inline Pack operator*(const Pack& a, const Pack& b) { return Pack(a.v * b.v); }
inline Pack operator/(const Pack& a, const Pack& b) { return Pack(a.v / b.v); }
inline Pack& operator+=(Pack& a, const Pack& b) { return a = a + b; }
inline Pack& operator-=(Pack& a, const Pack& b) { return a = a - b; }
inline Pack& operator*=(Pack& a, const Pack& b) { return a = a * b; }

template <class F> Pack each_lane(const Pack& a, F f) {
    Pack r;
    for (int i = 0; i < Pack::lanes; ++i) r.v[i] = f(a.v[i]);
    return r;
}
inline Pack sqrt(const Pack& a) {
    return each_lane(a, [](double x) { return std::sqrt(x); });
}

}  // namespace isoparm
