// batch_kernel.h -- the loops of batch.h, compiled for several instruction sets.
#pragma once
#include <cstddef>

#include "batch.h"

namespace isoparm {

/// Frames of n points of one cell: out[3 d + axis][k], d = 0 position, 1 d/du, 2 d/dv. c[((axis * (N+1)) + i) * (N+1) + j] belongs to
/// (u - middle_u)^i (v - middle_v)^j, N the degree in both; axis 3 is the denominator of rational surfaces.
using BatchKernel = void (*)(const double* c, double middle_u, double middle_v, std::size_t n, const double* u, const double* v, double* const* out);

/// For degrees 1, 2, 3, 5, 7; nullptr for others. `row`: all points at v[0], with the same results.
BatchKernel batch_kernel(Isa isa, int degree, bool rational, bool row);

}  // namespace isoparm
