// arrows.h -- vectors as arrows of constant width, with heads that go with the width.
#pragma once
#include "drawing/flat_lines.h"

namespace isoparm {

/// Hidden where surfaces hide it, as all flat lines. The head is at most 0.6 of what is seen of the length.
void add_arrow(const Arrow& arrow, const LineLook& look, const Sight& sight, Drawing& drawing);

}  // namespace isoparm
