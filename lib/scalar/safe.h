// scalar/safe.h -- bounds in plain doubles: what a few dozen rounded operations may lose is added once. docs/certificates.md, "Cells".
#pragma once

namespace isoparm {

/// Sums and products of numbers >= 0, a few dozen operations long, are at most this factor too small, up to underflow.
constexpr double kSafe = 1 + 1e-13;
/// At least what underflow costs in all of them, for cells whose half-widths are in_scale() and derivatives below kLargestDerivative.
constexpr double kUnderflow = 1e-180;
constexpr double kLargestDerivative = 1e140;

inline double safe(double x) { return x * kSafe + kUnderflow; }
/// Half the width of a cell of the domain: no fifth power of it underflows times another, no square multiplies a lost subnormal beyond kUnderflow.
inline bool in_scale(double half) { return half == 0 || (half >= 1e-25 && half <= 1e60); }

}  // namespace isoparm
