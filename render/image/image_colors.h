// image_colors.h -- the colours among the channels of a part.
#pragma once
#include <vector>

#include "image/image_decoder.h"

namespace isoparm {

/// R, G and B, or Y as grey. Whole numbers are taken as sRGB, floating point as linear light.
class ImageColors {
public:
    explicit ImageColors(const ImagePart& part);
    bool any() const { return red_ >= 0; }
    bool uses(int channel) const { return channel == red_ || channel == green_ || channel == blue_; }
    /// Linear RGB, interleaved. Without colours, the first channel as grey.
    void linear(const float* rows, std::size_t pixels, std::vector<float>& rgb) const;
    /// The same of doubles or floats.
    void linear(const void* rows, bool doubles, std::size_t pixels, std::vector<float>& rgb) const;
    /// Y' = 0.299 R' + 0.587 G' + 0.114 B' (BT.601) of what a display is sent, in [0,1].
    void luma(const float* rows, std::size_t pixels, std::vector<float>& y) const;

private:
    int red_ = -1, green_ = -1, blue_ = -1, channels_;
    bool encoded_;
};

}  // namespace isoparm
