#include "scene/included_file.h"

#include <algorithm>
#include <filesystem>

#include "scene/suggest.h"

namespace isoparm {

namespace fs = std::filesystem;

/// Is every part of `folder` the beginning of `path`? Both without links and dots.
static bool is_below(const fs::path& path, const fs::path& folder) { return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end(); }

std::string included_file(const Json& j, const std::string& name) {
    const fs::path folder = fs::path(j.file()).parent_path(), file = folder / name;
    std::error_code code;
    const fs::path home = fs::canonical(folder.empty() ? "." : folder, code), real = fs::weakly_canonical(fs::absolute(file, code), code);
    if (code || !is_below(real, home)) j.fail("found " + quoted(name) + ", expected a file in the scene's folder or below it");
    // A pipe would wait, a device never end.
    if (fs::exists(real, code) && !fs::is_regular_file(real, code)) j.fail("found " + std::string(fs::is_directory(real, code) ? "a folder" : "a pipe or device") + ", expected a regular file");
    return file.string();
}

}  // namespace isoparm
