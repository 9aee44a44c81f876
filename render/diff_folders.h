// diff_folders.h -- two folders of images, paired by name; references rewritten.
#pragma once
#include <string>
#include <vector>

namespace isoparm {

/// NAME.png of the new folder and its references: NAME.png of the other one, and NAME.altWORD.png, of which any may match.
struct FolderPair {
    std::string name;                     // relative to both folders, with /
    std::vector<std::string> references;  // paths; none: there is no reference
    std::string image;                    // path; "": it is missing
};

/// All images below both folders, by name. Links to folders are not followed. Throws Error(io).
std::vector<FolderPair> pair_folders(const std::string& references, const std::string& images);

/// A copy of `from`, byte by byte, that appears whole or not at all; its folder is made. Throws Error(io).
void replace_file(const std::string& to, const std::string& from);

}  // namespace isoparm
