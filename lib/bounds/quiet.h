// quiet.h -- how a surface bends over a triangle and along its edges, and when the triangle is quiet; (Q1) and (Q2) of
// docs/certificates.md, which has the proofs. In plain doubles; their callers add what rounding may do. Thread-safe.
#pragma once
#include <array>
#include <cmath>

#include "bound.h"
#include "scalar/vec.h"

namespace isoparm {

/// Times the sum of the absolute terms: at least the rounding error of H(m)[e,e] and of its products with unit vectors.
inline constexpr double kRounding = 64 * 0x1p-53;
/// The largest value of s (1 - s) |2 s - 1| on [0,1], sqrt(3)/18, rounded up.
inline constexpr double kOdd = 0.0963;
/// 1/(6 * 27), rounded up.
inline constexpr double kInner = 1.0 / 162 * (1 + 0x1p-52);

/// The edge after edge k, and the corner after corner k.
inline constexpr std::array<int, 3> kNext{1, 2, 0};

/// H[x,x] at a point q of the domain as the linear function of q that it is where third derivatives t are constant.
struct ThirdDerivatives {
    const std::array<Point, 4>& t;  // S_uuu, S_uuv, S_uvv, S_vvv

    /// Its change from q to q + d.
    Point operator()(const Vec2& x, const Vec2& d) const {
        return x.x * x.x * (d.x * t[0] + d.y * t[1]) + 2 * x.x * x.y * (d.x * t[1] + d.y * t[2]) + x.y * x.y * (d.x * t[2] + d.y * t[3]);
    }
};

/// H[e,e] along an edge e of the domain: within `off` of middle + sigma end, sigma from -1 to 1.
struct EdgeBend {
    Point middle, end;
    double off = 0;

    /// At least the length of H[e,e] anywhere on the edge.
    double largest() const { return length(middle) + length(end) + off; }
    /// S - L along the unit vector f is at most s (1 - s)/2 times that, s from 0 to 1 along the edge.
    double along(const Point& f) const { return std::fabs(dot(f, middle)) + std::fabs(dot(f, end)) * kThird + off; }
};

/// -n.(S - L) over a triangle, for third derivatives that are constant: half of sum form_k l_k l_k+1, and a rest.
class CubicForm {
public:
    /// `b`: n.H[e_k,e_k] at the point m of the domain, t the third derivatives, uv the triangle's corners.
    CubicForm(const Point& n, const std::array<double, 3>& b, const std::array<Point, 4>& t, const std::array<Vec2, 3>& uv, const Vec2& m);

    /// At least |n.(S - L)|, where H strays by forms q_k >= 0 at most from what it would be.
    double largest(const std::array<double, 3>& q) const;
    /// The same for points whose barycentric coordinate opposite edge k is at most `wide`.
    double beside(int k, const std::array<double, 3>& q, double wide) const;

private:
    std::array<double, 3> form_;
    double rest_ = 0;
};

/// max over the simplex of |sum l_i l_j b_k| for the worse sign of b, with q_k >= 0 added to both.
double largest_form(const std::array<double, 3>& b, const std::array<double, 3>& q);

/// DS[e_k] at the corners, were H equal to H(m) all over the triangle: linear in between. x: the mesh's edges, b = H(m)[e_k,e_k].
std::array<Point, 3> along_edge(int k, const std::array<Point, 3>& x, const std::array<Point, 3>& b);

/// Half of what Lemma 5 allows two lenses that meet at a corner, errors of lengths included.
inline constexpr double kLens = 0.39;
/// (Q1), its second part: lenses around the edges meet at corners only. lens_k = (P_k + 0.32 N_k) l_k / (2 l_k - B_k).
bool lenses_apart(const std::array<double, 3>& lens, const std::array<double, 3>& side, double twice_area);

/// (Q2): the map to the plane across n has a positive Jacobian all over the triangle. q: what H may be off by; bend: at least |b| + q.
bool keeps_orientation(const Point& n, const std::array<Point, 3>& x, const std::array<Point, 3>& b, const std::array<double, 3>& q, const std::array<double, 3>& bend, double tilt);

}  // namespace isoparm
