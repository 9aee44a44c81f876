// subdivision_face.h -- the limit surface over one irregular face of a cage, as a patch; internal to subdivision.cpp.
//
// A tree of sub-faces: regular ones are a polynomial each, others are refined, until what is left, around an extraordinary
// vertex, is tiny: of this core the position of the vertex is known, and a box that holds all of it. Everything is kept
// as intervals that enclose the limit surface itself, so what is proved over a box holds for it, not for a model of it.
//
// Domain: the face as [0,1]^2, or as the triangle with corners (0,0), (1,0), (0,1), by OpenSubdiv's parameters. Over its
// inside the surface is C2. At an extraordinary vertex derivatives do not exist (there they vanish or grow beyond all
// bounds); singular_normal() is the normal there, the limit of subdivision.
#pragma once
#include <atomic>
#include <bit>
#include <cstddef>
#include <vector>

#include "patch.h"
#include "subdivision_ring.h"

namespace isoparm {

struct FaceLimits {
    double core = 0;                   // refined until a core is no larger, in scene units
    std::size_t most_pieces = 0;       // of all faces together, refined ones included
    std::atomic<std::size_t> pieces{0};
};

/// `ring`: of a quad (Catmull-Clark) or a triangle (Loop). Throws Error(budget) when there are more pieces than the limits allow.
Patch make_subdivision_face(const Ring<Interval>& ring, Scheme scheme, FaceLimits& limits);

/// Such a patch has one cell and no form for it: exact_cell(0, 0) says instead that it has dyadic parts. They are numbered like a heap along u and along v: the part
/// [k, k+1] x [l, l+1] / 2^level (of the triangle: the one with its right angle at (k,l)) has exact_cell(dyadic_number(level, k), dyadic_number(level, l)), which has parts again,
/// or is the form there, or empty: around an extraordinary vertex, or where a larger part has the form already.
inline std::size_t dyadic_number(int level, std::size_t k) { return (std::size_t(1) << level) - 1 + k; }
inline int dyadic_level(std::size_t number) { return static_cast<int>(std::bit_width(number + 1)) - 1; }
/// Nothing else than this answer is one polynomial alone.
inline bool has_dyadic_parts(const std::vector<Polynomial>& form) { return form.size() == 1; }

}  // namespace isoparm
