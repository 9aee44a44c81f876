// run_program.h -- runs the real program and collects what it says.
#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "scratch_folder.h"

namespace isoparm::test {

inline std::string program() {
    if (const char* given = std::getenv("ISOPARM_PROGRAM")) return given;
#ifdef ISOPARM_PROGRAM
    return ISOPARM_PROGRAM;
#else
    return "isoparm";
#endif
}
inline std::string source_folder() {
    if (const char* given = std::getenv("ISOPARM_SOURCE_DIR")) return given;
#ifdef ISOPARM_SOURCE_DIR
    return ISOPARM_SOURCE_DIR;
#else
    return ".";
#endif
}

/// The program's, which counts what is in it.
class TemporaryFolder : public ScratchFolder {
public:
    std::size_t files() const {
        std::size_t n = 0;
        for ([[maybe_unused]] const auto& f : std::filesystem::directory_iterator(path())) ++n;
        return n;
    }
};

inline std::string read_all(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}
inline void write_all(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

struct Outcome {
    int code;
    std::string out, err;
};
/// `arguments` is shell text; runs in `folder` when it is not empty; `before` stands before the program ("env A=b", "ulimit -v 9 &&").
inline Outcome run(const std::string& arguments, const std::string& folder = "", const std::string& before = "") {
    const TemporaryFolder t;
    const std::string command = (folder.empty() ? "" : "cd '" + folder + "' && ") + before + " '" + program() + "' " + arguments + " >'" + t / "out" + "' 2>'" + t / "err" + "' </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_all(t / "out"), read_all(t / "err")};
}

}  // namespace isoparm::test
