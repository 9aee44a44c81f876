// limit.h -- the limit surface of a subdivision cage, as OpenSubdiv evaluates it (Bfr, double precision).
//
// Every face of the cage is parametrized by OpenSubdiv's convention: a quad by [0,1]^2 with its first vertex at (0,0), its
// second at (1,0) and its last at (0,1). Edge k of a face runs from its vertex k to its vertex k+1.
//
// Regular faces only: there the limit surface is a single bicubic patch (Catmull-Clark), also at boundaries and along
// infinitely sharp creases, and OpenSubdiv evaluates it exactly up to rounding. Elsewhere it approximates. This is more
// than Bfr's own IsRegular(), which says no wherever an edge is sharp.
//
// Source: OpenSubdiv 3.5, Bfr; Catmull & Clark 1978; formula sheet F, F2.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "cage.h"

namespace isoparm {

/// Position and derivatives of the limit surface in the parameters of its face.
struct LimitPoint {
    Point p, du, dv, duu, duv, dvv;
};

/// regular: a single patch; irregular: infinitely many; none: a hole, or a face that the boundary rule leaves out.
enum class LimitFace { regular, irregular, none };

/// One edge between two faces. Walking along it, edge `edge` of `face` runs one way; the other face runs it the same way
/// when `same_direction`, else (as in consistently oriented cages) the opposite way.
struct LimitEdge {
    struct Side {
        int face, edge;
    };
    Side a, b;
    bool same_direction;
    bool smooth;  // no crease: both faces are meant to join without a fold
};

class LimitSurface {
public:
    /// Throws Error(input) when indices are out of range, a face is degenerate or of a size that the scheme does not know,
    /// the cage is smaller than 1e-70 or larger than 1e70, and with OpenSubdiv's own words when it refuses the cage. (OpenSubdiv reports through a global function, so
    /// construction takes a lock.) Afterwards immutable, cheap to copy, and safe to call from every thread.
    LimitSurface(const Cage& cage, Scheme scheme);

    const Cage& cage() const;
    Scheme scheme() const;
    int faces() const;
    LimitFace kind(int face) const;
    /// Why a face is not regular: "extraordinary vertex of valence 5", "face of 6 vertices" ...
    std::string reason(int face) const;
    /// Does every edge have two faces at most, and every vertex a single fan of them?
    bool manifold() const;
    /// Edges that exactly two different faces share, in the order of their first face.
    std::vector<LimitEdge> shared_edges() const;

    /// `face` must be regular; (u,v) in [0,1]^2, or in the triangle u,v >= 0, u + v <= 1 for Loop.
    LimitPoint operator()(int face, double u, double v) const;

private:
    struct Impl;
    std::shared_ptr<const Impl> impl_;
};

/// A vertex of the cage refined `levels` times and its limit position by OpenSubdiv's masks. (u,v) are parameters of the face, or of its corner's
/// quad, [0,1]^2 from that corner, when it is not as the scheme's faces are. One for each face that the vertex belongs to.
struct LimitSample {
    int face, corner;  // -1: the whole face
    double u, v;
    Point p, normal;  // unit, by OpenSubdiv's tangents; NaN at creases and sharp corners, which have several, and where these are not the
                      // limit's: on boundaries of Catmull-Clark cages but for two faces at the vertex
    Point next, previous;  // directions, of some length, of the limit along the two sides of the refined face that begin at the vertex, by the same tangents; NaN
                           // but at smooth vertices inside
    bool exact;  // OpenSubdiv's mask is that of the limit: not so at the end of a crease, at valence 2, and where something semi-sharp is left
};
/// Throws as LimitSurface does.
std::vector<LimitSample> limit_samples(const Cage& cage, Scheme scheme, int levels);

}  // namespace isoparm
