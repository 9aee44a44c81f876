// by_hand.h -- the loops one would write for these very surfaces and nothing else: cubic curves with fixed arrays, no
// virtual calls, no allocation, derivatives worked out on paper. What isoparm's evaluation is measured against.
#pragma once
#include <array>
#include <cstddef>

#include "scalar/vec.h"

namespace isoparm::bench {

/// S, S_u, S_v, S_uu, S_uv, S_vv.
using Derivatives = std::array<Point, 6>;

using Cubic = std::array<Point, 4>;  // Bezier points

struct HandBezier {
    std::array<Cubic, 4> p;  // p[i][j], i along u
};

/// sum_i h_i(u) f_i(v) + sum_j h_j(v) g_j(u) - sum_ij h_i(u) h_j(v) m_ij, h the n = 2 linear or n = 4 cubic Hermite
/// blends; all curves cubic.
template <int n> struct HandCoons {
    std::array<Cubic, n> f, g;
    std::array<std::array<Point, n>, n> m;
};

Point point(const HandBezier& s, double u, double v);
Derivatives derivatives(const HandBezier& s, double u, double v);
/// One point after the other.
void points(const HandBezier& s, std::size_t n, const double* u, const double* v, Point* out);
/// Eight points side by side, in loops that the compiler turns into vector instructions.
void points_side_by_side(const HandBezier& s, std::size_t n, const double* u, const double* v, Point* out);

template <int n> Point point(const HandCoons<n>& s, double u, double v);
template <int n> Derivatives derivatives(const HandCoons<n>& s, double u, double v);
template <int n> void points(const HandCoons<n>& s, std::size_t count, const double* u, const double* v, Point* out);
template <int n>
void points_side_by_side(const HandCoons<n>& s, std::size_t count, const double* u, const double* v, Point* out);

}  // namespace isoparm::bench
