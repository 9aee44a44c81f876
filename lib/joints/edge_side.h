// edge_side.h -- what a patch does along a line of its domain, as Taylor models: position and derivatives to second order.
//
// The line runs straight from `from` to `to`, s in [0,1]; its image is an edge of the patch, or a line between two of its cells. The jet
// has s as its first variable and, as its second, the parameter across: x(p(s) + e cross). Exact up to rounding where the patch is
// polynomial or rational (Patch::exact_cell); elsewhere by models, whose rest shrinks with the length of the piece to the 6th, 5th and 4th power for positions, first and second derivatives, or
// where there are none by enclosures to third order: to the 4th, 3rd and 2nd.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "patch.h"
#include "scalar/taylor_model.h"

namespace isoparm {

struct ParameterLine {
    Vec2 from, to, cross;
};

/// Edge `edge` from t0 to t1. The direction across points into the patch: on a rectangle along the other parameter, one unit of it in one; on
/// the triangle the median, from the middle of the edge to the opposite vertex (formulas of C1 data: D_k).
ParameterLine edge_line(const Patch& patch, int edge, double t0, double t1);

class EdgeSide {
public:
    using Jet = Vec3<JetUV<TaylorModel, 2>>;

    /// The line lies in one closed cell between breaks; of two, the one that `side` (cross or -cross) points into. Derivatives across are
    /// along line.cross.
    EdgeSide(Patch patch, const ParameterLine& line, const Vec2& side);

    Vec2 at(double s) const { return {line_.from.x + s * (line_.to.x - line_.from.x), line_.from.y + s * (line_.to.y - line_.from.y)}; }
    /// Over s in [middle - half, middle + half]; at one point when half is 0.
    Jet jet(double middle, double half) const;
    /// Box of the positions over the same; cheap.
    Vec3<Interval> positions(double middle, double half) const;
    /// Is the surface known as polynomial or rational?
    bool exact() const { return !exact_.empty(); }
    /// Of the direction of S_s x S_cross, of any length, over the same. Where the edge ends in a pole, and S_cross (or S_s) goes to 0 there
    /// (as far as rounding lets one see; it is taken for an exact 0), that factor is divided out: the direction has its limit at the end.
    Vec3<TaylorModel> normal(double middle, double half) const;
    static Vec3<TaylorModel> normal(const Jet& x);
    /// At s = s(d): another run along the same line. Derivatives are still by s.
    Jet jet(const TaylorModel& s) const;

private:
    std::vector<JetUV<TaylorModel, 2>> along_all() const;
    Jet of_line_form(const std::vector<JetUV<TaylorModel, 2>>& form) const;
    Jet of_form(const std::vector<JetUV<TaylorModel, 2>>& form) const;
    std::vector<JetUV<TaylorModel, 2>> form_at(const TaylorModel& s) const;
    Jet enclosed(const TaylorModel& s) const;
    std::optional<Jet> modelled(const TaylorModel& s) const;
    Box box(const Interval& s) const;
    void find_directions();

    Patch patch_;
    ParameterLine line_;
    Rect cell_;
    std::vector<Polynomial> exact_;
    double sign_ = 1;  // of a form beside a line: of line.cross, 1 where x grows
    bool square_of_first_ = false;  // the denominator of second derivatives is that of the first ones, squared
    std::vector<JetUV<TaylorModel, 2>> whole_;  // over all of s in [0,1], where that is exact
    std::array<Vec3<TaylorModel>, 2> directions_;  // then of S_s and S_cross, without the zeros at the ends
    bool has_directions_ = false;
};

}  // namespace isoparm
