// film.h -- what the samples of a picture's pixels have come to so far.
//
// Pixels are those of a view. Sums grow in the order of the samples, so that a film that was put by and taken up again, at any sample of
// any pixel, ends with the same bits as one that was not.
//
// With a noise target, blocks of 8 x 8 pixels, at multiples of 8 of the view's pixels, end when they are done, in rounds of powers of two. A block's
// pixels fall in two sides, as the squares of a chessboard. Each side's number of samples is decided from the *other* side's samples
// alone: to stop when one's own samples happen to agree would favour pictures without their rare bright samples. As
// samples of different pixels are independent, the mean of a pixel is exactly that of a fixed number of samples. Until both sides have
// ended both are sampled; a side that has ended leaves its further samples to the decisions only.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <vector>

#include "scene/scene.h"

namespace isoparm {

/// Pixels x0 <= x < x1, y0 <= y < y1.
struct Area {
    int x0, y0, x1, y1;
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    std::size_t pixels() const { return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()); }
};

/// Variance of colours, about the first of them, so that equal ones have none.
class Spread {
public:
    void add(const Color& c);
    int count() const { return n_; }
    Color variance() const;  // of a sample
    Color mean() const { return n_ > 0 ? first_ + sum_ / double(n_) : Color{}; }
    void write(std::ostream& out) const;
    bool read(std::istream& in);  // false: no such numbers

private:
    Color first_, sum_, squares_;
    int n_ = 0;
};

/// The samples of a pixel: colours premultiplied.
struct PixelSum {
    Color color;
    double alpha = 0;
    int used = 0;  // samples in the sums
    int seen = 0;  // that were traced, at least as many
};

/// By which samples are compared.
inline double brightness(const Color& c) { return (c.x + c.y + c.z) / 3; }

/// What a film keeps of one pixel.
struct FilmPixel {
    PixelSum& sum;
    Spread* spread;    // nullptr without spreads
    Color* brightest;  // of the samples in the sums, the first of several; nullptr where it is not kept
};

class Film {
public:
    static constexpr int block = 8;  // pixels a side

    /// What is kept of a pixel besides its sums.
    struct Keeps {
        bool spreads = false;    // as with a target for the noise
        bool brightest = false;  // samples
    };
    /// `noise`: the target, 0 for none; the area then grows to whole blocks.
    Film(const Area& area, int samples, double noise, Keeps keeps);

    const Area& area() const { return area_; }
    int samples() const { return samples_; }
    PixelSum& at(int x, int y) { return pixels_[index(x, y)]; }
    const PixelSum& at(int x, int y) const { return pixels_[index(x, y)]; }
    FilmPixel pixel(int x, int y) {
        const std::size_t i = index(x, y);
        return {pixels_[i], spreads_.empty() ? nullptr : &spreads_[i], brightest_.empty() ? nullptr : &brightest_[i]};
    }
    /// nullptr where they are not kept.
    const Spread* spread(int x, int y) const { return spreads_.empty() ? nullptr : &spreads_[index(x, y)]; }
    const Color* brightest(int x, int y) const { return brightest_.empty() ? nullptr : &brightest_[index(x, y)]; }

    /// The round that is to be made: all pixels that go_on() get so many samples. samples() in the last one.
    int round() const { return round_; }
    bool goes_on(int x, int y) const { return ended_.empty() || ended_[block_of(x, y)] != 3; }
    /// Do further samples of the pixel count?
    bool counts(int x, int y) const { return ended_.empty() || !(ended_[block_of(x, y)] >> side(x, y) & 1); }
    /// When every pixel has the samples of the round: decides what ends, and begins the next. False: all is done.
    bool next_round();
    bool done() const { return done_; }

    /// Samples traced, and how many there will be, as far as that can be told.
    double traced() const;
    double expected() const;
    /// Root mean square over the pixels and colours of `seen`, of the standard error of the mean as it is shown: in sRGB, white is 1. 0 without spreads.
    double noise(const Area& seen) const;
    /// The part of the pixels that ended without reaching the target.
    double missed() const;

    /// Rays that the samples took, of pictures whose rays meet the surfaces themselves, and those of them that were left undecided.
    struct RayCount {
        std::uint64_t rays = 0, undecided = 0;
    } rays;

    /// As a checkpoint holds it: always the same number of bytes.
    void write(std::ostream& out) const;
    /// False, and nothing is to be done with the film any more: these are not the bytes of such a film.
    bool read(std::istream& in);

private:
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y - area_.y0) * static_cast<std::size_t>(area_.width()) + static_cast<std::size_t>(x - area_.x0); }
    std::size_t block_of(int x, int y) const {
        return static_cast<std::size_t>((y - area_.y0) / block) * static_cast<std::size_t>(area_.width() / block) + static_cast<std::size_t>((x - area_.x0) / block);
    }
    static int side(int x, int y) { return (x + y) & 1; }
    double noise_of_side(std::size_t block, int side) const;
    bool sound() const;

    Area area_;
    int samples_, round_;
    double target_;
    bool done_ = false;
    std::vector<PixelSum> pixels_;
    std::vector<Spread> spreads_;
    std::vector<Color> brightest_;
    std::vector<std::uint8_t> ended_;  // by block: bit 0 and 1 for its sides; empty without a target
};

/// Samples of the first round: one packet of rays.
inline constexpr int kFirstRound = 16;

}  // namespace isoparm
