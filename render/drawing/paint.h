// paint.h -- a drawing put on a picture.
#pragma once
#include <vector>

#include "drawing/drawing.h"
#include "image/image.h"

namespace isoparm {

/// Each item over what is there, in linear light, letters by how bright they look; over transparent pixels too. The drawing has width x height pixels, of which (left, top) is
/// at the image's corner: a part of a picture gets the bits that the whole one has.
void paint(const Drawing& drawing, int width, int height, int left, int top, Image& image);
/// Those of a figure for print, over its raster: each only where its part is seen.
void paint(const std::vector<DrawnPart>& parts, Image& image);

}  // namespace isoparm
