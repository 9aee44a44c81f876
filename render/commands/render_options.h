// commands/render_options.h -- what the commands that make pictures share.
#pragma once
#include <string>

#include "commands/options.h"
#include "picture.h"

namespace isoparm {
/// --size, --samples, --tolerance, --crop. Throws Error(usage).
RenderOptions read_render_options(const Options& options);
/// Scene, tolerance and certified error, for the file.
Metadata metadata_of(const Scene& scene, const Picture& picture);
/// "1024x768, 12345 triangles, certified error 1e-5, 2.3 s"
std::string summary_of(const Picture& picture);
}  // namespace isoparm
