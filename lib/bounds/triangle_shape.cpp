#include "bounds/triangle_shape.h"

#include <algorithm>
#include <cmath>

#include "bounds/bound_cell.h"
#include "scalar/safe.h"

namespace isoparm {
namespace {

/// Right-handed orthonormal frame (up to 1e-15) whose first vector is n, or the axes where n is no unit vector.
std::array<Point, 3> frame_of(const Point& n) {
    if (!(std::fabs(dot(n, n) - 1) < 4e-15)) return {Point{0, 0, 1}, Point{1, 0, 0}, Point{0, 1, 0}};
    const Point t = normalized(cross(std::fabs(n.x) < 0.6 ? Point{1, 0, 0} : Point{0, 1, 0}, n));
    return {n, t, cross(n, t)};
}

/// An upper bound of the tangent of the angle between n and the normals of S: x the mesh's edges, b = H(m)[e_k,e_k], q what H strays from it
/// along e_k, slack how far the mesh's corners are from S. `worst`: the edge along which the normal turns most.
double turn_of(const Point& n, const std::array<Point, 3>& x, const std::array<Point, 3>& b, const std::array<double, 3>& q, const std::array<double, 3>& side, double slack,
               int& worst) {
    const std::array<Point, 3> first = along_edge(0, x, b), second = along_edge(1, x, b);
    std::array<Point, 3> normal;
    for (int c = 0; c < 3; ++c) normal[c] = normalized(cross(first[c], second[c]));
    const double extent = std::max({side[0], side[1], side[2]});
    const bool known = finite(normal[0]) && finite(normal[1]) && finite(normal[2]);
    // Slivers have no bound: an edge counts by its length as well, and alone where normals do not exist.
    const auto turned = [&](int k) { return (known ? length(normal[kNext[k]] - normal[k]) : 0) + 0.3 * side[k] / extent; };
    worst = turned(0) >= turned(1) && turned(0) >= turned(2) ? 0 : turned(1) >= turned(2) ? 1 : 2;
    double longest[2] = {0, 0}, off[2];
    for (int c = 0; c < 3; ++c) longest[0] = std::max(longest[0], length(first[c])), longest[1] = std::max(longest[1], length(second[c]));
    for (int k = 0; k < 2; ++k) off[k] = 0.5 * (q[0] + q[1] + q[2] + q[k]) + 2 * slack + kRounding * (side[k] + longest[k]);
    const double loose = safe(longest[0] * off[1] + longest[1] * off[0] + off[0] * off[1] + kRounding * longest[0] * longest[1]);
    // The cross product of DS[e_0] and DS[e_1] is quadratic, in the convex cone of its Bernstein coefficients.
    double turn = 0;
    for (int c = 0; c < 3; ++c)
        for (int d = c; d < 3; ++d) {
            const Point m = 0.5 * (cross(first[c], second[d]) + cross(first[d], second[c]));
            const double up = dot(n, m) - loose;
            if (!(up > 0)) return TriangleBound::none;
            turn = std::max(turn, safe((length(m - dot(n, m) * n) + loose) / up));
        }
    return turn;
}

}  // namespace

TriangleShape::TriangleShape(const SecondDerivatives& s, const CornerData& triangle) : s_(s), triangle_(triangle) {
    const auto& p = triangle.uv;
    const Box box = box_of(p);
    mu_ = mid(box.u), mv_ = mid(box.v);
    ru_ = std::max(box.u.hi - mu_, mu_ - box.u.lo), rv_ = std::max(box.v.hi - mv_, mv_ - box.v.lo);
    const bool wide = ru_ > 0 && rv_ > 0;
    aspect_[0] = wide ? rv_ / ru_ : 1, aspect_[1] = wide ? ru_ / rv_ : 1;
    const double du = mu_ - s.u, dv = mv_ - s.v;
    std::array<Point, 3> h;  // at (mu, mv)
    for (int k = 0; k < 3; ++k) h[k] = s.h[k] + du * s.t[k] + dv * s.t[k + 1];
    for (int k = 0; k < 3; ++k) {
        const double eu = p[kNext[k]].x - p[k].x, ev = p[kNext[k]].y - p[k].y;
        uu_[k] = eu * eu, uv_[k] = eu * ev, vv_[k] = ev * ev;
        b_[k] = uu_[k] * h[0] + 2 * uv_[k] * h[1] + vv_[k] * h[2];
        noise_[k] = kRounding * (uu_[k] * s.h_size[0] + 2 * std::fabs(uv_[k]) * s.h_size[1] + vv_[k] * s.h_size[2]);
        x_[k] = triangle.points[kNext[k]] - triangle.points[k];
        side_[k] = length(x_[k]);
    }
    const Point normal = cross(x_[0], x_[1]);
    twice_area_ = length(normal), per_area_ = 1 / twice_area_, longest_ = std::max({side_[0], side_[1], side_[2]});
    flat_ = twice_area_ > 1e-9 * longest_ * longest_ && twice_area_ > 1e-140;
    n_ = flat_ ? per_area_ * normal : Point{};
}

TriangleShape::Stray TriangleShape::stray_of(bool least) const {
    const double au = std::fabs(mu_ - s_.u), av = std::fabs(mv_ - s_.v);
    Stray of{least, {}};
    for (int k = 0; k < 3; ++k) of.model[k] = (s_.h_rad[k] + s_.t_rad[k] * au + s_.t_rad[k + 1] * av) * (least ? -1 : 1);
    return of;
}

std::array<double, 3> TriangleShape::stray(const Stray& of, const std::array<double, 4>& size) const {
    const auto& model = of.model;
    const double suu = model[0] + size[0] * ru_ + size[1] * rv_, suv = model[1] + size[1] * ru_ + size[2] * rv_, svv = model[2] + size[2] * ru_ + size[3] * rv_;
    // 2 |du dv| <= aspect du^2 + dv^2 / aspect makes the form diagonal, which adds up over the corners.
    const double quu = suu + suv * aspect_[0], qvv = svv + suv * aspect_[1];
    std::array<double, 3> q;
    for (int k = 0; k < 3; ++k) q[k] = safe(quu * uu_[k] + qvv * vv_[k] + noise_[k]);
    return q;
}

std::array<double, 3> TriangleShape::stray_along(const Stray& of, const Point& f) const {
    std::array<double, 4> along;
    for (int k = 0; k < 4; ++k) along[k] = std::max(0.0, std::fabs(dot(f, s_.t[k])) + (of.least ? -s_.t_rad[k] : s_.t_rad[k]) + 4 * 0x1p-53 * s_.t_size[k]);
    return stray(of, along);
}

std::array<double, 3> TriangleShape::stray_vaguely(const Stray& of) const {
    std::array<double, 4> vague;
    for (int k = 0; k < 4; ++k) vague[k] = of.least ? -s_.t_rad[k] : s_.t_rad[k];
    return stray(of, vague);
}

/// Third derivatives with their signs, where they hardly vary: how H bends along an edge.
EdgeBend TriangleShape::on_edge(const Stray& of, int k) const {
    const auto& p = triangle_.uv;
    const ThirdDerivatives third{s_.t};
    const Vec2 &from = p[k], &to = p[kNext[k]], e{to.x - from.x, to.y - from.y};
    const std::array<double, 4> r = of.least ? std::array<double, 4>{} : s_.t_rad;
    const double off = uu_[k] * (of.model[0] + r[0] * ru_ + r[1] * rv_) + 2 * std::fabs(uv_[k]) * (of.model[1] + r[1] * ru_ + r[2] * rv_) +
                       vv_[k] * (of.model[2] + r[2] * ru_ + r[3] * rv_);
    return EdgeBend{b_[k] + third(e, {0.5 * ((from.x - mu_) + (to.x - mu_)), 0.5 * ((from.y - mv_) + (to.y - mv_))}), 0.5 * third(e, e), std::max(0.0, off) + 8 * noise_[k]};
}

/// Where two edges are all but equal, the longer one in the domain: the choice must not hang on rounding.
int TriangleShape::choose_edge(const std::array<double, 3>& score) const {
    int best = 0;
    for (int k = 1; k < 3; ++k) {
        const double size_k = uu_[k] + vv_[k], size_best = uu_[best] + vv_[best];
        if (score[k] > score[best] * (1 + 1e-9) || (score[k] >= score[best] * (1 - 1e-9) && size_k > size_best * (1 + 1e-9))) best = k;
    }
    return best;
}

double TriangleShape::parametric(const std::array<double, 3>& q, bool least) const {
    std::array<double, 3> most;
    const auto frame = frame_of(n_);
    for (int f = 0; f < 3; ++f) most[f] = largest_form({dot(frame[f], b_[0]), dot(frame[f], b_[1]), dot(frame[f], b_[2])}, least ? q : noise_);
    return safe(0.5 * (rounding::length_up(most[0], most[1], most[2]) + simplex_maximum(q[0], q[1], q[2])));
}

double TriangleShape::least_normal() const {
    const Stray of = stray_of(true);
    const std::array<double, 3> bn = along_normal();
    const CubicForm cubic(n_, bn, s_.t, triangle_.uv, {mu_, mv_});
    return safe(std::min(0.5 * largest_form(bn, stray_along(of, n_)), cubic.largest(stray_vaguely(of))) + noise());
}

TriangleBound TriangleShape::bound(Measure measure, bool least, bool turns, bool quick) const {
    TriangleBound result;
    const Stray of = stray_of(least);
    std::array<double, 4> size = s_.t_size;
    if (least)
        for (int k = 0; k < 4; ++k) size[k] = std::max(0.0, size[k] - 2 * s_.t_rad[k]);
    const std::array<double, 3> q = stray(of, size);
    std::array<double, 3> bend;  // at least |H[e,e]| anywhere in the triangle
    for (int k = 0; k < 3; ++k) bend[k] = safe(length(b_[k]) + q[k]);
    result.worst_edge = result.worst_across = choose_edge(bend);
    const bool planar = measure == Measure::geometric && flat_;
    result.parametric = quick && planar ? safe(0.5 * simplex_maximum(bend[0], bend[1], bend[2])) : parametric(q, least);
    if (!planar) return result;

    const double slack = triangle_.slack;
    result.unit = n_;
    result.tilt = safe((8.1 * slack * (longest_ + slack) + 33 * 0x1p-53 * longest_ * longest_) * per_area_ + 6 * 0x1p-53);
    if (turns && !least) result.turn = turn_of(n_, x_, b_, q, side_, slack, result.worst_turn);
    const std::array<double, 3> qn = stray_along(of, n_), bn = along_normal();
    result.worst_edge = choose_edge({std::fabs(bn[0]) + qn[0], std::fabs(bn[1]) + qn[1], std::fabs(bn[2]) + qn[2]});
    std::array<double, 3> across, lens;  // across: at least |inward . H[e_k,e_k]| as far as the edge's deviation goes
    bool quiet = result.tilt <= 1e-3;
    for (int k = 0; k < 3; ++k) {
        const EdgeBend edge = on_edge(of, k);
        const Point inward = (1 / side_[k]) * cross(n_, x_[k]);  // in the plane
        const double any = safe(edge.largest());
        across[k] = safe(edge.along(inward) + 2 * result.tilt * any);
        lens[k] = safe(across[k] + 0.32 * (edge.along(n_) + result.tilt * any)) * side_[k] / (2 * side_[k] - any);
        quiet = quiet && any <= side_[k] && bend[k] <= 1.5 * longest_;
    }
    if (!quiet || !lenses_apart(lens, side_, twice_area_) || !keeps_orientation(n_, x_, b_, q, bend, result.tilt)) {
        if (quick) result.parametric = std::min(result.parametric, parametric(q, least));
        return result;
    }
    result.quiet = true;
    const CubicForm cubic(n_, bn, s_.t, triangle_.uv, {mu_, mv_});
    const std::array<double, 3> off = stray_vaguely(of);
    const double rounding = noise() + result.tilt * result.parametric;
    result.normal = safe(std::min(0.5 * largest_form(bn, qn), cubic.largest(off)) + rounding);
    for (int k = 0; k < 3; ++k) {
        const double wide = safe(1.06 * result.parametric * side_[k] * per_area_);  // see Lemma 6
        result.beside[k] = std::min(result.normal, safe(cubic.beside(k, off, wide) + rounding));
        result.across[k] = safe(across[k] / 8);
    }
    return result;
}

TriangleBound bound_triangle(const SecondDerivatives& s, const CornerData& triangle, Measure measure, bool least, bool turns) {
    return s.bounded ? TriangleShape(s, triangle).bound(measure, least, turns, false) : TriangleBound{};
}

}  // namespace isoparm
