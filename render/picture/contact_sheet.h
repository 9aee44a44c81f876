// contact_sheet.h -- many pictures on one.
#pragma once
#include <vector>

#include "image/image.h"

namespace isoparm {
/// The picture shrunk to fit into width x height by averaging (each pixel the mean of what it covers); never enlarged.
Image thumbnail(const Image& image, int width, int height);
/// Thumbnails in rows on white, each centred in a cell of its own, margins between.
Image contact_sheet(const std::vector<Image>& thumbnails, int cell_width, int cell_height);
}  // namespace isoparm
