// curves/isocurve.h -- the curve u = const or v = const of a quad patch, over the patch's own range.
#pragma once
#include "curve.h"
#include "patch.h"

namespace isoparm {
enum class Along { u, v };  // the parameter that runs
/// Throws Error(input) when `at` is outside the domain or the patch is a triangle.
Curve make_isocurve(const Patch& patch, Along along, double at);
}
