// patches/tensor_bezier_points.h -- points of one cell of a tensor product Bezier surface, as many at once as the instruction set has lanes;
// internal to tensor_bezier.cpp.
//
// The loops exist once in the source (tensor_bezier_loops.inc) and once for each instruction set in the binary (batch.h). They do what the surface's
// formula does with doubles, in its order: the same bits.
#pragma once
#include <cstddef>

#include "batch.h"
#include "scalar/vec.h"

namespace isoparm {

struct BezierCoefficients {
    static constexpr int max_degree = 7;
    int p = 0, q = 0;               // degrees, up to max_degree
    bool rational = false;
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
    const double* c = nullptr;      // of coordinate k, 3 being the denominator, at (k (p + 1) + i) (q + 1) + j
};

/// At n parameters in the cell. Thread-safe.
void bezier_points(Isa isa, const BezierCoefficients& cell, std::size_t n, const double* u, const double* v, Point* out);

}  // namespace isoparm
