// study_methods.h -- the methods that a study compares, one file each. To add one: a file with its make_..., a line here, and a row in
// study_methods.cpp.
#pragma once
#include "meshes/leaf_mesh.h"
#include "study.h"

namespace isoparm {

StudyMesh make_uniform(const StudyInput& input);     // study_uniform.cpp
StudyMesh make_quadtree(const StudyInput& input);    // study_quadtree.cpp
StudyMesh make_fast(const StudyInput& input);        // study_tessellate.cpp
StudyMesh make_parametric(const StudyInput& input);  // study_tessellate.cpp
StudyMesh make_optimal(const StudyInput& input);     // study_tessellate.cpp

/// "the tolerance ... was not reached: about ... triangles would be needed, the budget is ...".
[[noreturn]] void not_reached(const StudyInput& input, double needed);

/// The edges that the patches of the surface share, for methods that build their meshes of leaves.
Topology shared_edges(const StudyInput& input);
/// Counts what has to hold for the mesh to be watertight; throws std::logic_error when it has T-junctions.
StudyMesh checked(LeafMesh&& made, const MeshProof& proof);
/// Is no edge of the mesh an edge of more than two triangles? Coarse meshes of closed surfaces may touch themselves.
bool manifold(const LeafMesh& mesh);

}  // namespace isoparm
