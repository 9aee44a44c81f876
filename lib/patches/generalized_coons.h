// patches/generalized_coons.h -- generalised Coons surface: any functionals L_i with blends H_k, L_i(H_k) = delta_ik (Malozemov,
// Sergeev, Chashnikov 2007, (9); Farin 2002, 22.8; formula sheet A6).
#pragma once
#include <vector>

#include "patch.h"
#include "patches/boolean_sum.h"

namespace isoparm {
/// g -> g(at), or g -> g'(at).
struct Functional {
    enum class Kind { value, derivative } kind = Kind::value;
    double at = 0;
};
struct GeneralizedCoons {
    std::vector<Functional> u, v;       // L^u_i, L^v_j
    std::vector<Function> blend_u, blend_v;  // H^u_i, H^v_j
    std::vector<Curve> f;               // f[i](v) = L^u_i of the surface
    std::vector<Curve> g;               // g[j](u) = L^v_j of the surface
};
/// Over the domain of the curves g (in u) and f (in v). Throws IncompatibleError for L_i(H_k) != delta_ik, for
/// L^u_i(g_j) != L^v_j(f_i), and when the value blends of neither direction sum to 1 (the surface would not move with its data).
Patch make_generalized_coons(const GeneralizedCoons& data, Part part = Part::sum);
}
