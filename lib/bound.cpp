#include "bounds/proof.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isoparm {
namespace {

using rounding::product_up, rounding::up;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Right-handed frame with n along the surface normal where there is one. Orthonormal up to rounding.
std::array<Point, 3> frame_at(const Enclosure& e) {
    const auto middle = [](const Interval& x, const Interval& y, const Interval& z) { return Point{mid(x), mid(y), mid(z)}; };
    const Point su = middle(e.centre.x.c[1], e.centre.y.c[1], e.centre.z.c[1]), sv = middle(e.centre.x.c[2], e.centre.y.c[2], e.centre.z.c[2]);
    const Point n = normalized(cross(su, sv));
    // No normal, or one whose length underflowed: any orthonormal frame will do.
    if (!(std::fabs(dot(n, n) - 1) < 4e-15)) return {Point{0, 0, 1}, Point{1, 0, 0}, Point{0, 1, 0}};
    const Point axis = std::fabs(n.x) < 0.6 ? Point{1, 0, 0} : Point{0, 1, 0};
    const Point t = normalized(cross(axis, n));
    return {n, t, cross(n, t)};
}
/// |x|^2 <= kFrame^2 * sum (x . f_i)^2 for the frames above: their Gram matrix is the identity up to a few 1e-15.
constexpr double kFrame = 1 + 1e-14;

Interval along(const Point& f, const Interval& x, const Interval& y, const Interval& z) { return Interval(f.x) * x + Interval(f.y) * y + Interval(f.z) * z; }

/// Length of a vector from upper bounds of its components along a frame.
double length_bound(const std::array<double, 3>& c) { return up(rounding::length_up(c[0], c[1], c[2]) * kFrame); }

struct Edge {
    Interval du, dv;  // corner k+1 minus corner k
    double uu, vv;    // upper bounds of du^2, dv^2
};

}  // namespace

double slack_of(const Patch& patch, const Vec2& p, const Point& x) {
    const auto s = patch.enclose_point(p.x, p.y);
    return rounding::length_up(mag(Interval(x.x) - s.x), mag(Interval(x.y) - s.y), mag(Interval(x.z) - s.z));
}

bool along_line(const Vec2& a, const Vec2& b, const std::vector<double>& us, const std::vector<double>& vs) {
    const auto along = [](double x, double y, const std::vector<double>& lines) { return x == y && std::binary_search(lines.begin(), lines.end(), x); };
    return along(a.x, b.x, us) || along(a.y, b.y, vs);
}

Box box_of(const std::array<Vec2, 3>& p) {
    const auto [u0, u1] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [v0, v1] = std::minmax({p[0].y, p[1].y, p[2].y});
    return {{u0, u1}, {v0, v1}};
}

double simplex_maximum(double a, double b, double c) {
    if (std::isnan(a) || std::isnan(b) || std::isnan(c)) return kInfinity;  // std::max would pass over one
    const double largest = std::max({a, b, c});
    if (largest <= 0) return 0;
    const double edge = largest / 4;
    // On the plane l0 + l1 + l2 = 1 the form is concave iff all coefficients and D are positive; then its maximum over
    // the whole plane is abc/D, attained at l proportional to (b(a+c-b), c(a+b-c), a(b+c-a)) (opposite edge first).
    if (!(std::min({a, b, c}) > 0) || !std::isfinite(largest)) return std::isfinite(largest) ? edge : kInfinity;
    const double slack = -1e-12 * largest;
    if (a + c - b < slack || a + b - c < slack || b + c - a < slack) return edge;
    // The form grows with its coefficients: lifting tiny ones to 1e-7 of the largest keeps D above 3e-7 of its square
    // and costs 1e-7 at most; rounding errors of D, at most 24 units of 1.1e-16 of that square, are below 1e-8 of it.
    const double third = up(largest * kThird), scale = 1 / largest;
    if (!std::isfinite(scale)) return third;
    a = std::max(a * scale, 1e-7), b = std::max(b * scale, 1e-7), c = std::max(c * scale, 1e-7);
    const double D = 2 * (a * b + b * c + c * a) - (a * a + b * b + c * c);
    if (!(D > 3e-7)) return third;
    return std::max(edge, std::min(third, largest * (a * b * c / D) * (1 + 2e-8)));
}

