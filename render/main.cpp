// isoparm -- boundary curves to surfaces, to meshes of proved error, to ray-traced pictures.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <iostream>

#include "commands/command.h"
#include "commands/guard.h"
#include "error.h"
#include "isoparm_version.h"
#include "scene/suggest.h"

using namespace isoparm;

namespace {

const Command* const kCommands[] = {
    &info_command,        // what is in a scene
    &eval_command,        // a point of a surface, its derivatives, normal and curvatures
    &check_command,       // how patches join
    &tessellate_command,  // a mesh whose error is proved
    &verify_command,      // any mesh against a surface
    &render_command,      // a ray-traced picture
    &camera_command,      // the camera of a picture, for others
    &figures_command,     // all pictures
    &limit_command,       // against OpenSubdiv
    &study_command,       // how well methods tessellate
    &diff_command,        // one image against another
};

std::string help() {
    std::string text = "usage: isoparm COMMAND ...\n\nFrom boundary curves to surfaces, to meshes of proved error, to ray-traced pictures.\n\n";
    for (const Command* c : kCommands) {
        std::string name = c->name;
        name.resize(12, ' ');
        text += "  " + name + c->summary + "\n";
    }
    return text + R"(
isoparm COMMAND --help tells more; --version prints the version.
Every command knows --quiet and --threads N (or ISOPARM_THREADS). Results go to stdout, messages to stderr.

Exit codes: 0 success, 1 success with a warning, 2 something could not be proved or failed a check, 3 not comparable,
4 reading or writing failed, 64 usage, 65 bad scene or data, 70 internal error, 130 and 143 a picture ended early by SIGINT
or SIGTERM.
)";
}

const Command& find_command(const std::string& name) {
    for (const Command* c : kCommands)
        if (name == c->name) return *c;
    std::vector<std::string> names;
    for (const Command* c : kCommands) names.push_back(c->name);
    throw Error(ErrorKind::usage, "unknown command " + quoted(name) + ", expected one of: " + listed(names) + did_you_mean(name, names));
}

bool asks_for_help(const std::vector<std::string>& arguments) {
    const auto end = std::find(arguments.begin(), arguments.end(), "--");
    return std::any_of(arguments.begin(), end, [](const std::string& a) { return a == "--help" || a == "-h"; });
}

int run(std::vector<std::string> arguments) {
    if (arguments.empty()) {
        std::cerr << help();
        return kUsage;
    }
    const std::string first = arguments.front();
    arguments.erase(arguments.begin());
    if (first == "--version") {
        std::cout << "isoparm " ISOPARM_VERSION "\n";
    } else if (first == "--help" || first == "-h" || (first == "help" && arguments.empty())) {
        std::cout << help();
    } else if (first == "help") {
        std::cout << find_command(arguments.front()).help;
    } else {
        const Command& command = find_command(first);
        if (!asks_for_help(arguments)) return command.run(arguments);
        std::cout << command.help;
    }
    return kSuccess;
}

}  // namespace

int main(int count, char** words) {
    tell_crashes();
    std::ios::sync_with_stdio(false);
    std::signal(SIGXFSZ, SIG_IGN);  // a file that grows beyond a limit is an error with a message
    return guarded([&] {
        const int code = run({words + std::min(count, 1), words + count});
        if (!std::cout.flush()) throw Error(ErrorKind::io, "standard output: writing failed");
        return code;
    });
}
