// limit_cell.h -- a cell of a limit surface at a corner of one of its faces, and surfaces over curves that are built on what the limit shows along its sides.
//
// Local parameters (s,t): (0,0) is the corner, s grows along the side to the face's next corner, t along the side to the one before. [0,1]^2 or the triangle
// s, t >= 0, s + t <= 1. So normals keep their side whatever corner the cell is at. Positions are relative to the limit at the corner: a small cell far from
// the origin keeps its digits.
//
// At an extraordinary vertex derivatives in the face's parameters vanish (valence 3) or grow beyond all bounds (5 and more: by 2 lambda a halving). In their place
// stand the limit's tangents, in the direction that the masks give and so long that the cubic between the ends of the side goes as far along it as the limit does at half way.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "patch.h"

namespace isoparm {

/// Position and derivatives at a point of a face; the derivatives may be NaN or infinite at its corners.
struct LimitFrame {
    Point p, du, dv;
};
using LimitFunction = std::function<LimitFrame(double u, double v)>;
LimitFunction limit_function(const Patch& patch);

/// Directions of the limit along the two sides that begin at a corner.
struct CornerTangents {
    Point next, previous;
};
using FaceTangents = std::array<std::optional<CornerTangents>, 4>;

class LimitCell {
public:
    /// The cell of side `h` (1: the whole face) at `corner` of a face. `tangents`: of the corners where derivatives do not exist.
    LimitCell(Domain domain, LimitFunction limit, int corner, double h, const FaceTangents& tangents = {});

    Domain domain() const { return domain_; }
    /// The limit at the corner: what positions are relative to.
    const Point& base() const { return base_; }
    /// In local parameters. At a corner without derivatives: the tangents in their place; they are NaN where there are none either.
    LimitFrame operator()(double s, double t) const;
    /// Has it derivatives or tangents at all corners?
    bool complete() const;
    /// The limit's own curve along a straight line between two points of the cell, over [0,1].
    Curve curve(const Vec2& from, const Vec2& to) const;
    /// A sub-triangle, or the same cell with another corner: the affine image of (0,0), (1,0), (0,1). Regular faces only.
    LimitCell part(const Vec2& origin, const Vec2& s_end, const Vec2& t_end) const;

private:
    LimitCell(Domain domain, LimitFunction limit);
    int corners() const { return domain_ == Domain::quad ? 4 : 3; }
    LimitFrame natural(double s, double t) const;
    Point side(int from, int to, const FaceTangents& tangents) const;
    LimitFrame corner_frame(int k, const FaceTangents& tangents) const;

    Domain domain_;
    LimitFunction limit_;
    int corner_ = 0;
    Vec2 origin_{0, 0}, s_{1, 0}, t_{0, 1};
    Point base_{0, 0, 0};
    bool whole_ = false;
    std::array<LimitFrame, 4> at_corners_;
};

/// A way to build a surface from the limit's curves, cross derivatives and corners along the sides of a cell.
struct LimitMethod {
    std::string name;
    Patch (*make)(const LimitCell& cell);
    int order;  // approximation order over regular cells: the deviation falls by 2^order a halving
    /// Nothing over cells that have shrunk to rounding, whose data do not fit together.
    std::optional<Patch> on(const LimitCell& cell) const;
};
/// Quads: "coons", bilinear, on the limit's own curves; "gregory": cubic curves, cross derivatives, rational twists.
const std::vector<LimitMethod>& quad_methods();
/// Triangles: side-vertex with t^2 on the limit's own curves and Nielson's C1 with quartic curves; and, for regular ones, all the others.
const std::vector<LimitMethod>& triangle_methods();
const std::vector<LimitMethod>& regular_triangle_methods();

}  // namespace isoparm
