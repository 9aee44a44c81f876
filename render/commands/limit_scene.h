// commands/limit_scene.h -- `isoparm limit --scene SCENE --surface S`.
#pragma once
#include "commands/options.h"

namespace isoparm {

/// Returns the exit code.
int run_limit_scene(const Options& options);

}  // namespace isoparm
