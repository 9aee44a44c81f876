// color_map.h -- viridis: numbers in [0,1] as colours of evenly growing lightness, told apart by the colour-blind and in grey.
#pragma once
#include <algorithm>

#include "picture/palette.h"

namespace isoparm {

/// Linear. A polynomial of degree 6 fitted to the published table (Smith and van der Walt 2015; fit by M. Zucker 2019), off by at most
/// 0.02.
inline Color viridis(double t) {
    static constexpr double c[7][3] = {
        {0.2777273272234177, 0.005407344544966578, 0.3340998053353061}, {0.1050930431085774, 1.404613529898575, 1.384590162594685},
        {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},  {-4.634230498983486, -5.799100973351585, -19.33244095627987},
        {6.228269936347081, 14.17993336680509, 56.69055260068105},      {4.776384997670288, -13.74514537774601, -65.35303263337234},
        {-5.435455855934631, 4.645852612178535, 26.3124352495832}};
    t = std::clamp(t, 0.0, 1.0);
    double rgb[3];
    for (int k = 0; k < 3; ++k) {
        rgb[k] = c[6][k];
        for (int i = 5; i >= 0; --i) rgb[k] = c[i][k] + t * rgb[k];
    }
    return linear_from_srgb(std::clamp(rgb[0], 0.0, 1.0), std::clamp(rgb[1], 0.0, 1.0), std::clamp(rgb[2], 0.0, 1.0));
}

}  // namespace isoparm
