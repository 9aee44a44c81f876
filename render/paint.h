// paint.h -- a drawing put on a picture.
#pragma once
#include <vector>

#include "drawing.h"
#include "image.h"

namespace isoparm {

/// Each item over what is there, in linear light; over transparent pixels too. (left, top) is the pixel of the drawing
/// at the picture's corner.
void paint(const Drawing& drawing, int left, int top, Image& image);
/// Those of a figure for print, over its raster: each only where its part is seen.
void paint(const std::vector<DrawnPart>& parts, Image& image);

}  // namespace isoparm