TriangleBound bound_triangle(const Patch& patch, const std::array<Vec2, 3>& p, const std::array<Point, 3>& points) {
    const Box box = box_of(p);
    const Enclosure e = patch.enclose(box);
    const double ru = up(std::max(box.u.hi - e.u, e.u - box.u.lo)), rv = up(std::max(box.v.hi - e.v, e.v - box.v.lo));
    const auto frame = frame_at(e);

    std::array<Edge, 3> edges;
    for (int k = 0; k < 3; ++k) {
        const Vec2 &a = p[k], &b = p[(k + 1) % 3];
        Edge& g = edges[k];
        g.du = Interval(b.x) - Interval(a.x);
        g.dv = Interval(b.y) - Interval(a.y);
        g.uu = square(g.du).hi;
        g.vv = square(g.dv).hi;
    }
    const double aspect = ru > 0 && rv > 0 ? rv / ru : 1;

    std::array<double, 3> second{}, first{}, zeroth{};
    std::array<double, 3> curved{}, steep{};  // what each edge contributes to the two kinds of bound
    for (int f = 0; f < 3; ++f) {
        const auto centre = [&](int i, int j) {
            const int k = JetUV<Interval, 2>::index(i, j);
            return along(frame[f], e.centre.x.c[k], e.centre.y.c[k], e.centre.z.c[k]);
        };
        const auto over = [&](int i, int j) {
            const int k = JetUV<Interval, 3>::index(i, j);
            return along(frame[f], e.over.x.c[k], e.over.y.c[k], e.over.z.c[k]);
        };
        // Second derivatives at the middle, and how far they stray from there: by the third ones, or by their own range.
        const Interval huu = Interval(2) * centre(2, 0), huv = centre(1, 1), hvv = Interval(2) * centre(0, 2);
        const double tuuu = up(6 * mag(over(3, 0))), tuuv = 2 * mag(over(2, 1)), tuvv = 2 * mag(over(1, 2)), tvvv = up(6 * mag(over(0, 3)));
        const double suu = std::min(up(product_up(tuuu, ru) + product_up(tuuv, rv)), mag(Interval(2) * over(2, 0) - huu));
        const double suv = std::min(up(product_up(tuuv, ru) + product_up(tuvv, rv)), mag(over(1, 1) - huv));
        const double svv = std::min(up(product_up(tuvv, ru) + product_up(tvvv, rv)), mag(Interval(2) * over(0, 2) - hvv));
        // 2 |du dv| <= aspect du^2 + dv^2 / aspect makes the remainder a diagonal form, which adds up over the corners.
        const double quu = up(suu + product_up(suv, aspect)), qvv = up(svv + (Interval(suv) / Interval(aspect)).hi);
        std::array<double, 3> plus, minus;
        for (int k = 0; k < 3; ++k) {
            const Edge& g = edges[k];
            const Interval b = huu * square(g.du) + Interval(2) * huv * g.du * g.dv + hvv * square(g.dv);
            const double m = mid(b), q = up(rad(b) + up(product_up(quu, g.uu) + product_up(qvv, g.vv)));
            plus[k] = up(m + q);
            minus[k] = up(q - m);
            curved[k] += (std::fabs(m) + q) * (std::fabs(m) + q);
        }
        const double largest = std::max(simplex_maximum(plus[0], plus[1], plus[2]), simplex_maximum(minus[0], minus[1], minus[2]));
        second[f] = up(largest / 2);
        const Interval gu = over(1, 0), gv = over(0, 1), x = over(0, 0);
        first[f] = up(product_up(rad(gu), ru) + product_up(rad(gv), rv));
        zeroth[f] = up(x.hi - x.lo);
        for (int k = 0; k < 3; ++k) {
            const double d = rad(gu) * mag(edges[k].du) + rad(gv) * mag(edges[k].dv);
            steep[k] += d * d;
        }
    }
    const auto proved = [](const std::array<double, 3>& c) {
        const double b = length_bound(c);
        return std::isnan(b) ? kInfinity : b;
    };
    const auto useful = [](const std::array<double, 3>& c) { return std::isfinite(c[0] + c[1] + c[2]) && c[0] + c[1] + c[2] > 0; };
    TriangleBound result;
    const double smooth = proved(second), rough = std::min(proved(first), proved(zeroth));
    result.parametric = std::min(smooth, rough);
    std::array<double, 3> score = smooth <= rough ? curved : steep;
    if (!useful(score)) {
        // The edge that is longest in space, of those that are all but longest in the domain: bisecting shorter ones makes needles whose
        // boxes never shrink.
        const Rect r = patch.rect();
        std::array<double, 3> length;
        for (int k = 0; k < 3; ++k) length[k] = std::hypot(mid(edges[k].du) / (r.u1 - r.u0), mid(edges[k].dv) / (r.v1 - r.v0));
        const double longest = std::max({length[0], length[1], length[2]});
        for (int k = 0; k < 3; ++k) {
            const Point d = points[(k + 1) % 3] - points[k];
            score[k] = length[k] < 0.9 * longest ? -1 : dot(d, d);
        }
    }
    // Where two edges are all but equal, the longer one in the domain: the choice must not hang on rounding.
    const auto size = [&](int k) { return edges[k].uu + edges[k].vv; };
    for (int k = 1; k < 3; ++k) {
        const double best = score[result.worst_edge];
        if (score[k] > best + 1e-9 * std::fabs(best) || (score[k] >= best - 1e-9 * std::fabs(best) && size(k) > size(result.worst_edge) * (1 + 1e-9))) result.worst_edge = k;
    }
    return result;
}

