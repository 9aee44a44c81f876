// study_store.h -- finished runs of a study in files of their own, so that a study that was killed goes on where it was.
//
// DIR/runs/METHOD-TOLERANCE.json, each written whole or not at all. What a run depends on is in its key; a file with another key, or one
// that cannot be read, is told about and its run is made again. Nothing is ever deleted.
#pragma once
#include <array>
#include <string>

#include "study/study_table.h"

namespace isoparm {

class StudyStore {
public:
    /// Makes the folder and its runs/ and heat/. Throws Error(io).
    explicit StudyStore(std::string folder);

    /// DIR/name
    std::string path(const std::string& name) const { return folder_ + "/" + name; }
    /// runs/fast-0.001.json
    static std::string run_file(const std::string& method, double tolerance);
    /// The run of an earlier study with this key, and with its pictures of that size (PNG) where they are wanted, else 0 x 0; nothing when
    /// there is none. `note` then says why a file that is there does not count.
    std::optional<StudyRow> find(const std::string& method, double tolerance, const std::string& key, const std::array<int, 2>& pictures,
                                 std::string& note) const;
    /// Pictures have to be written before.
    void save(const StudyRow& row) const;

private:
    std::string folder_;
};

}  // namespace isoparm
