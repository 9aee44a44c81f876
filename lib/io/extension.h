// io/extension.h -- what a file's name ends in.
#pragma once
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace isoparm {

/// With its dot and in small letters: ".ply"; empty when there is none.
inline std::string extension_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

}  // namespace isoparm
