// by_hand_batch.h -- positions and first derivatives of one bicubic patch, in loops written for each instruction set.
#pragma once
#include <cstddef>

#include "batch.h"

namespace isoparm::bench {

/// c[axis][i][j] belongs to u^i v^j; x[3 d + axis] gets coordinate `axis` of the position (d = 0), d/du (1) and d/dv (2).
struct HandBicubic {
    double c[3][4][4];
};
/// For avx2 and avx512, which this machine must run. n is a multiple of 8.
void frames(Isa isa, const HandBicubic& s, std::size_t n, const double* u, const double* v, double* const (&x)[9]);

}  // namespace isoparm::bench
