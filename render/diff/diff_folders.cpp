#include "diff/diff_folders.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "error.h"
#include "image/image_header.h"
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

/// Formats that others read, so that their images are not overlooked in silence.
bool is_unread_image(const fs::path& path) {
    static const std::set<std::string> known{".avif", ".cin", ".dds", ".dpx", ".gif", ".hdr", ".heic", ".heif", ".iff", ".j2c", ".j2k", ".jp2", ".jpe", ".jxl", ".pam", ".pbm", ".pfm", ".pic",
                                             ".pnm",  ".psd", ".qoi", ".rgb", ".rgba", ".rla", ".sgi",  ".svg",  ".sxr", ".tpic", ".tx", ".webp", ".jp2k", ".jpf", ".ptx", ".ico"};
    return known.count(extension_of(path)) > 0;
}

struct Found {
    std::vector<std::string> images, unread;  // relative to the folder, with /
    std::size_t entries = 0;
};

/// `above`: the folders that lead here, without links: one that is met again is a loop, and has been looked at.
void look_into(const fs::path& folder, const fs::path& name, std::vector<fs::path>& above, Found& found) {
    std::error_code code;
    const auto check = [&](const fs::path& path) {
        if (code) throw Error(ErrorKind::io, path.string() + ": cannot be read: " + code.message());
    };
    const fs::path real = fs::canonical(folder, code);
    check(folder);
    if (std::find(above.begin(), above.end(), real) != above.end()) return;
    above.push_back(real);
    fs::directory_iterator at(folder, code), end;
    for (; !code && at != end; at.increment(code)) {
        const fs::path own = name / at->path().filename();
        if (++found.entries > 4'000'000) throw Error(ErrorKind::io, folder.string() + ": found more than 4000000 files with those above");
        if (own.filename().string().find(".tmp-") != std::string::npos) continue;  // of a run that was killed
        std::error_code ignored;
        if (at->is_directory(ignored)) look_into(at->path(), own, above, found);
        else if (is_image(own)) found.images.push_back(own.generic_string());
        else if (is_unread_image(own)) found.unread.push_back(own.generic_string());
    }
    check(folder);
    above.pop_back();
}

/// None in a folder that does not exist: its references are still to be made.
Found images_below(const std::string& folder) {
    Found found;
    std::vector<fs::path> above;
    std::error_code ignored;
    if (!fs::exists(folder, ignored)) return found;
    look_into(folder, "", above, found);
    std::sort(found.images.begin(), found.images.end());
    std::sort(found.unread.begin(), found.unread.end());
    return found;
}

/// "a/b.alt2.png" may be another reference for "a/b.png"; "" for other names.
std::string main_name(const std::string& name) {
    const fs::path path(name), stem = path.stem();
    if (stem.extension().string().rfind(".alt", 0) != 0) return "";
    return (path.parent_path() / (stem.stem().string() + path.extension().string())).generic_string();
}

}  // namespace

FolderPairs pair_folders(const std::string& references, const std::string& images) {
    const Found old = images_below(references), made = images_below(images);
    const std::set<std::string> olds(old.images.begin(), old.images.end()), news(made.images.begin(), made.images.end());
    const auto alternative = [&](const std::string& name) {
        const std::string main = main_name(name);
        return !main.empty() && (olds.count(main) > 0 || news.count(main) > 0);
    };
    std::map<std::string, FolderPair> pairs;
    const auto pair = [&](const std::string& name) -> FolderPair& {
        FolderPair& p = pairs[name];
        p.name = name, p.alternative = alternative(name);
        return p;
    };
    for (const std::string& name : olds) {
        FolderPair& p = pair(alternative(name) && news.count(name) == 0 ? main_name(name) : name);
        const std::string path = (fs::path(references) / name).string();
        if (p.name == name) p.references.insert(p.references.begin(), path);
        else p.references.push_back(path);
    }
    for (const std::string& name : news) pair(name).image = (fs::path(images) / name).string();
    FolderPairs all;
    for (auto& [name, p] : pairs) all.pairs.push_back(std::move(p));
    for (const auto& [folder, names] : {std::pair{&references, &old.unread}, std::pair{&images, &made.unread}})
        for (const std::string& name : *names) all.unread.push_back((fs::path(*folder) / name).string());
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
