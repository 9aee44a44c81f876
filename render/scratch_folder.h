// scratch_folder.h -- a folder for files that nobody is to keep.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include "error.h"

namespace isoparm {

/// A folder of its own below the system's for temporary files, removed with all that is in it in the end. Throws Error (io)
/// when it cannot be made. Not to be shared by threads while it is made or removed.
class ScratchFolder {
public:
    ScratchFolder() {
        std::error_code missing;
        path_ = (std::filesystem::temp_directory_path(missing) / "isoparm-XXXXXX").string();
        if (missing || !::mkdtemp(path_.data())) throw Error(ErrorKind::io, path_ + ": cannot make a temporary folder (TMPDIR names where)");
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::string& path() const { return path_; }
    std::string operator/(const std::string& name) const { return path_ + "/" + name; }

private:
    std::string path_;
};

}  // namespace isoparm
