#include "rays/exact_kernel.h"

#include <algorithm>
#include <limits>

#include "batch/isa_loops.h"

namespace isoparm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRegular = 0.9;     // of |I - Y J|, which must be below 1: far enough from it for rounding not to matter
constexpr double kEdgeOn = 1e-9;     // det / (|a| |b|) below which rounding would count
constexpr double kRounding = 1e-14;  // relative: far above that of a few operations in double

#define ISOPARM_LOOPS "rays/exact_loops.inc"
#include "batch/isa_copies.inc"

}  // namespace

const ExactKernel& exact_kernel(Isa isa) {
#ifdef ISOPARM_ISA_LOOPS
    if (isa == Isa::avx512) return avx512::kernel;
    if (isa == Isa::avx2) return avx2::kernel;
#endif
    static_cast<void>(isa);
    return baseline::kernel;
}

RayPlanes RayPacket::at(int lane) const {
    const auto vector = [&](const double (*x)[lanes]) { return Point{x[0][lane], x[1][lane], x[2][lane]}; };
    return {vector(origin), vector(direction), vector(n1), vector(n2)};
}
void RayPacket::put(int lane, const RayPlanes& ray) {
    for (int k = 0; k < 3; ++k)
        origin[k][lane] = ray.origin[k], direction[k][lane] = ray.direction[k], n1[k][lane] = ray.n1[k], n2[k][lane] = ray.n2[k];
}

void CertainPacket::put(int lane, const LeafMap& l) {
    const double of[numbers] = {l.u, l.v, l.hu, l.hv, l.a.x, l.a.y, l.a.z, l.b.x, l.b.y, l.b.z, l.size_a + l.turn_u, l.size_b + l.turn_v, l.turn_u, l.turn_v,
                                l.uu, l.uv, l.vv, l.size_s + l.size_a + l.size_b + l.bend};
    for (int k = 0; k < numbers; ++k) leaf[k][lane] = of[k];
}

void CertainPacket::set_off(const FrameError& of) {
    std::fill_n(off[of_s], RayPacket::lanes, of.position), std::fill_n(off[of_su], RayPacket::lanes, of.du), std::fill_n(off[of_sv], RayPacket::lanes, of.dv);
}

}  // namespace isoparm
