// patches/network.h -- composite Coons surface over a network of curves, C1 over [0,m] x [0,n] (seed 002 section 4, seed
// 003 (6.24), (6.25); formula sheet A8, A12).
#pragma once
#include <vector>

#include "patches/coons_hermite.h"
#include "patches/tensor_bezier.h"

namespace isoparm {
struct Network {
    std::vector<Curve> a;  // a[i] = x(i,v), i = 0..m; each is run over [0,n]
    std::vector<Curve> b;  // b[j] = x(u,j), j = 0..n; each is run over [0,m]
};
/// Cross derivatives x_u(i,v) and x_v(u,j), run over [0,n] and [0,m].
struct CrossDerivatives {
    std::vector<Curve> A, B;
};
/// By the differences (6.25).
CrossDerivatives finite_differences(const Network& network);
/// C1 cubics with A_i(j) = b_j'(i), B_j(i) = a_i'(j) and the twists A_i'(j) = B_j'(i) = d[i][j] (seed 002 section 4).
CrossDerivatives from_twists(const Network& network, const Grid<Point>& d);

/// Throws IncompatibleError when a[i](j) and b[j](i) differ, and for cross derivatives that have corners or contradict the tangents of
/// the curves (finite differences may: they give the corner data, and the curves are still interpolated); Error(input) when there are
/// fewer than two curves of a kind or lists of different length.
Patch make_network(const Network& network, Twist twist = Twist::average, Part part = Part::sum);
Patch make_network(const Network& network, const CrossDerivatives& cross, Twist twist = Twist::average, Part part = Part::sum);
}
