#include "light/shade_kernel.h"

#include <cstdint>

#include "batch/isa_loops.h"

namespace isoparm {
namespace {

constexpr double kGloss = 0.24, kRim = 0.30;

#define ISOPARM_LOOPS "light/shade_loops.inc"
#include "batch/isa_copies.inc"

}  // namespace

const ShadeKernel& shade_kernel(Isa isa) {
#ifdef ISOPARM_ISA_LOOPS
    if (isa == Isa::avx512) return avx512::kernel;
    if (isa == Isa::avx2) return avx2::kernel;
#endif
    static_cast<void>(isa);
    return baseline::kernel;
}

}  // namespace isoparm
