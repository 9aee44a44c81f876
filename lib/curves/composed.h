// curves/composed.h -- a curve run at another speed.
#pragma once
#include <vector>

#include "curve.h"

namespace isoparm {
/// c(phi(t)) over [t.front(), t.back()], phi the monotone C1 cubic through (t[k], s[k]), both growing, two at least, s inside the domain of c. Its slopes
/// are the harmonic means of the neighbouring secants (Fritsch and Butland 1984), at the ends (3 secant - next slope) / 2: phi' > 0 everywhere, and phi
/// is linear where the data are. Exact: Bezier pieces of three times the degree. Throws Error(input) for curves of formulas and above degree 10.
Curve run_by_monotone_cubic(const Curve& c, const std::vector<double>& t, const std::vector<double>& s);
}
