// curves/modify.h -- curves made of curves: reversed, cut, moved, added.
#pragma once
#include <array>
#include <vector>

#include "curve.h"
#include "transform.h"

namespace isoparm {
/// Same domain, run backwards.
Curve reversed(const Curve& c);
/// The part over [from, to], begin <= from < to <= end, run over [0,1] when `unit`, else over [from, to].
Curve segment(const Curve& c, double from, double to, bool unit = true);
Curve transformed(const Curve& c, const Transform& m);
/// sum weights[k] curves[k]; all over the same domain. Polynomial pieces stay exact polynomials.
Curve linear_combination(const std::vector<double>& weights, const std::vector<Curve>& curves);
}
