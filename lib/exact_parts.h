// exact_parts.h -- what Patch::exact_cell() says of surfaces that have no exact form over a whole cell, but one where an edge needs it.
//
// Such an answer has one or two polynomials, which mean nothing in themselves; a form has three, or four with the denominator.
#pragma once
#include <bit>
#include <vector>

#include "patch.h"

namespace isoparm {

/// The limit surface over an irregular face of a cage has one cell, and dyadic parts, smaller and smaller ones towards extraordinary vertices. They are
/// numbered like a heap along u and along v: the part [k, k+1] x [l, l+1] / 2^level (of the triangle: the one with its right angle at (k,l)) has
/// exact_cell(dyadic_number(level, k), dyadic_number(level, l)), which has parts again, or is the form there, or empty: around an extraordinary vertex, or
/// where a larger part has the form already.
inline bool has_dyadic_parts(const std::vector<Polynomial>& form) { return form.size() == 1; }
inline std::size_t dyadic_number(int level, std::size_t k) { return (std::size_t(1) << level) - 1 + k; }
inline int dyadic_level(std::size_t number) { return static_cast<int>(std::bit_width(number + 1)) - 1; }

/// Gregory's surfaces, and what is spanned by rational curves, have for each edge of a cell a form with the same position, first and second derivatives on the inside of that edge:
/// exact_cell(i + (k + 1) m, j), m the number of cells along u, k as in Patch::edge_point. It is a line form, in t = u or v along the edge; x grows with the other one.
inline bool has_edge_forms(const std::vector<Polynomial>& form) { return form.size() == 2; }

/// Surfaces over triangles with singular vertices have exact_cell(k + 1, n) beside part n = 0, 1, ... of edge k, as in Patch::edge_point; after the last part it is empty. With t along the edge and x across it in the
/// direction of the median, position, first and second derivatives there are those of f0 + f1 x + (f2 + f3) x^2, where f0 to f3 each are three polynomials over a fourth one, in t minus the middle
/// of the part, which is a number, the last of the list. The denominators have no zeros in [0,1], but that of f3 at its ends.
inline bool has_line_form(const std::vector<Polynomial>& form) { return form.size() == 17; }
inline Interval part_of_edge(const std::vector<Polynomial>& form) { return form.back().coefficient(0, 0); }

}  // namespace isoparm
