#include "study/study_plots.h"

#include <cstdio>
#include <set>

#include "picture/palette.h"
#include "study/peer.h"

namespace isoparm {
namespace {

using Value = double (*)(const StudyRun&);

double tolerance_of(const StudyRun& r) { return r.tolerance; }
double triangles_of(const StudyRun& r) { return double(r.triangles); }
double certified_of(const StudyRun& r) { return r.certified_error; }
double sampled_of(const StudyRun& r) { return r.sampled_error; }
double seconds_of(const StudyRun& r) { return r.processor_seconds; }
double ratio_of(const StudyRun& r) { return r.ratio(); }

/// A style belongs to a method's place among all that the program knows.
std::size_t style_of(const std::string& method) {
    std::size_t n = 0;
    for (const StudyMethod& m : all_study_methods())
        if (method == m.name)
            break;
        else
            ++n;
    return n;
}

std::string with_order(const std::string& name, const std::optional<FittedOrder>& order) {
    if (!order) return name;
    char text[64];
    std::snprintf(text, sizeof text, ": order %.2f (%zu points)", order->order, order->points);
    return name + text;
}

PlotSeries series_of(const std::vector<StudyRow>& rows, const std::string& method, Value x, Value y) {
    PlotSeries s = plot_style(style_of(method));
    s.name = method;
    for (const StudyRow& r : rows)
        if (r.run.method == method && r.run.reached && x(r.run) > 0 && y(r.run) > 0) s.points.push_back({x(r.run), y(r.run)});
    return s;
}

std::vector<PlotSeries> all_series(const std::vector<StudyRow>& rows, const std::vector<std::string>& methods, Value x, Value y) {
    std::vector<PlotSeries> all;
    for (const std::string& m : methods) all.push_back(series_of(rows, m, x, y));
    return all;
}

/// N_opt over what is asked for or reached, as far as the rows go.
PlotSeries optimum(const std::vector<StudyRow>& rows, Value x) {
    PlotSeries s;
    s.name = "$N_{opt}$, the asymptotic optimum";
    s.color = Color{0.05, 0.05, 0.05};
    s.dash = {1, 3};
    s.marker = -1;
    std::set<double> at;
    double constant = 0;  // N_opt times the tolerance
    for (const StudyRow& r : rows) {
        if (!r.run.reached) continue;
        constant = r.run.optimal * r.run.tolerance;
        if (x(r.run) > 0) at.insert(x(r.run));
    }
    if (at.empty() || !(constant > 0)) return s;
    for (const double e : {*at.begin(), *at.rbegin()}) s.points.push_back({e, constant / e});
    return s;
}

}  // namespace

std::vector<StudyPlot> study_plots(const std::vector<StudyRow>& rows, const std::vector<std::string>& methods) {
    std::vector<StudyPlot> plots = {
        {"triangles-certified",
         "Triangles against the certified error. Parallel to the dotted line means second order: twice the triangles, half the error.",
         {"Triangles against certified error", "certified error (scene units)", "triangles",
          all_series(rows, methods, certified_of, triangles_of)}},
        {"triangles-sampled",
         "The same against the largest error seen at samples, which proves nothing.",
         {"Triangles against sampled error", "sampled error (scene units)", "triangles",
          all_series(rows, methods, sampled_of, triangles_of)}},
        {"triangles-tolerance",
         "Triangles against the tolerance that was asked for, and the asymptotic optimum.",
         {"Triangles against tolerance", "tolerance (scene units)", "triangles", all_series(rows, methods, tolerance_of, triangles_of)}},
        {"time-triangles",
         "Processor time of the method until its mesh was proved. That of uniform holds the search for n, that of quadtree all rounds of "
         "refinement.",
         {"Time against triangles", "triangles", "processor time (s)", all_series(rows, methods, triangles_of, seconds_of)}},
        {"ratio-tolerance",
         "How many times the asymptotic optimum a method needs. The optimum is for fine tolerances: at coarse ones no mesh comes near it.",
         {"Triangles over the optimum", "tolerance (scene units)", "$N / N_{opt}$", all_series(rows, methods, tolerance_of, ratio_of)}},
    };
    for (std::size_t k = 0; k < methods.size(); ++k) {
        const MethodOrders orders = fitted_orders(rows, methods[k]);
        plots[0].plot.series[k].name = with_order(methods[k], orders.certified);
        plots[1].plot.series[k].name = with_order(methods[k], orders.sampled);
    }
    plots[0].plot.series.push_back(optimum(rows, certified_of));
    plots[1].plot.series.push_back(optimum(rows, sampled_of));
    plots[2].plot.series.push_back(optimum(rows, tolerance_of));
    return plots;
}

}  // namespace isoparm
