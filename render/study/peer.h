// peer.h -- another tessellator to compare with: OpenCASCADE's BRepMesh, where its module was built.
#pragma once
#include <memory>
#include <string>

#include "composite.h"
#include "mesh.h"
#include "study.h"

namespace isoparm {

/// Is the module isoparm_opencascade.so there? It is loaded only when a Peer is made.
bool has_peer();

/// The surface as OpenCASCADE has it: its Bezier cells, sewn along edges that coincide.
class Peer {
public:
    /// Throws Error(budget) when OpenCASCADE has no such surface, or refuses it; Error(io) when the module cannot be loaded.
    explicit Peer(const Composite& surface);

    /// BRepMesh_IncrementalMesh with this linear deflection (scene units) and angular deflection (radians; its default), one thread.
    void mesh(double deflection, double angle = 0.5);
    /// What mesh() left: a part for each cell, whose corners have parameters of the patch. Nothing is proved about it.
    StudyMesh result() const;
    /// Of OpenCASCADE, as "7.6.3".
    static std::string version();

private:
    struct Impl;
    std::shared_ptr<Impl> impl_;
};

/// The row of a study: "opencascade".
extern const StudyMethod peer_study_method;

/// Those of the library and, where it is there, the peer.
const std::vector<StudyMethod>& all_study_methods();
/// nullptr when there is none of that name.
const StudyMethod* find_any_study_method(const std::string& name);

}  // namespace isoparm
