// subdivision_cell.h -- regular faces and sub-faces of a subdivision surface as polynomials; internal to subdivision.cpp.
#pragma once
#include <vector>

#include "cage.h"
#include "scalar/polynomial.h"

namespace isoparm {

/// A regular sub-face: polynomials in (u,v) - centre of the face's parameters.
struct SubdivisionCell {
    double u, v;  // the centre
    Vec3<Polynomial> exact;
    int degree;
    std::vector<Point> c;  // the middles of the coefficients, at (degree + 1) i + j
};

/// A square or triangle with the corner (u,v) and the sides h along u and v (below 0: turned by half).
struct FacePlace {
    double u, v, h;
    Interval across_u() const { return h > 0 ? Interval(u, u + h) : Interval(u + h, u); }
    Interval across_v() const { return h > 0 ? Interval(v, v + h) : Interval(v + h, v); }
    FacePlace child(int k, bool triangle) const {
        const double half = h / 2;
        if (!triangle) return {k == 1 || k == 2 ? u + half : u, k >= 2 ? v + half : v, half};
        return k == 3 ? FacePlace{u + half, v + half, -half} : FacePlace{k == 1 ? u + half : u, k == 2 ? v + half : v, half};
    }
};

/// The piece of the limit surface with these control points, in the order of Subdivider::regular().
SubdivisionCell make_subdivision_cell(const std::vector<Vec3<Interval>>& control, const FacePlace& at, Scheme scheme);

/// The same, translated.
SubdivisionCell moved(SubdivisionCell cell, const Vec3<Interval>& by);

/// The Bezier points of a regular face, from its 16 or 12 control points: of Catmull-Clark at 4 i + j, i along u; of Loop
/// in the order of make_bezier_triangle.
std::vector<Point> bezier_points(const std::vector<Vec3<Interval>>& control, Scheme scheme);

}  // namespace isoparm
