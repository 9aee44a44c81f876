#include "patches/tensor_bezier_points.h"

#include <algorithm>
#include <cmath>

#include "batch/isa_loops.h"

namespace isoparm {
namespace {

#define ISOPARM_LOOPS "patches/tensor_bezier_loops.inc"
#include "batch/isa_copies.inc"

}  // namespace

void bezier_points(Isa isa, const BezierCoefficients& cell, std::size_t n, const double* u, const double* v, Point* out) {
#ifdef ISOPARM_ISA_LOOPS
    if (isa == Isa::avx512) return avx512::points(cell, n, u, v, out);
    if (isa == Isa::avx2) return avx2::points(cell, n, u, v, out);
#endif
    static_cast<void>(isa);
    baseline::points(cell, n, u, v, out);
}

}  // namespace isoparm
