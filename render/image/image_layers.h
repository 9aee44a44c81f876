// image_layers.h -- images of several parts with channels of any name, written as they are: for tests of what reads them.
#pragma once
#include <string>
#include <vector>

#include "image/image_decoder.h"

namespace isoparm {

struct ImageLayer {
    ImagePart part;             // name, windows, channels; types: "float", "half", "uint8", "uint16", "uint32"
    std::string space = "Linear";
    std::vector<float> values;  // interleaved; fractions for 8 and 16 bits, whole numbers for 32
    float& at(int x, int y, const std::string& channel);
};

/// A layer of that size at (0,0), filled with 0.
ImageLayer make_layer(const std::string& name, int width, int height, const std::vector<std::string>& channels, const std::vector<std::string>& types);

/// In the format of the extension. Appears whole or not at all. Throws Error(io).
void write_layers(const std::string& path, const std::vector<ImageLayer>& layers);

}  // namespace isoparm
