#include "provenance.h"

#include <ctime>
#include <fstream>
#include <thread>

#include "isoparm_git.h"
#include "isoparm_version.h"

namespace isoparm {

std::string program_version() {
    const std::string git = ISOPARM_GIT_DESCRIBE;
    return ISOPARM_VERSION + (git.empty() ? "" : " (" + git + ")");
}

std::string compiler_name() {
#if defined(__clang__)
    return "clang " __clang_version__;
#elif defined(__GNUC__)
    return "g++ " __VERSION__;
#else
    return "unknown compiler";
#endif
}

std::string machine_line() {
    std::string processor = "unknown processor";
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("model name", 0) == 0) {
            processor = line.substr(line.find(':') + 2);
            break;
        }
    return processor + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores";
}

std::string date_line() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

}  // namespace isoparm
