#include "bounds/triangle_lanes.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "batch/isa_loops.h"
#include "bounds/quiet.h"
#include "scalar/safe.h"

namespace isoparm {
namespace {

constexpr double kBinomial[6][6] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}, {1, 5, 10, 10, 5, 1}};

#define ISOPARM_LOOPS "bounds/triangle_lanes_loops.inc"
#include "batch/isa_copies.inc"

}  // namespace

void bound_lanes(Isa isa, const PolynomialCell& cell, std::span<const TriangleLanes> sets, int n, const LanesAsked& asked, TriangleBound* bounds) {
    const PolynomialForm form = cell.form();
#ifdef ISOPARM_ISA_LOOPS
    if (isa == Isa::avx512) return avx512::bound_lanes(form, sets.data(), int(sets.size()), n, asked, bounds);
    if (isa == Isa::avx2) return avx2::bound_lanes(form, sets.data(), int(sets.size()), n, asked, bounds);
#endif
    static_cast<void>(isa);
    baseline::bound_lanes(form, sets.data(), int(sets.size()), n, asked, bounds);
}

void bound_lanes(const PolynomialCell& cell, std::span<const TriangleLanes> sets, int n, const LanesAsked& asked, TriangleBound* bounds) {
    static const Isa isa = chosen_isa();
    bound_lanes(isa, cell, sets, n, asked, bounds);
}

}  // namespace isoparm
