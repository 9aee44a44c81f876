#include "subdivision/limit_faces.h"

#include <cmath>

#include "limit.h"
#include "subdivision.h"

namespace isoparm {
namespace {

/// Of the patch; -1 for samples elsewhere.
int corner(const LimitSample& s, Scheme scheme) {
    if ((s.u != 0 && s.u != 1) || (s.v != 0 && s.v != 1)) return -1;
    return scheme == Scheme::loop ? (s.u == 1 ? 1 : s.v == 1 ? 2 : 0) : s.u == 1 ? (s.v == 1 ? 2 : 1) : s.v == 1 ? 3 : 0;
}

}  // namespace

LimitFaces::LimitFaces(const Cage& cage, Scheme scheme) {
    for (const Member& m : make_subdivision(cage, scheme).patches) patches.emplace(m.name, m.patch);
    for (const LimitSample& s : limit_samples(cage, scheme, 1)) {
        const std::string name = patch_name(s.face, s.corner);
        const auto patch = patches.find(name);
        if (patch == patches.end()) continue;
        if (s.exact) {
            const double gap = distance(patch->second.point(s.u, s.v), s.p);
            if (!masks_gap || !(gap <= *masks_gap)) masks_gap = gap;
        }
        if (const int k = corner(s, scheme); k >= 0 && finite(s.next)) tangents[name][k] = {s.next, s.previous};
    }
}

std::optional<LimitCell> LimitFaces::cell(const LimitSector& s, int level) const {
    const auto found = patches.find(s.patch);
    if (level < s.level || found == patches.end()) return {};
    const Patch& patch = found->second;
    const auto known = tangents.find(s.patch);
    LimitCell cell(patch.domain(), limit_function(patch), s.corner, std::ldexp(1.0, s.level - level), known == tangents.end() ? FaceTangents{} : known->second);
    return cell.complete() ? std::optional(cell) : std::nullopt;
}

}  // namespace isoparm
