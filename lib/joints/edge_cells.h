// edge_cells.h -- where along an edge a patch is one polynomial, and which.
//
// A patch has cells between its lines; some have an exact form on parts of them only, or on their edges (exact_parts.h).
#pragma once
#include <vector>

#include "patch.h"

namespace isoparm {

struct CellForm {
    Rect cell;                     // closed; holds the line
    std::vector<Polynomial> form;  // as Patch::exact_cell; empty: not known
};
/// Of the cell that holds the line between two points; of two, the one that `side` points into. The form has the surface's derivatives to second order on the inside of the
/// line, not beside it.
CellForm form_beside(const Patch& patch, const Vec2& from, const Vec2& to, const Vec2& side);

/// The edge of the triangle that both points lie on; -1: none.
int edge_of_triangle(const Vec2& p, const Vec2& q);
/// Patch::edge_breaks(), and where one form beside edge k of a triangle ends and another begins.
std::vector<double> form_breaks(const Patch& patch, int edge);

struct EdgeCuts {
    std::vector<double> inner;      // t at which one form ends and another begins, growing; between 0 and 1
    bool starts = false, ends = false;  // no form, and no derivatives, next to t = 0, and to t = 1: an extraordinary vertex
};
/// Of the dyadic parts of a patch that has them along edge k; else nothing.
EdgeCuts dyadic_cuts(const Patch& patch, int k);

}  // namespace isoparm
