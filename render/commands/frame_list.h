// commands/frame_list.h -- which frames of a film are there already, in a folder that is kept until all of them are.
#pragma once
#include <map>
#include <string>

namespace isoparm {

/// The file `frames` in the folder: a key, and a SHA-256 of each frame that was finished. Always whole.
class FrameList {
public:
    /// A folder that is there: empty, or to go on with what is in it. Throws Error(input) when that is of another key, and nothing is touched; Error(io).
    FrameList(const std::string& folder, const std::string& key);
    /// Is that frame finished, and are the files of its picture as they were written?
    bool has(int frame, const std::string& picture) const;
    void add(int frame, const std::string& picture);
    /// The folder goes, with the frames that are in it.
    void remove(int frames);
    /// Where frames lie that nobody asked for: a path with %05d in it.
    std::string pattern() const { return folder_ + "/%05d.png"; }

private:
    void write() const;
    std::string path() const { return folder_ + "/frames"; }
    std::string folder_, key_;
    std::map<int, std::string> digests_;
};

}  // namespace isoparm
