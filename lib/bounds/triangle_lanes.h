// triangle_lanes.h -- the bounds of eight triangles of one polynomial cell at once; internal to bound_cell.cpp and refine.cpp.
//
// The loops exist once in the source (triangle_lanes_loops.inc) and once for each instruction set in the binary; which one runs is chosen at run
// time (batch.h). All give the bits of bound_triangle() with the cell's own SecondDerivatives over the triangle's box.
#pragma once
#include <span>

#include "batch.h"
#include "bound.h"
#include "bounds/second_derivatives.h"

namespace isoparm {

/// Corners, the mesh's points there and slack of eight triangles, by lanes; lanes beyond those asked for must hold numbers.
struct TriangleLanes {
    static constexpr int size = 8;
    alignas(64) double u[3][size]{}, v[3][size]{}, x[3][3][size]{}, slack[size]{};

    void set(std::size_t lane, std::size_t corner, const Vec2& uv, const Point& point) {
        u[corner][lane] = uv.x, v[corner][lane] = uv.y;
        x[corner][0][lane] = point.x, x[corner][1][lane] = point.y, x[corner][2][lane] = point.z;
    }
    void set(int lane, const CornerData& triangle) {
        for (std::size_t k = 0; k < 3; ++k) set(std::size_t(lane), k, triangle.uv[k], triangle.points[k]);
        slack[lane] = triangle.slack;
    }
};

struct LanesAsked {
    Measure measure = Measure::geometric;
    int parts = 1;       // third derivatives are enclosed over parts x parts pieces of the box
    bool least = false;  // what no finer cell could go below, as for bound_triangle()
    bool turns = false;  // turn as well
};

/// The first n triangles of each set: triangle i of every set must have the box of triangle i of the first one, whose model serves them all.
/// Those of set s begin at bounds[size s]. Thread-safe.
void bound_lanes(const PolynomialCell& cell, std::span<const TriangleLanes> sets, int n, const LanesAsked& asked, TriangleBound* bounds);
/// With the loops of one instruction set, which must run here.
void bound_lanes(Isa isa, const PolynomialCell& cell, std::span<const TriangleLanes> sets, int n, const LanesAsked& asked, TriangleBound* bounds);

}  // namespace isoparm
