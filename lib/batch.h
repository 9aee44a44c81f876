// batch.h -- positions and first derivatives of many points at once, as structures of arrays.
//
// Patch::frames(u, v, out) runs the exact polynomial that the surface's formula is between its breaks (scalar/polynomial.h), where it is
// one: the formula stays the only statement of the surface. The loops exist once in the source and once for each instruction set in the
// binary; which one runs is chosen at run time. All of them do the same operations in the same order (no fused multiply-add), so they
// give the same bits on every machine.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "scalar/polynomial.h"

namespace isoparm {

/// Where n points go: position[axis][k], du[axis][k] = dS/du and dv[axis][k] at point k. None may overlap another or the parameters.
struct FrameArrays {
    std::array<std::span<double>, 3> position, du, dv;
};

enum class Isa { baseline, avx2, avx512 };
inline constexpr Isa all_isas[] = {Isa::baseline, Isa::avx2, Isa::avx512};
const char* to_text(Isa isa);
/// Has this machine (and its system) what the loops for `isa` need?
bool runs(Isa isa);
/// The one named, which must run here; the fastest that does for nullptr and "". Throws Error(usage).
Isa isa_named(const char* name);
/// What Patch::frames uses: isa_named() of the environment's ISOPARM_ISA, read once.
Isa chosen_isa();

/// Largest difference, of any coordinate, from the exact surface.
struct FrameError {
    double position = 0, du = 0, dv = 0;
};

/// Of frames that the loops make of coordinates and, when rational, a denominator, polynomials centred in the middle of a cell: rounding, and what coefficients are known to,
/// over a grid of parts x parts boxes. Infinite where that has no bound.
FrameError frame_error(const std::vector<Polynomial>& form, const Interval& u, const Interval& v, int parts);

/// Of a quotient centred in the middle of a cell, for each of parts x parts boxes in it, u-major; `largest`: coordinate of the surface, where that is known.
std::vector<FrameError> quotient_errors(const std::vector<Polynomial>& form, const Interval& u, const Interval& v, int parts, double& largest);

/// A surface that is polynomial, or rational with a positive denominator, in each cell of a grid. Immutable; safe from every thread.
class PolynomialCells {
public:
    /// What is asked of positions, relative to the largest coordinate of the surface, and of derivatives times half a cell's width.
    static constexpr double accuracy = 1e-12;
    static constexpr int max_degree = 7;
    /// Coordinates x, y, z of a cell and, when rational, their denominator.
    using Form = std::vector<Polynomial>;

    PolynomialCells() = default;
    /// Cells between lines_u and lines_v (ends included), u-major, their polynomials centred in the middle of the cell.
    PolynomialCells(const std::vector<double>& lines_u, const std::vector<double>& lines_v, const std::vector<Form>& forms);

    /// No where there are none, a degree is above max_degree, or `accuracy` cannot be proved.
    bool exist() const { return !cells_.empty(); }
    /// Proved for parameters in the domain, rounding included.
    const FrameError& error() const { return error_; }
    /// As Patch::frames. Points on a line between cells belong to the cell on its right.
    void frames(Isa isa, std::span<const double> u, std::span<const double> v, const FrameArrays& out) const;
    /// Of n points in one cell, its border included: out[3 d + axis][k], d = 0 position, 1 d/du, 2 d/dv. Cells are numbered u-major.
    void frames_in(std::size_t cell, Isa isa, std::size_t n, const double* u, const double* v, double* const* out) const;

private:
    struct Cell {
        double u, v;  // the middle
        std::vector<double> c;
    };
    std::size_t cell_at(double u, double v) const;

    std::vector<double> inner_u_, inner_v_;
    std::vector<Cell> cells_;
    int degree_ = 1;
    bool rational_ = false;
    FrameError error_;
};

}  // namespace isoparm
