#include "machine.h"

#include <cstdlib>
#include <fstream>
#include <thread>

namespace isoparm::bench {
namespace {

std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

#if defined(__clang__)
constexpr const char* kCompiler = "clang " __clang_version__;
#elif defined(__GNUC__)
constexpr const char* kCompiler = "g++ " __VERSION__;
#else
constexpr const char* kCompiler = "unknown compiler";
#endif

}  // namespace

std::string machine_line() {
    return processor() + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores, " + kCompiler +
           ISOPARM_BUILD_FLAGS;
}

double load_average() {
    double load = -1;
    return getloadavg(&load, 1) == 1 ? load : -1;
}

}  // namespace isoparm::bench
