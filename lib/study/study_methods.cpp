#include "study/study_methods.h"

#include <sstream>
#include <stdexcept>

#include "error.h"
#include "tessellate.h"

namespace isoparm {

const std::vector<StudyMethod>& study_methods() {
    static const std::vector<StudyMethod> methods = {
        {"uniform",
         "every patch on one n x n grid (each cell between its breaks), with the smallest n whose certified error is below the tolerance",
         make_uniform},
        {"quadtree",
         "a quadtree on each patch, refined where the certificate fails; leaves beside each other, across shared edges too, differ by one "
         "level at most",
         make_quadtree},
        {"fast",
         "isoparm tessellate: rows of vertices as dense as the tolerance needs, then edges bisected; certified by the geometric distance",
         make_fast},
        {"parametric", "the same, refined until the distance at equal parameters is below the tolerance", make_parametric},
        {"optimal", "as fast, then vertices moved and removed and edges flipped as long as the certificate keeps the tolerance", make_optimal, true},
    };
    return methods;
}

void not_reached(const StudyInput& input, double needed) {
    std::ostringstream text;
    text.precision(3);
    text << "the tolerance " << to_text(input.tolerance) << " was not reached: about " << needed
         << " triangles would be needed, the budget is " << input.max_triangles;
    throw Error(ErrorKind::budget, text.str());
}

Topology shared_edges(const StudyInput& input) {
    return find_topology(input.surface, join_tolerance(input.tolerance, bounding_box(input.surface).diagonal()));
}

bool manifold(const LeafMesh& mesh) { return analyse(mesh.mesh, mesh.open_edges).non_manifold_edges == 0; }

StudyMesh checked(LeafMesh&& made, const MeshProof& proof) {
    StudyMesh result;
    result.topology = analyse(made.mesh, made.open_edges);
    if (result.topology.t_junctions > 0)
        throw std::logic_error("a mesh of leaves has " + std::to_string(result.topology.t_junctions) +
                               " T-junctions: please report this scene");
    result.mesh = std::move(made.mesh);
    result.certified_error = proof.geometric;
    result.certified_parametric = proof.parametric;
    return result;
}

}  // namespace isoparm
