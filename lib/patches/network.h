// patches/network.h -- composite Coons surface over a network of curves, C1 over [0,m] x [0,n] (seed 002 section 4, seed
// 003 (6.24), (6.25); formula sheet A8, A12).
#pragma once
#include <vector>

#include "patches/coons_hermite.h"

namespace isoparm {
struct Network {
    std::vector<Curve> a;  // a[i] = x(i,v), i = 0..m; each is run over [0,n]
    std::vector<Curve> b;  // b[j] = x(u,j), j = 0..n; each is run over [0,m]
};
/// Cross derivatives by finite differences (6.25). Throws IncompatibleError when a[i](j) and b[j](i) differ, Error(input)
/// when there are fewer than two curves of a kind.
Patch make_network(const Network& network, Twist twist = Twist::average);
}
