#include "scene_include.h"

#include <filesystem>

namespace isoparm {

IncludedFile read_included(const Json& name, const SceneValues& values, const std::string& what) {
    const std::filesystem::path file = std::filesystem::path(name.file()).parent_path() / values.text(name, "the name of " + what + ", relative to the scene");
    std::error_code code;  // a pipe would wait, a device never end
    if (std::filesystem::exists(file, code) && !std::filesystem::is_regular_file(file, code)) {
        name.fail("found " + std::string(std::filesystem::is_directory(file, code) ? "a folder" : "a pipe or device") + ", expected a regular file");
    }
    try {
        return {read_text_file(file.string()), file.string()};
    } catch (const Error& e) {
        name.fail("found a file that cannot be used, expected " + what + ": " + e.what());
    }
}

}  // namespace isoparm
