// second_derivatives.h -- the second derivatives of a patch over a box of its domain, in plain doubles with the radii of what is left out.
#pragma once
#include <array>
#include <vector>

#include "patch.h"
#include "scalar/vec.h"

namespace isoparm {

/// Taylor model of the second derivatives: H(q) = h + E + T (q - centre) with T anywhere in t +- t_rad and E in +- h_rad, other ones for each q.
struct SecondDerivatives {
    double u = 0, v = 0;                   // the centre
    std::array<Point, 3> h{};              // S_uu, S_uv, S_vv there
    std::array<double, 3> h_rad{};         // at least the length of E
    std::array<Point, 4> t{};              // S_uuu, S_uuv, S_uvv, S_vvv: middles of their ranges
    std::array<double, 4> t_rad{};         // at least the length of what they may be off by, anywhere in the cell
    std::array<double, 4> t_size{};        // at least their length
    std::array<double, 3> h_size{};        // at least |h| + |t| times the half-widths, |h| by its coordinates: what rounding is relative to
    bool bounded = false;                  // false: some of that has no bound, nothing else is set

    static constexpr int pieces = 3;  // along each direction, of the sharpest: more gain little

    SecondDerivatives() = default;
    /// Third derivatives are enclosed over parts x parts pieces of the box, which sharpens what intervals overestimate.
    SecondDerivatives(const Patch& patch, const Box& box, int parts = 1);

    /// Sets t_size, h_size and bounded from all else and the half-widths of the box.
    void add_sizes(double ru, double rv);
};

/// What a PolynomialCell knows, for loops over lanes.
struct PolynomialForm {
    int p, q;                        // degrees
    double u, v;                     // the cell's middle
    const std::array<double, 4>* c;  // x, y, z of the coefficient of (u' - u)^i (v' - v)^j at i (q + 1) + j, and nothing
    const double* error;             // at least the length of what those about any point of the cell are off by in plain doubles
    const double* off;               // at least how far S_uu, S_uv, S_vv are from the polynomial's
};

/// A cell of a patch where the surface is polynomial, or where a polynomial's second derivatives are near the surface's: its Taylor coefficients
/// about the cell's middle in plain doubles, and bounds of what rounding does to those about any other point. Makes SecondDerivatives tens of times
/// faster than intervals do. docs/certificates.md has the proof. Immutable, thread-safe.
class PolynomialCell {
public:
    static constexpr int max_degree = 5;  // along each parameter
    using Lanes = std::array<double, 4>;  // x, y, z of a coefficient, and nothing

    PolynomialCell() = default;  // none

    /// exists() is false where the surface is no polynomial, of too high degree, or the box does not lie in one cell between breaks.
    PolynomialCell(const Patch& patch, const Box& box);
    /// The polynomial of degrees p and q with coefficients c about the point (u,v), for |u' - u| <= hu and |v' - v| <= hv; there its second
    /// derivatives are within `off` of the surface's. exists() is false where these numbers are out of scale.
    PolynomialCell(int p, int q, double u, double v, double hu, double hv, std::vector<Lanes> c, const std::array<double, 3>& off);
    bool exists() const { return !c_.empty(); }
    /// The surface itself?
    bool exact() const { return exists() && hu_ < 0; }
    /// How large `off` is beside the polynomial's own second derivatives across the cell, those along the normal above all; 0 where it is exact. No bound.
    double inaccuracy() const;
    /// Of a box in the cell. About as sharp as the interval kind.
    SecondDerivatives operator()(const Box& box) const;
    /// Third derivatives enclosed over parts x parts pieces.
    SecondDerivatives operator()(const Box& box, int parts) const;
    /// Of the surface, but for rounding, at a point of the cell.
    Point point(const Vec2& p) const;
    /// At least the distance of x from the surface at p, a point of the cell, where it is exact.
    double slack(const Vec2& p, const Point& x) const;
    /// Valid as long as the cell.
    PolynomialForm form() const { return {p_, q_, u_, v_, c_.data(), error_.data(), off_.data()}; }

private:
    /// `radius(n, axis)`: by how much coefficient n is known.
    template <class Radius> void bound_errors(Radius radius, double hu, double hv);
    /// With degrees P and Q known when this is compiled, or -1.
    template <int P, int Q> SecondDerivatives over(const Box& box) const;

    int p_ = 0, q_ = 0;
    double u_ = 0, v_ = 0;       // the cell's middle
    std::vector<Lanes> c_;       // of (u - u_)^i (v - v_)^j at i (q + 1) + j
    std::vector<double> error_;  // at least the length of what coefficients about any point of the cell, are off by in plain doubles
    std::array<double, 3> off_{};
    double hu_ = -1, hv_ = -1;   // half-widths, where it is not exact
};

}  // namespace isoparm
