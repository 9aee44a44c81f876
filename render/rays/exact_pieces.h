// exact_pieces.h -- polynomials, and quotients of such, that are a patch over parts of its leaves up to a proved error; internal to exact_patch.cpp.
//
// They tell where S(u,v) is in a fraction of the time of intervals. Each is made when a ray first needs it, and depends on its leaf alone.
// Safe from every thread. docs/exact.md, "Where S is", has the argument.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "patch.h"

namespace isoparm {

/// One of them.
struct ExactPiece {
    Box box;
    int depth = 0;          // quarterings of the leaf
    FrameError error;       // infinite where there is none; what is proved of frames(), rounding included
    int degree = 0;         // along both parameters
    bool rational = false;
    std::vector<double> c;  // as BatchKernel takes them
    int step = 0;           // it is quartered so often to parts that are good enough, as far as can be told; 0: they would not be
    mutable std::vector<std::atomic<const ExactPiece*>> parts;

    ExactPiece() = default;
    ExactPiece(const ExactPiece&) = delete;
    ExactPiece& operator=(const ExactPiece&) = delete;
    ~ExactPiece();
    /// Of n points in the box: out[3 d + axis][k] as PolynomialCells::frames_in.
    void frames(std::size_t n, const double* u, const double* v, double* const* out) const;
};

class ExactPieces {
public:
    static constexpr double wanted = 1e-12;  // error of positions, in sizes of the scene, that is good enough
    /// `size`: of the scene.
    ExactPieces(const Patch& patch, double size, std::size_t leaves);
    ~ExactPieces();
    /// That of the leaf with this box and cell whose error is small enough at a place; nullptr where there is none.
    const ExactPiece* at(std::size_t leaf, const Box& box, std::uint32_t cell, double u, double v) const;
    /// The patch's own quotient over all of a leaf; nullptr where there is none, or its error is too large.
    const ExactPiece* quotient(std::size_t leaf, const Box& box, std::uint32_t cell) const;
    /// The whole leaf's, if its error is not far too large.
    const ExactPiece* rough(std::size_t leaf, const Box& box, std::uint32_t cell) const;
    /// Encloses S and its derivatives to second order over a part of the leaf with this box, if that is about as sharp as intervals; third derivatives are not set.
    std::optional<Enclosure> enclose(std::size_t leaf, const Box& box, const Box& part) const;

private:
    using Model = std::vector<Polynomial>;  // empty where there is none
    const ExactPiece& root(std::size_t leaf, const Box& box, std::uint32_t cell) const;
    const Model& model(std::size_t leaf, const Box& box) const;
    /// `known`: the model over the box, or nullptr.
    std::unique_ptr<ExactPiece> make(const Box& box, std::uint32_t cell, int depth, const Model* known) const;
    bool good(const ExactPiece& piece) const { return piece.error.position <= wanted_; }
    void set(ExactPiece& piece, const std::vector<Polynomial>& form, const std::array<double, 3>& rest) const;

    const Patch& patch_;
    const std::vector<double> lines_u_, lines_v_;
    std::vector<std::vector<Polynomial>> forms_;  // of cells: quotients, or empty
    double wanted_;
    mutable std::vector<std::atomic<const ExactPiece*>> roots_;
    mutable std::vector<std::atomic<const Model*>> models_;  // of leaves
};

}  // namespace isoparm
