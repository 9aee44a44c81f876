// optimize_patch.h -- the triangulation of one patch while optimize() changes it: corners that move, edges that flip, corners that are
// removed, and all of that taken back; internal to optimize*.cpp.
//
// Triangles know their neighbours instead of edges. Edges on rims have no triangle behind them, edges on breaks stay on them. Triangles
// turn counter-clockwise in the domain before and after every step, so that they cover it once. One thread at a time.
#pragma once
#include <vector>

#include "tessellation/optimize_estimate.h"
#include "tessellation/refine.h"

namespace isoparm {

/// Where a corner may go: nowhere, anywhere between breaks, along a break v = const or u = const, along a rim.
enum class Freedom : char { fixed, inside, along_u, along_v, rim };

/// In tolerances: what a removal may leave at first, for moves and flips to bring down.
inline constexpr float kMostCost = 2.5f;

struct FreeCorner {
    Vec2 uv;
    Point x;
    double slack = 0;                // at least the distance of x from the patch at uv
    std::uint32_t vertex = 0;        // of the mesh
    std::uint32_t triangle = kNone;  // one of those around it; kNone: removed
    std::uint32_t rim_point = kNone;
    Freedom freedom = Freedom::inside;
    float step = 0.2f;               // of its next move, relative to the edges
    float most_cost = kMostCost;     // of a removal that is worth a try
    std::uint32_t settled = 0;       // the time when the least step was tried in vain

    bool live() const { return triangle != kNone; }
    bool on_rim() const { return freedom == Freedom::rim || freedom == Freedom::fixed; }
};

struct FreeTriangle {
    std::array<std::uint32_t, 3> corner{};
    std::array<std::uint32_t, 3> beside{kNone, kNone, kNone};  // behind edge k, from corner k to k+1
    const BoundCell *root = nullptr, *cell = nullptr;          // the cell between breaks, and a small one around
    Estimate own;
    double error = 0;                // estimated with the neighbours, in tolerances
    TriangleBound proof{};
    bool proved = false;             // proof is that of these corners
    bool sharp = false;              // and there is no sharper one
    bool live = true, left_out = false;  // left out: of the mesh, or of a fan, which stays as it is

    int place(std::uint32_t c) const { return corner[0] == c ? 0 : corner[1] == c ? 1 : 2; }
};

/// The triangles around a corner, counter-clockwise, and the corners around: one more of them when it lies on a rim.
struct Ring {
    std::vector<std::uint32_t> triangles, links;
    bool closed = true;
};

class FreePatch {
public:
    FreePatch(const Patch& patch, const PatchMesh& mesh, const std::vector<Point>& positions, double tolerance, Measure measure);

    const Patch& patch() const { return patch_; }
    const std::vector<FreeCorner>& corners() const { return corners_; }
    const std::vector<FreeTriangle>& triangles() const { return triangles_; }
    void set_freedom(std::uint32_t corner, Freedom freedom, std::uint32_t rim_point = kNone) { corners_[corner].freedom = freedom, corners_[corner].rim_point = rim_point; }
    void set_step(std::uint32_t corner, float step) { corners_[corner].step = step; }
    void set_most_cost(std::uint32_t corner, float cost) { corners_[corner].most_cost = cost; }
    std::size_t count() const;

    Ring ring(std::uint32_t corner) const;
    /// Sum of high powers of the errors around a corner; with a place: if the corner were there, infinite when a triangle would turn over.
    double energy(const Ring& ring) const;
    /// And infinite where it is not below the limit, as far as that is known soon.
    double energy_at(const Ring& ring, std::uint32_t corner, const Vec2& uv, const Point& x, double limit) const;
    /// Where the surface is at other parameters of a corner, but for rounding.
    Point point_near(std::uint32_t corner, const Vec2& uv) const;
    /// The largest estimated error of these triangles.
    double worst_of(const Ring& ring) const;
    /// A corner that did not move by the least step will not, as long as nothing changes around it.
    void settle(std::uint32_t corner) { corners_[corner].settled = clock_; }
    bool settled(const Ring& ring, std::uint32_t corner) const;
    /// The largest error that removing a corner would leave; infinite where it cannot be removed.
    double cost_of_removal(std::uint32_t corner) const;

    // Changes since begin() are kept or taken back.
    void begin();
    void take_back();
    void move(std::uint32_t corner, const Vec2& uv, const Point& x);
    /// Turns edge k of a triangle into the other diagonal of the two triangles beside it, if that lowers the energy.
    bool flip(std::uint32_t triangle, int k);
    /// Removes a corner and fills the hole with the triangles of the least energy; false, and nothing done, where there are none.
    bool remove(std::uint32_t corner);
    /// The largest estimated error of the triangles changed since begin().
    double worst_change() const;
    /// Proves all triangles changed since begin() and those beside them: true when all keep the tolerance. May be asked again after more changes.
    bool certify();

private:
    struct Hole;
    bool find_holes(std::uint32_t corner, std::vector<Hole>& holes) const;
    bool plan(Hole& hole) const;
    void fill(const Hole& hole);
    void join_chords(const std::vector<Hole>& holes);

    Places places(const std::array<std::uint32_t, 3>& corner) const;
    /// Of n triangles, EstimateLanes::size at most, with the models of others.
    void estimate(int n, const Places* places, const FreeTriangle* const* like, Estimate* estimates) const;
    Estimate estimate_of(const Places& p, const FreeTriangle& like) const;
    /// Of triangles that changed.
    void estimate_anew(const std::vector<std::uint32_t>& triangles);
    /// What lies behind an edge, nullptr where it does not count: nothing, another patch, the other side of a break.
    const Estimate* behind(const FreeTriangle& like, std::uint32_t other) const;
    void update(const std::vector<std::uint32_t>& changed);
    bool may_join(std::uint32_t a, std::uint32_t b) const;
    bool on_break(std::uint32_t a, std::uint32_t b) const;
    void touch(std::uint32_t triangle);
    void touch_corner(std::uint32_t corner);
    void rename(std::uint32_t triangle, std::uint32_t from, std::uint32_t to);
    bool prove(std::uint32_t triangle);
    void sharpen(std::uint32_t triangle);
    bool holds(std::uint32_t triangle) const;
    bool holds_sharply(std::uint32_t triangle);

    Patch patch_;
    double tolerance_;
    Measure measure_;
    std::vector<double> breaks_u_, breaks_v_;
    std::vector<FreeCorner> corners_;
    std::vector<FreeTriangle> triangles_;
    mutable EstimateLanes lanes_;  // of estimate(): need not be cleared each time
    std::uint32_t epoch_ = 0;      // counts begin()
    std::vector<std::uint32_t> triangle_epoch_, corner_epoch_;
    std::uint32_t clock_ = 0;                          // counts changes
    std::vector<std::uint32_t> changed_;               // when a triangle, or one beside it, changed last
    std::vector<std::array<std::uint32_t, 3>> tried_;  // when a flip of its edge was tried last
    std::vector<std::pair<std::uint32_t, FreeTriangle>> old_triangles_;
    std::vector<std::pair<std::uint32_t, FreeCorner>> old_corners_;
};

/// e^16: so high that the largest errors count most.
inline double power(double e) {
    const double e2 = e * e, e4 = e2 * e2;
    return e4 * e4 * e4 * e4;
}

}  // namespace isoparm
