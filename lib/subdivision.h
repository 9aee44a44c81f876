// subdivision.h -- the limit surface of a subdivision cage as a composite of patches, exact up to rounding.
//
// Every face of the cage is a patch "#FACE" (counted from 0), in the parameters of limit.h; a face of n corners that the scheme cuts into quads is n
// patches "#FACE.CORNER", each beginning at its corner. Regular faces, also at boundaries and infinitely sharp creases, are
// bicubic Bezier patches (Loop: quartic Bezier triangles); bilinear ones bilinear. Others are subdivision_face.h: polynomial pieces
// down to a core around the extraordinary vertex so small that no tolerance sees it, and intervals that enclose the
// limit surface itself, so that certificates hold against it.
#pragma once
#include "cage.h"
#include "composite.h"

namespace isoparm {

struct SubdivisionSurface {
    Composite patches;
    int regular = 0, irregular = 0, without_limit = 0;  // faces of the cage
};

/// Throws Error(input) for cages that check_cage() refuses and for edges and vertices that are not manifold, Error(budget) when irregular faces take more
/// pieces (about 2 kB each; an extraordinary vertex takes about 140 in each of its faces, those counted that are refined, semi-sharp creases double them with each unit of sharpness). Does not depend on the number of threads.
SubdivisionSurface make_subdivision(const Cage& cage, Scheme scheme, std::size_t most_pieces = 400'000);

}  // namespace isoparm
