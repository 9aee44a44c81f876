// png_file.h -- PNG files (ISO/IEC 15948), written by libpng: loading OpenImageIO takes longer than to draw many a figure.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"

namespace isoparm {

/// The bytes of a file with sRGB pixels of 8 bits, 3 or 4 channels, alpha not multiplied in, rows from the top. Metadata are texts; their names, of 1 to 79
/// characters, are ASCII. `at`: where in a larger picture they lie, as an oFFs chunk says unless it is (0,0). The same bytes for every number of threads.
std::string png_file(int width, int height, int channels, const std::vector<std::uint8_t>& pixels, const Metadata& metadata,
                     const std::array<int, 2>& at = {0, 0});

}  // namespace isoparm
