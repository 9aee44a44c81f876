// difference_image.h -- the image of the differences: reference less new, as idiff writes it.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "diff/diff.h"
#include "image/image_decoder.h"

namespace isoparm {

/// a - b of blocks of rows, channels in the order of a; 0 where the mask leaves out.
class DifferenceRows {
public:
    DifferenceRows(const ImagePart& a, const ImagePart& b, const DiffMask& mask);
    void subtract(const void* a, const void* b, bool doubles, int first, int rows);
    const std::vector<float>& values() const { return values_; }
    /// Of each pixel, over its channels; infinite where one is not finite.
    std::vector<float> largest() const;

private:
    std::vector<int> in_b_;
    std::size_t width_;
    const DiffMask& mask_;
    std::vector<float> values_;
};

/// EXR: all parts and channels, as floats. Other formats: the first part's R, G and B, or its first channels, at most three.
class DifferenceImage {
public:
    DifferenceImage(const std::string& path, const std::string& file, const std::vector<ImagePart>& parts, bool absolute, double scale);
    ~DifferenceImage();
    void add(std::size_t part, const std::vector<float>& differences, int first, int rows);
    void finish();

private:
    struct Layers;
    std::unique_ptr<Layers> layers_;
};

/// `fill` adds all rows and tells whether the file is wanted. The file appears whole or not at all. Throws Error(io).
void write_difference(const std::string& path, const std::vector<ImagePart>& parts, bool absolute, double scale, const std::function<bool(DifferenceImage&)>& fill);

/// Throws Error(usage) for an extension that is not written.
void check_difference_path(const std::string& path);

}  // namespace isoparm
