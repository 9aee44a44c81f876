// commands/limit_report.h -- what `isoparm limit` found, as text and as JSON.
#pragma once
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "commands/limit_view.h"
#include "subdivision/limit_compare.h"
#include "subdivision/limit_levels.h"

namespace isoparm {

/// Names of the schemes, in the order of Scheme.
const std::vector<std::string>& limit_schemes();

struct LimitResult {
    std::string path;
    Cage cage;
    LimitReport regular;  // not_compared: also not as an irregular face
    LimitLevels irregular;
    std::vector<UncomparedFace> subcells_only;  // faces whose extraordinary vertices, if any, have no tangents
    std::optional<LimitView> view;              // the image-space form, where it was asked for and there is something to draw

    /// Is everything equal that must be? Nothing where there is no such thing, or rounding hides it.
    std::optional<bool> identity() const;
    bool something_compared() const;
    /// For a reader, where regular.hidden_by_rounding().
    std::string rounding_note() const;
};

std::string limit_json(const LimitResult& result);
void print_limit(const LimitResult& result, std::ostream& out);

}  // namespace isoparm
