// diff_folders.h -- two folders of images, paired by name; references rewritten.
#pragma once
#include <string>
#include <vector>

namespace isoparm {

/// NAME.png of the new folder and its references: NAME.png of the other one, and NAME.altWORD.png, of which any may match. The latter only
/// where there is a NAME.png in either folder, and no NAME.altWORD.png in the new one.
struct FolderPair {
    std::string name;                     // relative to both folders, with /
    std::vector<std::string> references;  // paths; none: there is no reference
    std::string image;                    // path; "": it is missing
    bool alternative = false;             // the name is that of another reference for a NAME.png in either folder
};
struct FolderPairs {
    std::vector<FolderPair> pairs;    // by name
    std::vector<std::string> unread;  // paths of images of formats that are not read
};

/// All images below both folders. Links to folders are followed; a loop of them ends where it meets itself. No folder of references is as an
/// empty one. Throws Error(io).
FolderPairs pair_folders(const std::string& references, const std::string& images);

/// A copy of `from`, byte by byte, that appears whole or not at all; its folder is made. Throws Error(io).
void replace_file(const std::string& to, const std::string& from);

}  // namespace isoparm
