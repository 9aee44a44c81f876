// curves/difference.h -- slopes of a curve: its derivative, and its divided difference with one end.
//
// Quotients such as (E(t) - E(1)) / (1 - t) cancel at the end. As a curve of its own the quotient is evaluated without a division by 0:
//     q(t) = (E(t) - E(e)) / (t - e) = integral over s in [0,1] of E'(e + s (t - e)),    q^(k)(t) = integral of s^k E^(k+1)(e + s (t - e)),
// so a Taylor coefficient q_k over an interval T lies in the range of E_(k+1) over the hull of T and e.
#pragma once
#include "curve.h"

namespace isoparm {

enum class CurveEnd { first, last };

/// E'. The exact Bezier pieces where E has such (of degree 2n where it is rational). Elsewhere Taylor coefficients of order 3 are unknown: NaN, or
/// Interval::all().
Curve derivative_curve(const Curve& c);

/// q above, or for times = 2 the divided difference of that with the same end: (E(t) - E(e) - (t - e) E'(e)) / (t - e)^2. The exact Bezier pieces where E has
/// such. Elsewhere numbers lie in the interval that encloses them. At the end itself coefficients have bounds up to `times` orders less than E knows.
Curve divided_difference(const Curve& c, CurveEnd end, int times = 1);

}  // namespace isoparm
