// study_page.h -- a study as one HTML page that needs no other file and no network.
#pragma once
#include "study/study_table.h"

namespace isoparm {

struct StudyFacts {
    std::string title;                                            // of the scene
    std::vector<std::pair<std::string, std::string>> provenance;  // what, and its value; texts
    std::vector<std::string> methods;
    double heat_tolerance = 0;  // of the pictures
};

/// Inline SVG of the plots (texts, in the order of study_plots()), pictures as data: bytes of PNG files by the name in StudyRow::heat.
std::string study_page(const StudyFacts& facts, const std::vector<StudyRow>& rows, const std::vector<std::string>& svg,
                       const std::vector<std::pair<std::string, std::string>>& png);

}  // namespace isoparm
