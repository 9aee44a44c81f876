// patches/lagrange.h -- Lagrange surface: sum_i L_i(v) r_i(u) through a skeleton of curves (Golovanov 2002; seed 003; formula
// sheet A1).
#pragma once
#include <vector>

#include "patch.h"

namespace isoparm {
/// curves[i] = x(u, nodes[i]); two at least, nodes that grow. Over the curves' own domain in u (all over that of the first), [nodes.front(),
/// nodes.back()] in v. Throws Error(input).
Patch make_lagrange(const std::vector<Curve>& curves, const std::vector<double>& nodes);
}
