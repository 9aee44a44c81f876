// ssim.h -- structural similarity: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
// Similarity", IEEE Trans. Image Processing 13(4), 2004: Gaussian window of 11 x 11 pixels with sigma 1.5, K1 = 0.01, K2 = 0.03, L = 1;
// where the window lies within the image; without the downsampling that the authors later recommended.
#pragma once
#include <functional>
#include <vector>

namespace isoparm {

/// Rows come in order, in blocks of any size; results do not depend on the blocks or on the number of threads.
class SsimMeter {
public:
    static constexpr int radius = 5;
    /// Called for every row that windows are centred on, radius <= y < height - radius: its `width - 2 radius` values, from x = radius.
    using Sink = std::function<void(int y, const double* row)>;
    /// Smaller images than the window have no rows.
    SsimMeter(int width, Sink sink) : width_(width), sink_(std::move(sink)) {}
    /// One number a pixel, in [0,1].
    void add(const float* a, const float* b, int rows);

private:
    int width_, rows_ = 0;
    Sink sink_;
    std::vector<std::vector<double>> moments_;  // of the last rows, along x: five numbers a pixel
};

}  // namespace isoparm
