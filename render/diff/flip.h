// flip.h -- FLIP: how different two images look when they alternate, from 0 (the same) to 1.
//
// LDR-FLIP: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild, "FLIP: A Difference Evaluator for Alternating Images",
// HPG 2020. HDR-FLIP: Andersson, Nilsson, Shirley, Akenine-Moeller, "Visualizing Errors in Rendered High Dynamic Range Images",
// Eurographics 2021: the largest LDR-FLIP over a range of exposures, each tone-mapped (ACES). Written from the papers' formulas.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace isoparm {

struct FlipOptions {
    /// 0.7 m before a 0.7 m wide screen of 3840 pixels, as in the papers.
    double pixels_per_degree = 0.7 * 3840 / 0.7 * 3.14159265358979323846 / 180;
    bool hdr = false;
    double start = 0, stop = 0;  // of the exposures of HDR-FLIP, in stops
    int exposures = 1;
};

/// Exposures for a reference: from the one that takes the largest luminance to 0.85 to the one that takes the median there; as many as
/// there are stops between, at least 2, at most 64.
void choose_exposures(double largest, double median, FlipOptions& options);

/// Luminances of a reference, row by row; the median to a part in 65536 of itself, in 64 MiB at most.
class LuminanceMeter {
public:
    LuminanceMeter();
    /// Linear RGB, interleaved. What is negative or not finite counts as 0.
    void add(const float* rgb, std::size_t pixels);
    double largest() const { return largest_; }
    double median() const;

private:
    std::vector<std::uint32_t> counts_;
    std::uint64_t total_ = 0;
    double largest_ = 0;
};

/// Rows come in order, in blocks of any size; results do not depend on the blocks or on the number of threads. Holds about 100 rows.
class FlipMeter {
public:
    /// Called for every row, in order, as soon as it is known: its number and its `width` values.
    using Sink = std::function<void(int y, const float* row)>;
    FlipMeter(int width, int height, const FlipOptions& options, Sink sink);
    ~FlipMeter();
    /// Linear RGB, interleaved: in [0,1], or for HDR-FLIP of any size. Must be finite.
    void add(const float* reference, const float* test, int rows);

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

}  // namespace isoparm
