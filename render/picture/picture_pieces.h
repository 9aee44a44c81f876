// picture_pieces.h -- pictures put together from those of their views, pixel by pixel.
#pragma once
#include "picture/picture.h"

namespace isoparm {

/// What both have.
Area common(const Area& a, const Area& b);
/// All pixels as where nothing is.
Image blank(int width, int height, const std::optional<Color>& background);
Layers blank_layers(int width, int height, const std::vector<Aov>& aovs);
/// Image and layers of `part`, from (x0,y0) of `whole` on.
void paste(const Picture& part, int x0, int y0, Picture& whole);
/// Puts a drawing over a picture, as vectors or painted; (x,y) is where its pixels begin there. On a dark background what has the colour of ink, or of curves, is light; rims of
/// texts have the background's colour where that can be told from the letters'.
void put_over(Drawing drawing, int x, int y, int width, int height, bool vectors, const std::optional<Color>& background, Picture& picture);

}  // namespace isoparm
