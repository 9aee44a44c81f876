// network_fit.h -- curves that cross somewhere, turned into a network that crosses at a grid of parameters, as Gordon surfaces need it.
//
// Of every pair of curves the place of closest approach is found (closest_approach.h: sampled, then Newton). The curves are put in the order in
// which they are crossed, and run the same way; each is cut to the part between its first and its last crossing, and that part is run over [0,1]
// by a monotone C1 cubic (curves/composed.h) that takes node i to the curve's crossing with curve i of the other family: the mean of those, over all curves, are the nodes.
// So every curve keeps its shape (its points are the same up to rounding) and only its speed changes. Curves that cross at a grid already keep that too.
#pragma once
#include <string>
#include <vector>

#include "patches/gordon.h"

namespace isoparm {

struct NetworkFit {
    GordonNetwork network;      // over [0,1] x [0,1]; its tolerance is not set
    double gap = 0, size = 0;   // the widest at a crossing (sampled), and the size of the curves that compatibility is relative to
    std::size_t open = 0;       // crossings with a gap beyond compatibility
    std::string where;          // of the widest: "u_curves[1] at 0.2 and v_curves[0] at 0.7, near (1, 2, 3)"
    std::string changes;        // order, directions, cuts and change of speed, for people; empty when there are none
};
/// Every curve of a family must cross every one of the other, in the same order or exactly the reverse. Of two curves that cross a closed one where it
/// begins and ends, the one given first takes its begin. Throws Error(input) otherwise, and for curves that are not piecewise Bezier, or above degree 10.
NetworkFit fit_network(const std::vector<Curve>& u_curves, const std::vector<Curve>& v_curves);

}  // namespace isoparm
