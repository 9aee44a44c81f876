// io/bv.h -- patches in BezierView's BV format: kinds 4 and 5 (tensor Bezier), 8 (rational), 3 (triangular Bezier),
// 1 (polyhedron faces are not surfaces: refused by name, as are 6, 7, 9 and 10).
#pragma once
#include <string>

#include "composite.h"

namespace isoparm {
/// Patches named NAME#0, NAME#1, ... in the order of the file, or GROUP#k when records carry a group. `text` is the whole
/// file, `path` is for messages only: they give path:line:column, what was found and what was expected. Throws
/// Error(input).
Composite read_bv(const std::string& text, const std::string& path);
}
