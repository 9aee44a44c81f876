// curvature_map.h -- surfaces coloured by curvature: which number, which colours, which range, and stripes of light.
#pragma once
#include <string>
#include <vector>

#include "light/shade.h"
#include "scene/scene.h"

namespace isoparm {

/// Blue for -1, nearly white for 0, orange for 1: lightness falls evenly to both sides and is the same for x and -x; the hues are told apart by the
/// colour-blind. Linear. Straight lines in Oklab (Ottosson 2020).
Color diverging(double x);

/// Not below x > 0: 1, 1.5, 2, 3, 4, 5, 6 or 8 times a power of ten.
double rounded_up(double x);

/// ColorBy with its range settled.
struct ColorScale {
    ColorBy by;
    std::string name, unit{};           // in a legend; empty: that of `by`, and none
    double low = 0, high = 1;           // low < high
    bool below = false, above = false;  // samples lie beyond
    /// Diverging about 0 when 0 is inside, both sides to the same scale; otherwise viridis from low to high.
    bool two_sided() const { return low < 0 && high > 0; }
    Color color(double value) const;
};

/// Gaussian, mean or principal curvature, k1 >= k2, signs as `eval` has them; `flipped`: of the other side. NaN where there is none.
double curvature_of(const Patch& patch, const Vec2& at, ColorBy::What what, bool flipped);

/// Without a range: from the 2nd to the 98th of 100 samples, made round; symmetric about 0 for gaussian and mean. `flipped`: of each patch.
ColorScale settled(const ColorBy& by, const Composite& patches, const std::vector<char>& flipped);

/// Whether a point with this unit normal, seen along the ray, is in a dark stripe. Reflection: where the ray goes on to, as an angle about the lamps'
/// direction; isophotes: the angle between normal and light.
bool in_dark_stripe(const ColorBy& by, const Point& normal, const Point& ray, const Camera& camera);

}  // namespace isoparm
