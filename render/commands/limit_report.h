// commands/limit_report.h -- what `isoparm limit` found, as text and as JSON.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "limit_compare.h"
#include "limit_levels.h"

namespace isoparm {

/// Names of the schemes, in the order of Scheme.
const std::vector<std::string>& limit_schemes();

struct LimitResult {
    std::string path;
    Cage cage;
    LimitReport regular;  // not_compared: also not as an irregular face
    LimitLevels irregular;
    std::vector<UncomparedFace> subcells_only;  // faces whose extraordinary vertices, if any, have no tangents

    bool identities_hold() const { return regular.identity_holds() && irregular.identities_hold(regular.tolerance); }
    bool something_compared() const { return regular.deviation || irregular.subcells.cells > 0 || !irregular.by_level.empty() || !irregular.loop.empty(); }
};

std::string limit_json(const LimitResult& result);
void print_limit(const LimitResult& result, std::ostream& out);

}  // namespace isoparm
