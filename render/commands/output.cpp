#include "commands/output.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "error.h"
#include "io/atomic_file.h"
#include "scene/suggest.h"

namespace isoparm {

namespace {

namespace fs = std::filesystem;

bool is_device(const std::string& path) {
    std::error_code code;
    const fs::file_status s = fs::status(path, code);
    return fs::exists(s) && !fs::is_regular_file(s) && !fs::is_directory(s);
}
/// Where a file lies or will lie, links followed.
fs::path place_of(const std::string& path) {
    std::error_code code;
    const std::string target = is_device(path) ? path : behind_links(path);
    const fs::path all = fs::absolute(target.empty() ? path : target, code), real = fs::weakly_canonical(all, code);
    return code ? all.lexically_normal() : real;
}
bool same_file(const std::string& a, const std::string& b) {
    if (is_device(a)) return false;  // /dev/null holds nothing that could be lost
    std::error_code code;
    return place_of(a) == place_of(b) || (fs::equivalent(a, b, code) && !code);
}

void check_writable(const std::string& path) {
    const auto fail = [&](int error) { throw Error(ErrorKind::io, path + ": cannot be written: " + std::strerror(error)); };
    if (path.empty()) throw Error(ErrorKind::io, "the name of the file to write is empty");
    std::error_code code;
    if (fs::is_directory(path, code)) fail(EISDIR);
    if (is_device(path)) {
        if (::access(path.c_str(), W_OK) != 0) fail(errno);
        return;
    }
    if (behind_links(path).empty()) fail(errno);
    const fs::path folder = place_of(path).parent_path() / ".";
    if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(errno);
}

}  // namespace

std::vector<NamedFile> inputs_of(const Scene& scene) {
    std::vector<NamedFile> files{{"SCENE", scene.path}};
    for (const std::string& path : scene.included) files.push_back({"a definition in SCENE", path});
    return files;
}

void check_outputs(const Options& options, const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
    std::vector<NamedFile> others = inputs;
    for (const NamedFile& o : outputs) {
        if (o.path == "-") continue;
        for (const NamedFile& other : others) {
            if (same_file(o.path, other.path))
                options.fail(o.option + ": found " + quoted(o.path) + ", which is the file of " + other.option + " too, expected another one");
        }
        others.push_back(o);
    }
    for (const NamedFile& o : outputs)
        if (o.path != "-") check_writable(o.path);
}

void check_outputs_in(const Options& options, const std::string& folder, const std::vector<std::string>& names, const std::vector<NamedFile>& inputs) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) throw Error(ErrorKind::io, folder + ": cannot make this folder: " + failed.message());
    std::vector<NamedFile> outputs;
    for (const std::string& name : names) outputs.push_back({"-o", (fs::path(folder) / name).string()});
    check_outputs(options, outputs, inputs);
}

}  // namespace isoparm
