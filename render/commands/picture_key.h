// commands/picture_key.h -- everything that the pixels of a picture depend on.
#pragma once
#include <string>

#include "commands/options.h"
#include "picture/picture.h"

namespace isoparm {

/// Lines "name value", each name once: the program, the processor's instructions, digests of the scene and of all that it includes, parameters,
/// options. The files are read (again) for that. Throws Error(io).
std::string picture_key(const Scene& scene, const RenderOptions& how, const Options& options);

}  // namespace isoparm
