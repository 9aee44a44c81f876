#include "commands/frame_list.h"

#include <cstdio>
#include <filesystem>
#include <sstream>
#include <vector>

#include "drawing/paper.h"
#include "error.h"
#include "io/atomic_file.h"
#include "scene/json.h"
#include "sha256.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFirstLine = "isoparm frames 1";
constexpr std::size_t kMostBytes = std::size_t{1} << 32;  // of a picture

std::string digest_of(const std::string& picture) {
    std::string all;
    for (const std::string& file : paper_files(picture)) all += sha256(read_text_file(file, kMostBytes));
    return all.size() == 64 ? all : sha256(all);
}

/// What a run that was killed in the midst of naming a file leaves.
bool is_temporary(const fs::path& path) { return path.filename().string().rfind("isoparm.tmp-", 0) == 0; }

}  // namespace

FrameList::FrameList(const std::string& folder, const std::string& key) : folder_(folder), key_(sha256(key)) {
    std::error_code none;
    if (!fs::exists(path(), none)) {
        for (const auto& f : fs::directory_iterator(folder))
            if (!is_temporary(f.path())) throw Error(ErrorKind::input, folder + ": found other files, expected what is done of a film, or an empty folder, or none yet");
        write();
        return;
    }
    std::istringstream in(read_text_file(path(), kMostBytes));
    std::string first, word, theirs, digest;
    std::getline(in, first);
    in >> word >> theirs;
    if (first != kFirstLine || word != "key") throw Error(ErrorKind::input, path() + ": found another file, expected a list of frames; remove the folder to begin anew");
    if (theirs != key_) throw Error(ErrorKind::input, folder + ": found frames of another scene, program or command line, expected those of this one; remove the folder to begin anew");
    for (int k = 0; in >> k >> digest;) digests_[k] = digest;
}

bool FrameList::has(int frame, const std::string& picture) const {
    const auto known = digests_.find(frame);
    if (known == digests_.end()) return false;
    for (const std::string& file : paper_files(picture))
        if (!fs::is_regular_file(file)) return false;
    return digest_of(picture) == known->second;
}

void FrameList::add(int frame, const std::string& picture) {
    digests_[frame] = digest_of(picture);
    write();
}

void FrameList::write() const {
    write_atomically(path(), [&](std::ostream& out) {
        out << kFirstLine << "\nkey " << key_ << "\n";
        for (const auto& [k, digest] : digests_) out << k << " " << digest << "\n";
    });
}

void FrameList::remove(int frames) {
    std::error_code ignored;
    for (int k = 0; k < frames; ++k) {
        char name[32];
        std::snprintf(name, sizeof name, "/%05d.png", k);
        fs::remove(folder_ + name, ignored);
    }
    std::vector<fs::path> left;
    for (const auto& f : fs::directory_iterator(folder_, ignored))
        if (is_temporary(f.path())) left.push_back(f.path());
    for (const fs::path& f : left) fs::remove(f, ignored);
    fs::remove(path(), ignored);
    fs::remove(folder_, ignored);
}

}  // namespace isoparm
