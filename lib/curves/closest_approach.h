// closest_approach.h -- where two curves come nearest to each other: sampled as polygons, then Newton's method. Nothing is proved:
// a nearer place between the samples can be missed, so what is said of it must say "sampled".
#pragma once
#include "curve.h"

namespace isoparm {
struct Approach {
    double s, t;  // parameters of the first and of the second curve, in their own domains
    double distance;
};
Approach closest_approach(const Curve& a, const Curve& b);
}
