// limit_levels.h -- surfaces over the limit's curves around extraordinary vertices, level by level; and over Loop's regular triangles, halving by halving.
//
// The cell of level k in a face at an extraordinary vertex is 2^-k of the face at its corner; the n cells of a level make a ring of patches. The limit there is, level
// after level, nearly the same shape, smaller by lambda along the tangent plane and by mu in height. A surface that is built from
// its curves and tangents alone is off by as much: its deviation falls by lambda a level, the part along the normal by mu, the angle between the normals of two
// patches at their common edge by mu / lambda. All of it is measured at samples, against the exact limit of make_subdivision().
//
// Source: formula sheet F, F2 (P2, P4), B "observed approximation orders".
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limit.h"
#include "subdivision/limit_faces.h"
#include "subdivision/limit_subcells.h"

namespace isoparm {

struct LevelMeasures {
    std::optional<double> deviation, normal_deviation;  // at equal parameters; its part along the normal at the vertex
    std::optional<double> normal_degrees;               // between the normals of surface and limit
    std::optional<double> g1_degrees, c1;               // across the edges that end at the vertex: normals; derivatives in matched parameters
};
/// The worst of all extraordinary vertices of one valence. `vertices`: how many; those are left out at whose level another extraordinary
/// vertex without tangents, or the boundary, is at a corner of a cell.
struct LimitLevel {
    int level, valence;
    std::string method;
    int vertices;
    LevelMeasures measured;
    std::optional<double> ratio_deviation, ratio_normal, ratio_g1;  // to the level before, over the vertices that both levels have; none in the noise of rounding
};
struct LimitValence {
    int valence, vertices;
    double lambda, mu;
};
/// Loop's regular faces: the sub-triangles of 2^-level of the face about its centre.
struct LoopLevel {
    std::string method;
    int order, level;
    double deviation;
    std::optional<double> ratio;  // of the level before to this one: 2^order in the limit
};

struct LimitLevels {
    std::shared_ptr<const LimitFaces> faces;  // what was measured; none where every face is regular
    std::string refused;                      // why nothing was measured around vertices: make_subdivision()'s words
    std::vector<LimitValence> valences;
    std::vector<LimitLevel> by_level;  // by valence, method, level
    std::vector<char> compared;        // of each face of the cage: has it a cell at an extraordinary vertex?
    LevelMeasures worst;               // of the best method, each vertex at its first level
    SubcellReport subcells;
    std::optional<double> masks_gap;   // limit positions at the vertices refined once: make_subdivision() against OpenSubdiv's masks, where these are exact
    std::vector<LoopLevel> loop;
    std::optional<double> loop_edges;  // Nielson's surfaces over Loop's regular faces: positions and derivatives along the edges, against the limit
    /// What must be equal up to rounding is, within the tolerance.
    bool identities_hold(double tolerance) const {
        return subcells.deviation.value_or(0) <= tolerance && masks_gap.value_or(0) <= tolerance && loop_edges.value_or(0) <= tolerance;
    }
};

struct LevelOptions {
    int levels = 6;   // 0 to 12: the last level
    int samples = 9;  // each way over a cell; 2 to 65
};
/// Does not depend on the number of threads.
LimitLevels measure_levels(const LimitSurface& limit, const LevelOptions& options = {});

}  // namespace isoparm
