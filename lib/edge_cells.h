// edge_cells.h -- where along an edge a patch is one polynomial, and which.
//
// A patch has cells between its lines. The limit surface over an irregular face of a cage has none, but dyadic parts, smaller and smaller ones
// towards extraordinary vertices, on which it is polynomial; it answers for them in place of cells (see subdivision_face.h).
#pragma once
#include <vector>

#include "patch.h"

namespace isoparm {

struct CellForm {
    Rect cell;                     // closed; holds the line
    std::vector<Polynomial> form;  // as Patch::exact_cell; empty: not known
};
/// Of the cell that holds the line between two points; of two, the one that `side` points into.
CellForm form_beside(const Patch& patch, const Vec2& from, const Vec2& to, const Vec2& side);

struct EdgeCuts {
    std::vector<double> inner;      // t at which one form ends and another begins, growing; between 0 and 1
    bool starts = false, ends = false;  // no form, and no derivatives, next to t = 0, and to t = 1: an extraordinary vertex
};
/// Of the dyadic parts of a patch that has them along edge k; else nothing.
EdgeCuts dyadic_cuts(const Patch& patch, int k);

}  // namespace isoparm
