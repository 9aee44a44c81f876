// study_plots.h -- the diagrams of a study.
#pragma once
#include "drawing/plot.h"
#include "study/study_table.h"

namespace isoparm {

struct StudyPlot {
    std::string file;     // without extension: triangles-certified
    std::string caption;  // for people
    Plot plot;
};
/// Five of them. `methods` in the order of their styles: a method looks the same in every study of the same list.
std::vector<StudyPlot> study_plots(const std::vector<StudyRow>& rows, const std::vector<std::string>& methods);

inline constexpr double kPlotWidth = 468, kPlotHeight = 342;  // points: the width of a page's text

}  // namespace isoparm
