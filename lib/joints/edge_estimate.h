// edge_estimate.h -- coarse bounds of the jumps across a piece of an edge, from ranges alone: a few hundred operations on intervals.
//
// Beside the ranges x and y of what the two sides have, that of their difference is carried through every operation: x x' - y y' = x (x' - y') +
// (x - y) y', and so on. Where position, derivatives and second derivatives differ by rounding only, so do angle and curvature; nothing more need be known.
#pragma once
#include <array>

#include "joints/edge_side.h"

namespace isoparm {

enum Measure5 { kC0, kC1, kC2, kG1, kG2, kMeasures };
using JumpSizes = std::array<Interval, kMeasures>;

/// Encloses every jump everywhere on the piece; [0, infinity] where nothing is known.
JumpSizes estimate_jumps(const EdgeSide::Jet& x, const EdgeSide::Jet& y);

/// Of an angle with `cosine` and `sine` (that is not negative) times one positive length, in degrees.
Interval degrees_of(const Interval& sine, const Interval& cosine);

}  // namespace isoparm
