// limit_vertices.h -- the smooth extraordinary vertices of a cage, the faces around each, and how the limit surface shrinks there.
//
// Source: Catmull & Clark 1978; Loop 1987; Stam 1998 (eigenvalues); formula sheet F.
#pragma once
#include <string>
#include <vector>

#include "cage.h"

namespace isoparm {

/// What make_subdivision() calls the patch of a face, or of one of its corners.
std::string patch_name(int face, int corner = -1);

/// Subdominant eigenvalues of the subdivision matrix around a vertex of valence n: positions shrink by lambda a level, what leaves the tangent plane by mu.
struct Eigenvalues {
    double lambda, mu;
};
/// valence >= 3; scheme not bilinear.
Eigenvalues eigenvalues(Scheme scheme, int valence);

/// One face at an extraordinary vertex: the patch of make_subdivision() that covers it, and the corner of the patch's domain at the vertex, counted as the corners
/// of a face are. The whole patch is the cell of this level: 0 of the cage's own quads and triangles, 1 of those that its other faces are cut into.
struct LimitSector {
    int face;
    std::string patch;
    int corner, level;
};

/// A vertex of the cage, or the centre of a face that is not a quad, inside, without creases or sharpness, of valence 3 or more but not the regular one.
/// Each sector begins at the edge where the one before ends: the side of its patch from its corner to the one before is the next one's from its corner on.
struct ExtraordinaryVertex {
    std::string name;  // "vertex 3", "centre of face 5"
    int valence;
    std::vector<LimitSector> sectors;
};

/// In order of vertices, then of faces. The cage is one that make_subdivision() accepts. Empty for the bilinear scheme. Vertices with a hole beside them are left out.
std::vector<ExtraordinaryVertex> extraordinary_vertices(const Cage& cage, Scheme scheme);

}  // namespace isoparm
