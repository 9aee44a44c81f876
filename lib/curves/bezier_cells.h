// bezier_cells.h -- a surface as the Bezier patches that it is between its breaks, for programs that know no other surfaces.
#pragma once
#include <vector>

#include "patch.h"

namespace isoparm {

/// One cell between breaks: x(u,v) = sum_ij w_ij p_ij B_i(s) B_j(t) / sum_ij w_ij B_i(s) B_j(t) in Bernstein polynomials of the
/// degrees, with s = (u - u0) / (u1 - u0) and t = (v - v0) / (v1 - v0) from 0 to 1 (Farin 2002, ch. 14).
struct BezierCell {
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
    int degree_u = 1, degree_v = 1;
    std::vector<Point> poles;     // (degree_u + 1) x (degree_v + 1), u-major
    std::vector<double> weights;  // as many, or empty: polynomial

    /// Rounded, for tests and samples.
    Point operator()(double u, double v) const;
};

/// The cells between breaks, u-major, of the lowest degree, up to rounding; on the triangular domain one, over the unit square. None where a
/// cell is neither polynomial nor known as rational, a weight is not positive, or a degree is above `max_degree`.
std::vector<BezierCell> bezier_cells(const Patch& patch, int max_degree = 9);

/// From coefficients c[i * (q + 1) + j] of x^i y^j, x and y from -hu to hu and -hv to hv, those of Bernstein polynomials of degrees p, q.
std::vector<double> bernstein_from_centred(const std::vector<double>& c, int p, int q, double hu, double hv);

}  // namespace isoparm
