// topology.h -- which edges of the patches of a composite coincide, found by geometry.
//
// An edge is cut at the corners and breaks that lie on it, its own and those of other patches; a piece between two such
// nodes is a rim. Rims that coincide, in the same or in the opposite direction, in the same parametrisation or not, are
// one rim with two uses; where more patches meet, they are paired, each pair with a rim of its own, so that the mesh is a
// manifold. A collapsed rim is one point (a pole or apex).
#pragma once
#include <cstdint>
#include <vector>

#include "composite.h"

namespace isoparm {

/// A rim as one patch sees it: edge `edge` of member `member` from t0 (at the rim's node a) to t1 (at b), t in [0,1].
struct RimUse {
    std::uint32_t member = 0;
    int edge = 0;
    double t0 = 0, t1 = 1;
    bool affine = true;  // same parametrisation as the first use, up to an affine map; else points are projected
};
struct Rim {
    std::uint32_t a = 0, b = 0;  // nodes
    bool collapsed = false;
    std::vector<RimUse> uses;    // one or two; uses[0] owns the curve: vertices are evaluated by it
    std::uint32_t beside = UINT32_MAX;  // of the last of an odd number of sheets that touch: the rim of the first pair there
};
/// One rim along an edge of a patch, in the edge's own direction.
struct EdgeRim {
    std::uint32_t rim = 0, use = 0;
    bool reversed = false;  // the edge runs from the rim's b to its a
    double t0 = 0, t1 = 1;  // the piece of the edge, t0 < t1
};
struct Topology {
    std::vector<Point> nodes;
    std::vector<Rim> rims;
    std::vector<std::array<std::vector<EdgeRim>, 4>> edges;  // [member][edge], in the direction of the edge
    std::vector<char> flipped;  // per member: triangles must wind against S_u x S_v so that neighbours agree
};

/// Nodes nearer than `tolerance` are one. Deterministic: the first patch in order owns what it shares.
Topology find_topology(const Composite& surface, double tolerance);

/// Parameter t in [low, high] of the point of the edge nearest to `target`.
double nearest_on_edge(const Patch& patch, int edge, const Point& target, double low, double high);

}  // namespace isoparm
