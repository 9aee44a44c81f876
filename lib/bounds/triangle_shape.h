// triangle_shape.h -- a triangle of a patch against a model of the second derivatives: where its bound comes from; internal to bound_cell.cpp.
#pragma once
#include "bound.h"
#include "bounds/quiet.h"
#include "bounds/second_derivatives.h"

namespace isoparm {

/// A triangle in the box of a bounded model: its edges, and the model's derivatives along them. Refers to both.
class TriangleShape {
public:
    TriangleShape(const SecondDerivatives& model, const CornerData& triangle);

    /// `least`, `turns` as for bound_triangle(). `quick`: parametric may be larger than it has to be where the triangle is quiet.
    TriangleBound bound(Measure measure, bool least, bool turns, bool quick) const;
    /// Of a quiet triangle: bound().normal with `least`.
    double least_normal() const;

private:
    /// What the radii of a bound, or of `least`, begin with.
    struct Stray {
        bool least;
        std::array<double, 3> model;  // by which H(m) itself is uncertain
    };
    Stray stray_of(bool least) const;
    /// At least how far H[e_k,e_k] strays from H(m)[e_k,e_k] in the triangle, along unit vectors along which third derivatives are at most `size`.
    std::array<double, 3> stray(const Stray& of, const std::array<double, 4>& size) const;
    std::array<double, 3> stray_along(const Stray& of, const Point& f) const;
    std::array<double, 3> stray_vaguely(const Stray& of) const;
    std::array<double, 3> along_normal() const { return {dot(n_, b_[0]), dot(n_, b_[1]), dot(n_, b_[2])}; }
    EdgeBend on_edge(const Stray& of, int k) const;
    int choose_edge(const std::array<double, 3>& score) const;
    double noise() const { return 8 * (noise_[0] + noise_[1] + noise_[2]); }
    double parametric(const std::array<double, 3>& q, bool least) const;

    const SecondDerivatives& s_;
    const CornerData& triangle_;
    double mu_, mv_, ru_, rv_, aspect_[2];  // rv_ / ru_ and ru_ / rv_; middle and half-widths of the triangle's box
    std::array<Point, 3> b_, x_;         // H(m)[e,e], and the mesh's edges
    std::array<double, 3> uu_, uv_, vv_, noise_, side_;  // noise: what rounding in H[e,e] is relative to
    double twice_area_, per_area_, longest_;  // per_area_: its reciprocal
    bool flat_;  // else too thin, or too small, to have a normal
    Point n_;
};

}  // namespace isoparm
