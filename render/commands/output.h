// commands/output.h -- the files that a command will write, checked before there is any work to lose.
#pragma once
#include <string>
#include <vector>

#include "commands/options.h"

namespace isoparm {

/// One file on the command line: the option that named it ("-o"; "SCENE" for the one that is read) and its path.
struct NamedFile {
    std::string option, path;
};

/// What a command that works on a scene reads: the scene and the files that it includes.
std::vector<NamedFile> inputs_of(const Scene& scene);

/// Every output is another file than the inputs and the other outputs, else Error(usage); its folder exists and may be
/// written, and it is no folder itself, else Error(io). "-", standard output, is not looked at.
void check_outputs(const Options& options, const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

/// The folder that -o names, made if it is missing, and files in it, which are checked likewise.
void check_outputs_in(const Options& options, const std::string& folder, const std::vector<std::string>& names, const std::vector<NamedFile>& inputs);

}  // namespace isoparm
