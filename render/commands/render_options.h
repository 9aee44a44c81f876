// commands/render_options.h -- what the commands that make pictures share.
#pragma once
#include <string>

#include "commands/options.h"
#include "picture.h"

namespace isoparm {
/// --size, --samples, --tolerance, --crop. Throws Error(usage).
RenderOptions read_render_options(const Options& options);
/// --aov, in the order of all_aovs(), for a picture of that name. Throws Error(usage).
std::vector<Aov> read_aovs(const Options& options, const std::string& output);
/// Scene, tolerance and certified error, for the file.
Metadata metadata_of(const Scene& scene, const Picture& picture);
/// "1024x768, 12345 triangles, certified error 1e-5, 2.3 s"
std::string summary_of(const Picture& picture);
}  // namespace isoparm
