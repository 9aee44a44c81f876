// scene_include.h -- files that a scene names, beside it.
#pragma once
#include <string>

#include "scene_values.h"

namespace isoparm {

struct IncludedFile {
    std::string text, path;
};
/// The whole of the regular file that `name` (a string) names, relative to the scene; `what`: "a BV file". Throws LocatedError: where the scene names it.
IncludedFile read_included(const Json& name, const SceneValues& values, const std::string& what);

}  // namespace isoparm
