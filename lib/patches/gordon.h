// patches/gordon.h -- Gordon surface over a network of curves: g1 + g2 - g12 (Gordon 1969; Farin 2002, 22.8; formula sheet A7).
#pragma once
#include <vector>

#include "patch.h"
#include "patches/boolean_sum.h"

namespace isoparm {
struct GordonNetwork {
    std::vector<Curve> u_curves;  // x(u, v_nodes[j])
    std::vector<double> v_nodes;  // growing, two at least
    std::vector<Curve> v_curves;  // x(u_nodes[i], v)
    std::vector<double> u_nodes;
    double tolerance = 0;  // gaps at crossings up to this are taken; the surface then passes midway, and misses the curves nearby
};
/// lagrange: polynomial blends through all nodes; hermite: C1 hats, so that a curve acts between its neighbours only.
enum class GordonBlend { lagrange, hermite };
/// The curves of a family as the surface runs them: over the domain that they share when it holds the nodes, else from the first
/// node to the last.
std::vector<Curve> run_over_nodes(const std::vector<Curve>& curves, const std::vector<double>& nodes);

/// Over the domain of the curves so run; with hats, which end with the nodes, over [first node, last node].
/// Throws IncompatibleError where u_curves[j](u_nodes[i]) and v_curves[i](v_nodes[j]) differ (by more than the tolerance), Error(input) for other faults.
Patch make_gordon(const GordonNetwork& network, GordonBlend blend = GordonBlend::lagrange, Part part = Part::sum);
}
