// continuity_joints.h -- the joints of a composite, not measured yet.
#pragma once
#include "continuity.h"

namespace isoparm {

/// Edges run in step over this part of both.
struct JointPart {
    double a0, a1, b0, b1;
};
struct FoundJoint {
    Joint joint;  // without jumps
    std::vector<JointPart> parts;
};
struct FoundJoints {
    std::vector<FoundJoint> joints;
    std::vector<Pole> poles;
    std::vector<Joint::Side> open;
};
FoundJoints find_joints(const Composite& surface, const ContinuityOptions& options);

}  // namespace isoparm
