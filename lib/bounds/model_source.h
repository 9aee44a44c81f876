// model_source.h -- polynomials near a surface that is none: where BoundCell takes them from. docs/certificates.md, "Models", has the proofs.
#pragma once
#include <vector>

#include "bounds/second_derivatives.h"

namespace isoparm {

/// Makes models of a patch over boxes in one cell between breaks: polynomials whose second derivatives are near the surface's, by a proved bound.
/// Keeps no reference to the patch. Immutable, thread-safe.
class ModelSource {
public:
    ModelSource(const Patch& patch, const Box& cell);
    /// The model over a box in the cell, which is that of the patch; !exists() where there is none. That of a larger box is no sharper.
    PolynomialCell over(const Patch& patch, const Box& box) const;
    /// Whether a model of a triangle's own box is to be tried before intervals: it is as fast as they are, or much sharper.
    bool first() const { return !exact_.empty() || sharper_; }
    /// At least the distance of x from the surface at p, by plain arithmetic; infinite where there is no quick way to one.
    double slack(const Vec2& p, const Point& x) const;

private:
    using Lanes = std::array<double, 4>;  // x, y, z, denominator

    PolynomialCell rational_over(const Box& box) const;
    static PolynomialCell formula_over(const Patch& patch, const Box& box);
    void take_quotient(const Patch& patch, const Box& cell);
    void try_formula(const Patch& patch, const Box& cell);

    int p_ = 0, q_ = 0;                           // degrees
    double u_ = 0, v_ = 0;                        // the cell's middle
    std::vector<std::array<Interval, 4>> exact_;  // coefficients of a rational surface about it, at i (q_ + 1) + j
    std::vector<Lanes> c_;                        // the same in plain doubles
    Lanes error_{};                               // at least how far those polynomials are off, computed in plain doubles
    bool formula_ = false, sharper_ = false;      // there are models of the formula; they are far sharper than intervals
};

}  // namespace isoparm
