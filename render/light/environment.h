// environment.h -- a picture of everything around the scene, as light: all directions by longitude and latitude.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "light/light.h"

namespace isoparm {

/// Immutable; safe to use from every thread. Directions are unit, in the image's own frame: z up; the middle column is toward +x, and what is to the right of
/// it in the image is to the right for who looks there: toward -y. Radiance is interpolated between the middles of pixels.
class EnvironmentImage {
public:
    /// Rows from the top, linear red, green, blue, none negative or infinite; at least 2 x 1 pixels.
    EnvironmentImage(int width, int height, std::vector<float> rgb);
    Vec3<double> radiance(const Point& direction) const;

    /// The part of radiances that belongs to a sky, and not to a sun in it: all but what is more than 16 times the mean.
    double sky_part(const Vec3<double>& radiance) const;

    struct Sample {
        Point direction;
        double density = 0;  // over solid angle; 0: the image is black
    };
    /// In proportion to what is interpolated between pixels: a little of them to their radiance, most to what of it is above the mean of all (Karlik et al.,
    /// MIS compensation, SIGGRAPH Asia 2019), as the even rest of a sky is found by the directions that surfaces choose anyway.
    Sample sample(const Vec2& s) const;
    /// That of sample(), exactly.
    double density(const Point& direction) const;

private:
    // Cells lie between the middles of pixels, and those of the first and last row and the poles.
    double row_top(int row) const;  // the cosine of a cell's upper rim
    double grey(int x, int y) const;
    double weight(int x, int y) const;
    struct Cell {
        double w00, w10, w01, w11;  // weights of its corners; the second digit is down
    };
    Cell cell(int x, int row) const;
    Vec2 place(const Point& direction) const;
    int width_, height_;
    double brightest_sky_ = 0, mean_ = 0, even_ = 1, bright_ = 0;  // weight = even_ radiance + bright_ max(0, radiance - mean_)
    double total_ = 0;                                            // of weights, over cosines and columns
    std::vector<float> rgb_;
    std::vector<double> row_, in_row_;  // cumulative: rows of cells, and cells within each row, from 0 to 1
};

/// An image file that somebody else may have made, decoded in a process of its own with its limits (image_decoder.h). Throws Error(io); Error(input) when it is
/// not twice as wide as high, has no colours, or values that are negative or not finite.
std::shared_ptr<const EnvironmentImage> load_environment(const std::string& path);

/// One for each of some lights, null for those without an image.
using EnvironmentImages = std::vector<std::shared_ptr<const EnvironmentImage>>;
/// Files are read once, and kept as they were while the program runs. To be called first before there are other threads (image_decoder.h).
EnvironmentImages load_environments(const std::vector<Light>& lights);

}  // namespace isoparm
