// optimize_rims.h -- all patches of a composite while optimize() changes them, and the rims between them; internal to optimize*.cpp.
#pragma once
#include "tessellation/optimize_patch.h"

namespace isoparm {

/// A vertex on a rim, which is a corner of the patch of each use.
struct RimPoint {
    std::uint32_t rim = 0, vertex = 0;
    double f = 0;                                        // of the rim
    Point x;
    std::array<std::uint32_t, 2> corner{kNone, kNone};   // by use
    std::uint32_t before = kNone, after = kNone;         // on the rim; kNone: an end, which stays
    bool live = true;
};

class FreeComposite {
public:
    FreeComposite(const Refinement& refinement, const Composite& surface, const Topology& topology, double tolerance, Measure measure);
    /// The triangulation as it is now becomes that of the refinement.
    void write(Refinement& refinement) const;

    std::vector<FreePatch>& patches() { return patches_; }
    const std::vector<FreePatch>& patches() const { return patches_; }
    std::vector<RimPoint>& rim_points() { return points_; }
    const Rim& rim_of(const RimPoint& p) const { return topology_.rims[p.rim]; }
    /// Where a point would be at another place of its rim: in space, and in the parameters of each use.
    void place(const RimPoint& p, double f, Point& x, std::array<Vec2, 2>& uv) const;
    std::size_t count() const;

private:
    PatchMesh mesh_of(std::size_t member, std::vector<RimNode>& nodes, const std::vector<std::uint32_t>& node_of) const;

    const Refinement& refinement_;
    const Composite& surface_;
    const Topology& topology_;
    std::vector<FreePatch> patches_;
    std::vector<RimPoint> points_;
};

}  // namespace isoparm
