// plot.h -- a diagram with logarithmic axes, as a drawing.
#pragma once
#include <string>
#include <vector>

#include "drawing/drawing.h"
#include "scene/scene.h"

namespace isoparm {

/// Markers and dashes tell series apart in grey too.
struct PlotSeries {
    std::string name;          // in the legend
    std::vector<Vec2> points;  // positive; joined in this order
    Color color;               // linear
    std::vector<double> dash;  // points; empty: not dashed
    int marker = 0;            // one of kPlotMarkers; negative: none
};
inline constexpr int kPlotMarkers = 7;

struct Plot {
    std::string title, x_label, y_label;  // prose; mathematics between $
    std::vector<PlotSeries> series;
};

/// Colour, dash and marker of the n-th series.
PlotSeries plot_style(std::size_t n);

/// In points, (0,0) the top left corner. Series without points are left out; text says so when none is left.
Drawing draw_plot(const Plot& plot, double width, double height);

/// A round number as 0.5, or with powers of ten: $10^{-3}$, $5 \cdot 10^{-1}$.
MathText tick_text(double x, bool powers);
/// Round numbers of an axis from low to high: powers of ten, or 1, 2, 5 of each where there are few of them.
std::vector<double> log_ticks(double low, double high);

}  // namespace isoparm
