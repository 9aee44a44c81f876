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
#include <cstddef>

#include "patch.h"
#include "subdivision/subdivision_ring.h"

namespace isoparm {

struct FaceLimits {
    double core = 0;                   // refined until a core is no larger, in scene units
    std::size_t most_pieces = 0;       // of all faces together, refined ones included
    std::atomic<std::size_t> pieces{0};
};

/// `ring`: of a quad (Catmull-Clark) or a triangle (Loop). Throws Error(budget) when there are more pieces than the limits allow. The patch is exact on
/// dyadic parts: exact_parts.h.
Patch make_subdivision_face(const Ring<Interval>& ring, Scheme scheme, FaceLimits& limits);
}  // namespace isoparm
