// study_output.h -- a whole study as a value, and the files that tell about it.
#pragma once
#include "scene/scene.h"
#include "study/study_store.h"

namespace isoparm {

/// What was asked for, and of what.
struct Study {
    Scene scene;
    Composite patches;
    double diagonal = 0;
    std::vector<std::string> methods;
    std::vector<double> tolerances;  // falling
    std::size_t max_triangles = 4'000'000;
    std::array<int, 2> picture_size{1000, 750};
    int threads = 1;
    bool quiet = false, reproducible = false;
    std::string scene_hash, geometry_hash;  // sha256 of the file, and of the surfaces
    std::string options;                    // of the command line

    /// That of the pictures.
    double heat_tolerance() const { return tolerances[(tolerances.size() - 1) / 2]; }
};

/// study.json, study.csv, the diagrams and index.html, in this order; each appears whole or not at all. Throws Error(io).
void write_results(const Study& study, const StudyStore& store, const std::vector<StudyRow>& rows);

}  // namespace isoparm
