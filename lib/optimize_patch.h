// optimize_patch.h -- the triangulation of one patch while optimize() changes it: flips, moves, vertices removed, all of which can be
// taken back; internal to optimize*.cpp.
//
// Triangles know their neighbours instead of edges. Edges on rims have none beside them, edges on breaks stay where they are.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "refine.h"

namespace isoparm {

/// Where a corner may go: nowhere, anywhere inside the patch, along a break v = const or u = const, along a rim.
enum class Freedom : char { fixed, inside, along_u, along_v, rim };

struct FreeCorner {
    Vec2 uv;
    Point x;
    double slack = 0;                   // at least the distance of x from the patch at uv
    std::uint32_t vertex = 0;           // of the mesh
    std::uint32_t triangle = kNone;     // one of those around it; kNone: removed
    std::uint32_t rim_point = kNone;
    Freedom freedom = Freedom::inside;
    float step = 0.2f;                  // of the last moves, relative to the edges
};

/// What TriangleBound holds, estimated.
struct Estimate {
    double parametric = 0;  // what counts where it is not quiet
    double normal = 0;
    std::array<double, 3> across{};
    Point unit;
    bool quiet = false;

    double least() const { return quiet ? normal : parametric; }
};

struct FreeTriangle {
    std::array<std::uint32_t, 3> corner{};
    std::array<std::uint32_t, 3> beside{kNone, kNone, kNone};  // across edge k, from corner k to k+1
    const BoundCell *root = nullptr, *cell = nullptr;          // between breaks; the one used last
    Estimate own;                                              // over the tolerance, but for the normal
    double error = 0;                                          // estimated with the neighbours, relative to the tolerance
    TriangleBound proof{};
    bool proved = false;                                       // proof is that of these corners
    bool sharp = false;                                        // and there is no sharper one
    bool live = true, left_out = false;
};

/// The triangles around a corner, counter-clockwise, and the corners around: one more when it lies on a rim.
struct Ring {
    std::vector<std::uint32_t> triangles, links;
    bool closed = true;
};

/// A candidate: three places, and the cell to begin with.
struct Places {
    std::array<Vec2, 3> uv;
    std::array<Point, 3> x;
    double slack = 0;
};

class FreePatch {
public:
    FreePatch(const Patch& patch, const PatchMesh& mesh, const std::vector<Point>& positions, double tolerance, Measure measure);

    const Patch& patch() const { return patch_; }
    const std::vector<FreeCorner>& corners() const { return corners_; }
    const std::vector<FreeTriangle>& triangles() const { return triangles_; }
    FreeCorner& corner_to_set_up(std::uint32_t c) { return corners_[c]; }

    Ring ring(std::uint32_t corner) const;
    /// Sum of powers of the errors of the triangles around a corner, if it were at this place; infinite when one would turn over.
    double energy_at(const Ring& ring, std::uint32_t corner, const Vec2& uv, const Point& x) const;
    double energy(const Ring& ring) const;

    /// All changes since begin() are kept, or taken back.
    void begin();
    void take_back();
    void keep() { open_ = false; }

    void move(std::uint32_t corner, const Vec2& uv, const Point& x);
    /// Removes a corner and fills the hole with the triangles of the least energy; false, and nothing done, where there are none.
    bool remove(std::uint32_t corner);
    /// The largest error that removing it would leave; infinite where it cannot be removed.
    double cost_of_removal(std::uint32_t corner) const;
    /// Turns edge k of a triangle into the other diagonal of the two triangles beside it, if that lowers the energy.
    bool flip(std::uint32_t triangle, int k);
    /// The largest estimated error of the triangles changed since begin().
    double worst_change() const;
    /// Proves all triangles changed since begin(), and those beside them: true when all keep the tolerance.
    bool certify();
    void set_step(std::uint32_t corner, float step) { corners_[corner].step = step; }
    std::size_t count() const;

private:
    struct Hole;
    bool find_holes(std::uint32_t corner, std::vector<Hole>& holes) const;
    bool plan(Hole& hole) const;
    void fill(const Hole& hole);
    Estimate estimate_of(const Places& p, const FreeTriangle& like) const;
    /// With the neighbour across edge k, or none.
    double beyond(const Estimate& t, int k, const Estimate* other) const;
    double error_of(const FreeTriangle& t) const;
    void update(const std::vector<std::uint32_t>& changed);
    Places places(const std::array<std::uint32_t, 3>& corner) const;
    bool may_join(std::uint32_t a, std::uint32_t b) const;
    bool on_break(std::uint32_t a, std::uint32_t b) const;
    void touch(std::uint32_t triangle);
    void touch_corner(std::uint32_t corner);
    void prove(std::uint32_t triangle);
    void sharpen(std::uint32_t triangle);
    bool holds(std::uint32_t triangle) const;
    bool holds_sharply(std::uint32_t triangle);

    Patch patch_;
    double tolerance_;
    Measure measure_;
    std::vector<double> breaks_u_, breaks_v_;
    std::vector<FreeCorner> corners_;
    std::vector<FreeTriangle> triangles_;

    bool open_ = false;
    std::uint32_t epoch_ = 0;
    std::vector<std::uint32_t> triangle_epoch_, corner_epoch_;
    std::vector<std::pair<std::uint32_t, FreeTriangle>> old_triangles_;
    std::vector<std::pair<std::uint32_t, FreeCorner>> old_corners_;
};

/// What a cell's model tells of a triangle, wherever it lies: the geometric bound, but for rounding. Nothing when it is not quiet.
Estimate estimate(const SecondDerivatives& model, const Places& p);

}  // namespace isoparm
