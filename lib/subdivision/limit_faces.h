// limit_faces.h -- the exact limit surface over all faces of a cage, with the tangents of its extraordinary vertices: what cells are cut from.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "subdivision/limit_cell.h"
#include "subdivision/limit_vertices.h"

namespace isoparm {

struct LimitFaces {
    std::map<std::string, Patch> patches;          // make_subdivision()'s
    std::map<std::string, FaceTangents> tangents;  // by OpenSubdiv's masks, of the patches that have such corners
    std::optional<double> masks_gap;               // limit positions at the vertices refined once, where the masks are exact

    /// Throws Error(input), Error(budget) as make_subdivision() does.
    LimitFaces(const Cage& cage, Scheme scheme);
    /// The cell of that level; none where it would be more than the patch, or has a corner without tangents.
    std::optional<LimitCell> cell(const LimitSector& sector, int level) const;
};

}  // namespace isoparm
