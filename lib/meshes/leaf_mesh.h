// leaf_mesh.h -- crack-free meshes from leaves: the cells of a grid, or of a quadtree, that tile the domain of each patch.
//
// Leaves have corners on a lattice of integers. A vertex that one leaf has on a side of another becomes a vertex of that one too,
// inside a patch and across edges that patches share, so there are no T-junctions whatever the leaves are.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "mesh.h"
#include "topology.h"

namespace isoparm {

struct LatticePoint {
    std::uint32_t i = 0, j = 0;
    std::uint64_t key() const { return (std::uint64_t(i) << 32) | j; }
};
/// Of keys: points of a lattice have many zeros in common (Fibonacci hashing, the high half mixed in).
struct LatticeHash {
    std::size_t operator()(std::uint64_t key) const {
        key *= 0x9e3779b97f4a7c15u;
        return key ^ (key >> 32);
    }
};
inline LatticePoint middle(const LatticePoint& a, const LatticePoint& b) { return {(a.i + b.i) / 2, (a.j + b.j) / 2}; }

/// A rectangle of the domain, or a triangle of the triangular one; corners counter-clockwise.
struct Leaf {
    std::array<LatticePoint, 4> corner{};
    int sides = 4;
};

/// The leaves of one patch, and where lattice points lie: `steps` of them across each cell between breaks.
struct Leaves {
    std::vector<double> us, vs;  // breaks and ends of the domain
    std::uint32_t steps = 1;
    std::vector<Leaf> list;

    /// Cells of steps x steps, one leaf each; of the triangular domain one.
    Leaves(const Patch& patch, std::uint32_t steps);
    Vec2 at(const LatticePoint& p) const;
    /// Is the point on edge k of the domain? (as Patch::edge_point counts them)
    bool on_edge(const Patch& patch, int k, const LatticePoint& p) const;
};

struct LeafMesh {
    Mesh mesh;                                             // not proved yet: certified_error is 0
    std::vector<std::array<std::uint32_t, 2>> open_edges;  // as analyse() wants them
    std::vector<std::vector<std::uint32_t>> leaf;          // of each triangle of each part, those left out last
};

/// Rectangles are cut along the diagonal that is nearer to the surface at its middle; leaves with further vertices on their sides
/// into a fan from one of these, or from their middle where there are many. Leaves must tile their domain, and a side of one either is
/// a side of another, or the smaller one arose from halving the larger. Vertices on shared edges are all that either patch asks for.
LeafMesh mesh_of(const Composite& surface, const Topology& topology, const std::vector<Leaves>& leaves);

/// How two patches that share a rim cut it: pieces [f0,f1] of the rim, by leaf.
struct RimPiece {
    double f0, f1;
    std::uint32_t leaf;
};
/// Of use `use` of rim `rim`, in growing order.
std::vector<RimPiece> rim_pieces(const Composite& surface, const Topology& topology, const Leaves& leaves, std::uint32_t rim, int use);

}  // namespace isoparm
