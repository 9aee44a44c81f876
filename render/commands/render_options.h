// commands/render_options.h -- what the commands that make pictures share.
#pragma once
#include <string>

#include "commands/options.h"
#include "picture/picture.h"

namespace isoparm {
/// WIDTHxHEIGHT after the option of that name, when it is given, each from `least` to `most`. Throws Error(usage).
std::optional<std::array<int, 2>> read_size(const Options& options, const std::string& name, int least, int most);
/// --size, --width, --dpi, --font-size, --samples, --noise, --tolerance, --crop. Throws Error(usage).
RenderOptions read_render_options(const Options& options);
/// Those of pictures for print: --width, --dpi, --font-size, --text.
const std::vector<Options::Known>& paper_options();
/// Throws what writing a picture to that path would, as far as that can be known before; --text of a picture that is none for print too.
void check_picture_path(const Options& options, const std::string& path);
/// .pdf, .svg and .tex as figures for print, all else as images. `how`: with which it was rendered, as rendering_of() has it.
void write_picture(const Options& options, const std::string& path, const Scene& scene, const RenderOptions& how, const Picture& picture);
/// The same with lines and texts apart when the path is of a figure for print.
RenderOptions rendering_of(RenderOptions how, const std::string& path);
/// --aov, in the order of all_aovs(), for a picture of that name. Throws Error(usage).
std::vector<Aov> read_aovs(const Options& options, const std::string& output);
/// Scene, tolerance and certified error, for the file.
Metadata metadata_of(const Scene& scene, const Picture& picture);
/// "1024x768, 12345 triangles, certified error 1e-5, 2.3 s"
std::string summary_of(const Picture& picture);
}  // namespace isoparm
