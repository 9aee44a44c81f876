#include "triangle_lanes.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "isa_loops.h"
#include "quiet.h"
#include "scalar/safe.h"

#ifdef ISOPARM_ISA_LOOPS
#include <immintrin.h>
#endif

namespace isoparm {
namespace {

constexpr double kBinomial[6][6] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}, {1, 5, 10, 10, 5, 1}};

namespace baseline {
#define ISOPARM_LANES 2
typedef double Two __attribute__((vector_size(16)));
inline Two square_root(Two x) { return Two{std::sqrt(x[0]), std::sqrt(x[1])}; }
#include "triangle_lanes_loops.inc"
#undef ISOPARM_LANES
}  // namespace baseline

#ifdef ISOPARM_ISA_LOOPS
ISOPARM_BEGIN_AVX2
namespace avx2 {
#define ISOPARM_LANES 4
inline __m256d square_root(__m256d x) { return _mm256_sqrt_pd(x); }
#include "triangle_lanes_loops.inc"
#undef ISOPARM_LANES
}  // namespace avx2
ISOPARM_END_ISA

ISOPARM_BEGIN_AVX512
namespace avx512 {
#define ISOPARM_LANES 8
inline __m512d square_root(__m512d x) { return _mm512_mask_sqrt_pd(x, 0xff, x); }
#include "triangle_lanes_loops.inc"
#undef ISOPARM_LANES
}  // namespace avx512
ISOPARM_END_ISA
#endif

}  // namespace

void bound_lanes(Isa isa, const PolynomialCell& cell, const TriangleLanes& triangles, int n, const LanesAsked& asked, TriangleBound* bounds) {
    const PolynomialForm form = cell.form();
#ifdef ISOPARM_ISA_LOOPS
    if (isa == Isa::avx512) return avx512::bound_lanes(form, triangles, n, asked, bounds);
    if (isa == Isa::avx2) return avx2::bound_lanes(form, triangles, n, asked, bounds);
#endif
    static_cast<void>(isa);
    baseline::bound_lanes(form, triangles, n, asked, bounds);
}

void bound_lanes(const PolynomialCell& cell, const TriangleLanes& triangles, int n, const LanesAsked& asked, TriangleBound* bounds) {
    static const Isa isa = chosen_isa();
    bound_lanes(isa, cell, triangles, n, asked, bounds);
}

}  // namespace isoparm
