// mesh_error.h -- what is proved, and what is seen, about every triangle of a mesh whose vertices know their parameters.
//
// The same certificate for every mesh, whoever made it: the theorem of docs/certificates.md, as Refinement applies it.
#pragma once
#include <memory>
#include <optional>

#include "bounds/bound_cell.h"
#include "composite.h"
#include "mesh.h"

namespace isoparm {

/// By part of the mesh and triangle, those that are left out last.
using TriangleNumbers = std::vector<std::vector<double>>;

struct MeshProof {
    TriangleNumbers bound;  // geometric: the distance of the two sets, both ways; infinite where nothing could be proved
    /// Of each triangle, which one should be smaller to make its bound so: itself or a neighbour.
    std::vector<std::vector<std::uint32_t>> to_split;
    double geometric = 0, parametric = 0;  // the largest; the second one of |S - L| at equal parameters
};

class MeshProver {
public:
    explicit MeshProver(const Composite& surface);
    /// Bounds are as sharp as it takes to tell whether they are below `tolerance`. Triangles have to lie between breaks of their
    /// patch; one that does not, and one that is left out and is no edge of another triangle, has no bound. `only_below`: nothing
    /// when some triangle alone is above the tolerance. Does not depend on the number of threads. One call at a time.
    std::optional<MeshProof> operator()(const Mesh& mesh, double tolerance, bool only_below = false) const;

private:
    struct Cells {
        std::vector<double> us, vs;
        std::vector<std::unique_ptr<BoundCell>> cells;
        const BoundCell* around(const std::array<Vec2, 3>& corners) const;
    };
    struct PartProof;
    PartProof bound(const Mesh& mesh, const MeshPart& part, double tolerance, bool only_below) const;

    const Composite& surface_;
    std::vector<Cells> cells_;  // by patch
};

/// The largest distance seen from points of the surface over each triangle to that triangle or a neighbour of it in the same part; 0 for
/// those left out.
TriangleNumbers sampled_errors(const Composite& surface, const Mesh& mesh);

/// Of each triangle the one in the same part on the other side of its edge k (corners k, k + 1); UINT32_MAX where there is none.
std::vector<std::array<std::uint32_t, 3>> neighbours_in(const MeshPart& part);

}  // namespace isoparm
