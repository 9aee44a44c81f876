// limit_compare.h -- composite Coons surfaces built on an OpenSubdiv limit surface, and how far they are from it.
//
// Over every regular face the limit surface is bicubic, and Hermite Coons patches reproduce whatever is cubic in u or in
// v: the composite built from the knot-line curves, cross derivatives and twists alone must equal the limit surface up to
// rounding. That is an identity to test both programs by. Bilinear Coons patches on the same curves must not equal it.
//
// Source: formula sheet A4, A8, F2 (P0, P1); Farin, Curves and Surfaces for CAGD, 2002, ch. 22.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limit.h"
#include "patches/coons_hermite.h"

namespace isoparm {

/// The network's data over one regular face of a Catmull-Clark or bilinear limit surface. Boundary curves are the cubics
/// with the ends and end derivatives of the limit; cross derivatives the cubics through four of its values, at 0, 1/4,
/// 3/4, 1 of the edge, whose ends are the end tangents of the curves that start there (the same vectors up to rounding,
/// see network_gap). Neither the inside of the face nor its control points are looked at.
HermiteData limit_network(const LimitSurface& limit, int face);

struct LimitOptions {
    int samples = 17;  // each way over a face; at least 2
};

struct UncomparedFace {
    int face;
    std::string reason;
};

/// Everything here is measured at samples. Lengths in the units of the cage, angles in degrees; a measure that nothing
/// was there to take from is empty.
struct LimitReport {
    Scheme scheme = Scheme::catmull_clark;
    int faces = 0, regular = 0, irregular = 0, without_limit = 0;
    std::vector<UncomparedFace> not_compared;
    int samples = 0;      // each way over a face
    double size = 0;      // max |P| over the vertices that faces of the cage have
    double diagonal = 0;  // of the bounding box of these
    double tolerance = 0; // what the deviation and the network's gap may be: 200 eps max |P|

    std::optional<double> deviation, normal_degrees;  // composite Hermite Coons against the limit, regular faces
    int worst_face = -1;                              // where the deviation is largest
    double worst_u = 0, worst_v = 0;
    std::optional<double> network_gap;     // at the corners: curve tangents against OpenSubdiv's derivatives, twists of
                                           // the cross derivatives against each other and against OpenSubdiv's x_uv
    std::optional<double> bilinear_coons;  // the negative control: its deviation on the same boundary curves

    /// Across edges between two regular faces of the composite: jumps of position and of the first derivative across the
    /// edge, in matched parameters; angle of the normals. Creases are left out.
    struct Edges {
        int compared = 0, creases = 0;
        std::optional<double> c0, c1, g1_degrees;
    } edges;

    /// Deviation and network gap are within the tolerance (also when there was nothing to compare).
    bool identity_holds() const;
    /// So far from the origin that the tolerance, of rounding there, is more than 1e-6 of the diagonal: then that says nothing.
    bool hidden_by_rounding() const { return !(tolerance <= 1e-6 * diagonal); }
};

/// Faces of Loop's scheme are counted only. Safe to call from every thread; the result does not depend on their number.
LimitReport compare_limit(const LimitSurface& limit, const LimitOptions& options = {});

}  // namespace isoparm
