// certificate_cover.h -- what the triangles of a certificate cover, by exact comparisons; internal to certificate_check.cpp.
#pragma once
#include <string>
#include <vector>

#include "certificate.h"
#include "scalar/interval.h"

namespace isoparm {

/// Which point of the surface belongs to a point of a triangle: its parameters are cubic in the barycentric coordinates l of the point, with these
/// Bernstein coefficients; that of l0^i l1^j l2^k stands at (3 - i)(4 - i) / 2 + k.
struct CertifiedNet {
    std::array<Interval, 10> u, v;
};

/// One patch of a certificate, and the cells between its breaks. Corners name vertices and finite parameters.
class Cover {
public:
    Cover(const Patch& patch, const CertifiedPatch& claim);

    CertifiedNet net_of(const CertifiedTriangle& t) const;

    /// Why the triangles are no triangulation of the domain whose slides keep its border and its cells; empty when they are one.
    std::string fault() const;

    /// The cell of a triangle between breaks, which holds it and the control points of its edges.
    Box cell_of(const CertifiedTriangle& t) const;

private:
    /// A side of the domain, counter-clockwise: where its points are, and a parameter that grows along it.
    struct Side {
        bool vertical, third;
        double level, sign, from, to;
        bool holds(const Vec2& p) const;
        bool along(const Vec2& slide) const { return third ? slide.x == -slide.y : (vertical ? slide.x : slide.y) == 0; }
        double at(const Vec2& p) const { return sign * (vertical || third ? p.y : p.x); }
    };
    std::string triangle_fault(const CertifiedTriangle& t) const;
    std::string edge_fault() const;
    std::string border_fault(std::vector<std::vector<std::array<double, 2>>>& border) const;

    const Patch& patch_;
    const CertifiedPatch& claim_;
    std::vector<double> us_, vs_;
    std::vector<Side> sides_;
};

}  // namespace isoparm
