// patches/cross_data.h -- what a surface promises across the edges of a triangle, and the conditions that it must meet.
#pragma once
#include "patches/triangle_edges.h"

namespace isoparm {

/// The edges, and D_k: the derivative along E_k in the direction of the median, from the middle of the edge to the vertex opposite.
struct CrossData : TriangleEdges {
    std::array<Curve, 3> D, slope;  // slope[k] = E_k'
    /// Throws IncompatibleError when the edges do not close or D_k(0), D_k(1) contradict the tangents of the neighbouring edges;
    /// Error(input) when an edge has a corner (or is no spline and has no bounded second derivatives, which would prove that it has none), or a D_k jumps.
    CrossData(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& cross);
};

/// The edges, and a normal along each.
struct NormalData : TriangleEdges {
    std::array<Curve, 3> N;          // each scaled by one number, to a greatest length of about 1
    std::array<Point, 3> at_vertex;  // unit
    /// Throws IncompatibleError when the edges do not close, when the normals of two edges are not parallel at their common vertex, or when a
    /// normal is not normal to its own edge (at 17 samples) or, at a vertex, to the other one; Error(input) when a normal is not proved
    /// to differ from 0, by 1e-100 of its greatest length, along the whole edge.
    NormalData(const std::array<Curve, 3>& edges, const std::array<Curve, 3>& normals);
};

}  // namespace isoparm
