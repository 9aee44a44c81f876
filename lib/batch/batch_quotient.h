// batch_quotient.h -- frames of a quotient whose denominator vanishes in places, as that of side-vertex surfaces does at the vertices.
//
// The loops of batch.h run it where their error is proved; what is around such places is left to the formula.
#pragma once
#include <cstdint>
#include <vector>

#include "batch.h"

namespace isoparm {

/// Over the unit square or the triangle in it. Immutable; safe from every thread.
class QuotientCell {
public:
    QuotientCell() = default;
    /// x, y, z and their denominator, centred in the middle of the square.
    explicit QuotientCell(const PolynomialCells::Form& form);

    /// No where the degree is above PolynomialCells::max_degree, or PolynomialCells::accuracy is proved nowhere.
    bool exists() const { return !c_.empty(); }
    /// Is PolynomialCells::accuracy proved for frames there?
    bool covers(double u, double v) const { return good_[part(u) * parts + part(v)] != 0; }
    /// As PolynomialCells::frames_in, of n points that it covers.
    void frames(Isa isa, std::size_t n, const double* u, const double* v, double* const* out) const;

private:
    static constexpr std::size_t parts = 16;  // along each parameter, of the square
    static std::size_t part(double t) { return t >= 1 ? parts - 1 : static_cast<std::size_t>(t * parts); }

    std::vector<double> c_;
    std::vector<std::uint8_t> good_;  // of each box
    int degree_ = 1;
};

}  // namespace isoparm
