// scene_file.h -- a scene of a text that is in memory already.
#pragma once
#include <map>
#include <string>

#include "scene/scene.h"

namespace isoparm {

/// As load_scene(), of what the file `path` holds; the path is for messages and for the folder of included files.
Scene parse_scene(const std::string& text, const std::string& path, const std::map<std::string, double>& overrides = {});

}  // namespace isoparm
