// continuity.h -- how the patches of a composite join: which edges meet, and to what order, proved along the whole edge.
//
// docs/continuity.md tells what is measured and why the bounds are bounds.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "composite.h"
#include "joints/edge_jump.h"

namespace isoparm {

struct ContinuityOptions {
    double tolerance = 0;              // of position and derivatives, scene units; above 0
    double angle = 1e-6;               // of normals, degrees
    double curvature = 0;              // 1 / scene units; above 0
    double size = 0;                   // the bounding-box diagonal
    double capture = 0;                // edges of one surface that stay nearer than this, and do not meet, are a joint with a gap; 0: none
    std::vector<std::string> surface;  // that each member belongs to, one a member; empty: all to one
    int max_halvings = 4000;            // see JumpLimits
};

struct Joint {
    /// shared: whole edges; seam: two edges of one patch; t_joint: an edge, or a part, meets a part of another; gap: edges that are near each
    /// other and do not meet; line: two cells of one patch.
    enum class Kind { shared, seam, t_joint, gap, line } kind = Kind::shared;
    struct Side {
        std::uint32_t member = 0;
        int edge = 0;          // of the patch; Kind::line: 0 for u = value, 1 for v = value
        double t0 = 0, t1 = 1; // the part of the edge; where b runs against a, t0 > t1
        double value = 0;      // Kind::line
    } a, b;
    /// Both run along the edge in the same parametrisation, up to an affine map. If not, each point of a is measured against the nearest one of b,
    /// and derivatives (which are those of different parametrisations) count for no order.
    bool affine = true;
    std::array<JumpBound, kMeasures> jumps;
};
/// An edge that is one point.
struct Pole {
    std::uint32_t member = 0;
    int edge = 0;
    Point at;
};
struct Continuity {
    std::vector<Joint> joints, lines;  // in the order of the members; lines between the cells of a patch
    std::vector<Pole> poles;
    std::vector<Joint::Side> open;     // edges, or parts of edges, without a neighbour
};
/// Safe to call from every thread; the result does not depend on their number.
Continuity find_continuity(const Composite& surface, const ContinuityOptions& options);

/// What the bounds of a joint prove.
struct JointOrder {
    /// The strongest of C2, C1, G2, G1, C0 that is proved; "not joined" where a gap is; "undecided" where not even that is known.
    std::string text;
    std::string geometric;               // G2, G1, or empty: of tangent planes and curvatures alone
    std::string inside;                  // the order (and the geometric one) but for singular ends of the edge, where that says more; else empty
    std::vector<std::string> undecided;  // orders that would be stronger, neither proved nor disproved
};
JointOrder order_of(const Joint& joint, const ContinuityOptions& options);

/// "d1", "u = 2": as a user knows it.
std::string edge_text(const Composite& surface, const Joint& joint, const Joint::Side& side);

}  // namespace isoparm
