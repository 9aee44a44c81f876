// check_size.h -- which sizes can be measured in doubles.
#pragma once
#include <string>

#include "error.h"

namespace isoparm {

/// Throws Error(input) unless 1e-70 < size < 1e70: fourth powers of lengths must stay in the range of doubles. `what` has that size, "a surface"; `use`: what for,
/// "tessellate".
inline void check_size(double size, const std::string& what, const std::string& use) {
    if (!(size > 1e-70 && size < 1e70)) throw_input("found " + what + " of size " + to_text(size) + ", expected one between 1e-70 and 1e70 to " + use + "; scale the data");
}

}  // namespace isoparm
