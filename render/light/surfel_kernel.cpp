#include "light/surfel_kernel.h"

#include <cfloat>

#include "batch/isa_loops.h"

namespace isoparm {
namespace {

#define ISOPARM_LOOPS "light/surfel_loops.inc"
#include "batch/isa_copies.inc"

}  // namespace

const SurfelKernel& surfel_kernel(Isa isa) {
#ifdef ISOPARM_ISA_LOOPS
    if (isa == Isa::avx512) return avx512::kernel;
    if (isa == Isa::avx2) return avx2::kernel;
#endif
    static_cast<void>(isa);
    return baseline::kernel;
}

}  // namespace isoparm
