#include "diff_folders.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include "error.h"
#include "image_header.h"
#include "io/atomic_file.h"
#include "io/extension.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;

bool is_image(const fs::path& path) {
    const std::string extension = extension_of(path);
    const auto& known = readable_formats();
    return std::any_of(known.begin(), known.end(), [&](const auto& f) { return extension == "." + f.first; });
}

std::vector<std::string> images_below(const std::string& folder) {
    std::vector<std::string> names;
    std::error_code code;
    fs::recursive_directory_iterator at(folder, code), end;
    for (; !code && at != end; at.increment(code)) {
        if (at->path().filename().string().find(".tmp-") != std::string::npos) continue;  // of a run that was killed
        std::error_code ignored;
        if (is_image(at->path()) && !at->is_directory(ignored)) names.push_back(at->path().lexically_relative(folder).generic_string());
        if (names.size() > 1'000'000) throw Error(ErrorKind::io, folder + ": found more than 1000000 images");
    }
    if (code) throw Error(ErrorKind::io, folder + ": cannot be read: " + code.message());
    std::sort(names.begin(), names.end());
    return names;
}

/// "a/b.alt2.png" is another reference for "a/b.png".
std::string name_of_reference(const std::string& name) {
    const fs::path path(name), stem = path.stem();
    const std::string word = stem.extension().string();
    if (word.rfind(".alt", 0) != 0) return name;
    return (path.parent_path() / (stem.stem().string() + path.extension().string())).generic_string();
}

}  // namespace

std::vector<FolderPair> pair_folders(const std::string& references, const std::string& images) {
    std::map<std::string, FolderPair> pairs;
    const auto pair = [&](const std::string& name) -> FolderPair& {
        FolderPair& p = pairs[name];
        p.name = name;
        return p;
    };
    for (const std::string& name : images_below(references)) {
        FolderPair& p = pair(name_of_reference(name));
        const std::string path = (fs::path(references) / name).string();
        if (p.name == name) p.references.insert(p.references.begin(), path);
        else p.references.push_back(path);
    }
    for (const std::string& name : images_below(images)) pair(name).image = (fs::path(images) / name).string();
    std::vector<FolderPair> all;
    for (auto& [name, p] : pairs) all.push_back(std::move(p));
    return all;
}

void replace_file(const std::string& to, const std::string& from) {
    std::error_code code;
    if (const fs::path folder = fs::path(to).parent_path(); !folder.empty()) fs::create_directories(folder, code);
    std::ifstream in(from, std::ios::binary);
    if (!in) throw Error(ErrorKind::io, from + ": cannot be read");
    write_atomically(to, [&](std::ostream& out) {
        std::vector<char> bytes(1 << 20);
        while (in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) || in.gcount() > 0) out.write(bytes.data(), in.gcount());
        if (in.bad()) throw Error(ErrorKind::io, from + ": reading failed");
    });
}

}  // namespace isoparm
