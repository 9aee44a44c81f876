// fireflies.h -- single bright pixels that one rare sample left, spread over their neighbours: the picture keeps all its light.
//
// After Rushmeier and Ward, Energy Preserving Non-Linear Filters, SIGGRAPH 1994. A firefly is a pixel whose brightest sample adds more than
// all its others (two samples of a glint are none), and more than half of the mean of the pixels about it. That
// sample is then as bright as the others, and what it had more goes to the pixels about it, within a radius of 2 to 16 that grows until it is a
// twentieth there, in proportion to how bright they are and how much of them is covered: nothing is added where nothing is, and dark things beside a bright floor do not glow. Sums over the picture do not change but by rounding.
#pragma once
#include "picture/film.h"

namespace isoparm {

/// Pixels around a part of a picture that what it shows may depend on.
inline constexpr int kFireflyReach = 32;

/// The film, which knows brightest samples, without its fireflies: right for all of its pixels that are at the rim of the view or not within
/// kFireflyReach pixels of its own.
Film without_fireflies(const Film& film);

}  // namespace isoparm
