// layout.h -- the size of a picture, and its views: one answer for all who ask.
#pragma once
#include "picture/panels.h"
#include "picture/picture.h"

namespace isoparm {

struct Layout {
    int width = 0, height = 0;  // pixels
    double pixel = 1;           // pixels of this picture to one of the scene's
    std::vector<View> views;    // what they say in points is in pixels
};
/// Letters of pictures for print are at least 6 points. Throws Error(usage) for a size that cannot be.
Layout layout_of(const Scene& scene, const RenderOptions& options);

/// `size`, when it is from 1 to `most`. Throws Error(usage).
int checked_size(int size, const char* what, int most);

}  // namespace isoparm
