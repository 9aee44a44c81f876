// included_file.h -- the files that a scene names: they lie in its folder or below.
#pragma once
#include <string>

#include "scene/json.h"

namespace isoparm {

/// `name` relative to the folder of the file that `j` is in. Throws LocatedError unless that is, links followed, a regular file in that folder or
/// below it, or no file at all (reading it tells). Whoever sends a scene must not read others' files by it.
std::string included_file(const Json& j, const std::string& name);

struct IncludedFile {
    std::string text, path;
};

}  // namespace isoparm
