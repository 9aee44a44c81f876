// commands/command.h -- what every command gets, and how it answers.
#pragma once
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace isoparm {

/// Exit codes, see docs and --help.
enum ExitCode { kSuccess = 0, kWarning = 1, kCheckFailed = 2, kNotComparable = 3, kIoError = 4, kUsage = 64, kBadInput = 65, kInternal = 70 };

struct Command {
    const char* name;
    const char* summary;                                    // one line for --help
    const char* help;                                       // the whole help text of the command
    int (*run)(const std::vector<std::string>& arguments);  // without the program's and the command's name; throws Error
};

extern const Command info_command, eval_command, tessellate_command, render_command, figures_command, limit_command, camera_command, study_command, verify_command, check_command, diff_command;

}  // namespace isoparm