namespace {

/// At least how far rounding to floats moves a unit vector: 2^-25 along each axis.
constexpr double kMoved = 6e-8;

const Point& unit_of(const TriangleBound& b) { return b.unit; }
Point unit_of(const Proof& p) { return p.normal_of_plane(); }

/// geometric_bound(); Bound and Side are TriangleBound and Neighbour, or what is kept of them.
template <class Bound, class Side> double with_neighbours(const Bound& t, const std::array<Side, 3>& neighbours, const Bound* Side::*bound) {
    if (!t.quiet) return t.parametric;
    double most = t.normal;
    for (int k = 0; k < 3; ++k) {
        const Bound* other = neighbours[k].*bound;
        const double beside = t.beside[k], across = t.across[k];
        const double apart = other && other->quiet ? (length(unit_of(t) - unit_of(*other)) + t.tilt + other->tilt) * (1 + 1e-14) + 1e-15 : 2;
        const double cosine = 1 - 0.5 * apart * apart, secant = 1 / cosine;  // at most that of the angle between the planes
        // Over the neighbour, or where there is none, over this triangle alone.
        const double beyond = cosine >= 0.95 ? std::max(beside, other->beside[neighbours[k].edge] * secant) + across * (apart * secant) : std::hypot(beside, across);
        most = std::max(most, beyond * (1 + 1e-14));
    }
    return std::min<double>(t.parametric, most);
}

}  // namespace

double geometric_bound(const TriangleBound& t, const std::array<Neighbour, 3>& neighbours) { return with_neighbours(t, neighbours, &Neighbour::bound); }
double geometric_bound(const Proof& t, const std::array<ProvedNeighbour, 3>& neighbours) { return with_neighbours(t, neighbours, &ProvedNeighbour::proof); }

Proof::Proof(const TriangleBound& b)
    : parametric(b.parametric), normal(b.normal), beside{b.beside[0], b.beside[1], b.beside[2]}, across{b.across[0], b.across[1], b.across[2]},
      unit{float(b.unit.x), float(b.unit.y), float(b.unit.z)}, tilt(b.tilt + kMoved), turn(b.turn), quiet(b.quiet), worst_edge(std::uint8_t(b.worst_edge) & 3),
      worst_turn(std::uint8_t(b.worst_turn) & 3), worst_across(std::uint8_t(b.worst_across) & 3) {}

Proof::operator TriangleBound() const {
    TriangleBound b;
    b.parametric = parametric, b.normal = normal, b.tilt = tilt, b.turn = turn;
    for (int k = 0; k < 3; ++k) b.beside[k] = beside[k], b.across[k] = across[k];
    b.unit = unit_of(*this);
    b.quiet = quiet, b.worst_edge = worst_edge, b.worst_turn = worst_turn, b.worst_across = worst_across;
    return b;
}

}  // namespace isoparm
