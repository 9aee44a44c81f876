// image_diff.h -- two image files compared: all parts, the numbers of diff.h, FLIP and SSIM, the image of the differences.
//
// Both files are read by rows in processes of their own (image_decoder.h), at most twice; memory does not grow with their height.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diff/diff.h"
#include "diff/flip.h"
#include "image/image.h"
#include "image/image_decoder.h"

namespace isoparm {

enum class FlipKind { automatic, ldr, hdr };  // automatic: hdr for images of floating point

struct DiffRequest {
    DiffLimits limits;
    ImageLimits image;
    std::string mask;            // a file, or ""
    bool perceptual = false;     // FLIP and SSIM, of the channels R, G, B of the first part that has them
    FlipKind flip = FlipKind::automatic;
    FlipOptions flip_options;
    std::string output;          // of the differences, or ""
    bool output_if_different = false, absolute = false;
    double scale = 1;
    int preview = 0;             // pictures for a page, at most so many pixels either way
};

/// For a page: smaller pictures of the part that FLIP is of, linear and opaque. Differences are the largest of the pixels that were joined.
struct DiffPreview {
    Image a, b;
    std::vector<float> difference, flip;  // a number a pixel; `flip` is empty without FLIP
    int factor = 1;                       // so many pixels of the file either way are one
};

struct ImageDiff {
    std::string a, b;
    DiffVerdict verdict = DiffVerdict::pass;
    std::vector<std::string> reasons;  // why it is not comparable or unreadable, and which of flip, rms and ssim failed
    std::vector<PartDiff> parts;
    // Over all channels of all parts.
    double mean = 0, rms = 0, max = 0, psnr = 0;
    std::uint64_t pixels = 0, failing = 0, warning = 0, nonfinite = 0;
    std::string worst_channel;         // "" when nothing differs
    DiffSample worst;
    std::optional<double> flip, ssim;
    FlipOptions flip_options;          // as used
    std::optional<DiffPreview> preview;
    std::string figures;               // of a page, made of the preview (diff_report.h)
    bool compared() const { return !parts.empty(); }
};

/// Throws Error(io) for a file that cannot be read or written, Error(usage) for a channel limit that fits no channel.
ImageDiff diff_images(const std::string& a, const std::string& b, const DiffRequest& request);

}  // namespace isoparm
