#include "tessellation/optimize_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "batch/isa_loops.h"
#include "bounds/quiet.h"
#include "scalar/safe.h"

namespace isoparm {
namespace {

constexpr double kBinomial[6][6] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}, {1, 5, 10, 10, 5, 1}};

#define ISOPARM_LOOPS "tessellation/optimize_estimate_loops.inc"
#include "batch/isa_copies.inc"

}  // namespace

double Estimate::beyond(int k, const Estimate* other) const {
    if (other && other->quiet) {
        const Point d = unit - other->unit;
        const double square = dot(d, d), cosine = 1 - 0.5 * square;
        if (cosine >= 0.95) return (beside[k] + across[k] * std::sqrt(square)) / cosine;
    }
    return std::sqrt(beside[k] * beside[k] + across[k] * across[k]);
}

double Estimate::with(const std::array<const Estimate*, 3>& neighbours) const {
    return quiet ? std::max({normal, beyond(0, neighbours[0]), beyond(1, neighbours[1]), beyond(2, neighbours[2])}) : parametric;
}

void EstimateLanes::set(std::size_t lane, const SecondDerivatives& model, const Places& places) {
    const auto put = [lane](double(&to)[3][size], const Point& p) { to[0][lane] = p.x, to[1][lane] = p.y, to[2][lane] = p.z; };
    for (std::size_t k = 0; k < 3; ++k) u[k][lane] = places.uv[k].x, v[k][lane] = places.uv[k].y, put(x[k], places.x[k]);
    slack[lane] = places.slack;
    model_u[lane] = model.u, model_v[lane] = model.v;
    for (std::size_t k = 0; k < 3; ++k) put(h[k], model.h[k]);
    for (std::size_t k = 0; k < 4; ++k) put(t[k], model.t[k]), t_least[k][lane] = model.t_size[k] - model.t_rad[k];
}

void estimate_lanes(Isa isa, const EstimateLanes& lanes, int n, double tolerance, Estimate* estimates) {
#ifdef ISOPARM_ISA_LOOPS
    if (isa == Isa::avx512) return avx512::estimate_lanes(lanes, n, tolerance, estimates);
    if (isa == Isa::avx2) return avx2::estimate_lanes(lanes, n, tolerance, estimates);
#endif
    static_cast<void>(isa);
    baseline::estimate_lanes(lanes, n, tolerance, estimates);
}

void estimate_lanes(const EstimateLanes& lanes, int n, double tolerance, Estimate* estimates) {
    static const Isa isa = chosen_isa();
    estimate_lanes(isa, lanes, n, tolerance, estimates);
}

}  // namespace isoparm
