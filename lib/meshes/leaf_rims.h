// leaf_rims.h -- where leaves put vertices on the rims that patches share; internal to leaf_mesh.cpp.
#pragma once
#include "meshes/leaf_mesh.h"

namespace isoparm {

/// One vertex on a rim, and its parameter on the edge of each use.
struct RimVertex {
    double f = 0;
    std::array<double, 2> t{};
    std::array<bool, 2> lattice{};  // is it a lattice point of the use's patch?
    std::uint32_t vertex = 0;
};

/// Position on a patch's edge.
Point on_edge(const Composite& surface, const RimUse& use, double t);

class Rims {
public:
    Rims(const Composite& surface, const Topology& topology, const std::vector<Leaves>& leaves);

    /// The vertices of a rim, its two ends included, f growing; `vertex` is not set.
    std::vector<RimVertex> cut(std::uint32_t rim) const;

private:
    RimVertex end_of(const Rim& rim, int end) const;
    /// Requests of a use strictly between its ends, in the direction of the rim.
    std::vector<double> inside(const RimUse& use) const;
    /// What use u asks for at t, seen by both.
    RimVertex both(const Rim& rim, int u, double t) const;

    const Composite& surface_;
    const Topology& topology_;
    std::vector<std::array<std::vector<double>, 4>> asked_;  // [member][edge]: parameters of corners of leaves, growing
};

}  // namespace isoparm
