// patches/transformed.h -- a patch moved by an affine map. Parameters stay, so a mirror image has the opposite S_u x S_v;
// tessellate() orients the triangles of a composite consistently whatever the signs.
#pragma once
#include "patch.h"
#include "transform.h"

namespace isoparm {
Patch transformed(const Patch& patch, const Transform& m);
}
