// limit_subcells.h -- the identity of limit_compare.h on parts of irregular faces: sub-cells over which the limit surface is one bicubic patch.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "limit.h"
#include "patch.h"

namespace isoparm {

/// A face beside an extraordinary vertex, or of another size, has such cells at level 2; one at semi-sharp creases of sharpness s at level ceil(s), when they have
/// become smooth (not above: that is the negative control of the tests). Cells at vertices where the limit has no derivatives are left out.
struct SubcellReport {
    int faces = 0, cells = 0;          // compared: of each face up to 16 cells, at its corners, beside them and in its middle
    int deepest = 0;                   // level of the smallest cells
    std::optional<double> deviation;   // composite Hermite Coons against the limit, at 5 x 5 samples a cell
    std::vector<char> compared;        // by faces of the cage
};
/// `patches`: make_subdivision()'s, by name. Empty for Loop's scheme. Does not depend on the number of threads.
SubcellReport measure_subcells(const LimitSurface& limit, const std::map<std::string, Patch>& patches);

}  // namespace isoparm
