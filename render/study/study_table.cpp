#include "study/study_table.h"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "error.h"
#include "text/json_text.h"

namespace isoparm {
namespace {

using Rows = std::vector<StudyRow>;

template <class Get> std::string of_mesh(const Rows& rows, std::size_t i, Get get) {
    return rows[i].run.triangles > 0 ? to_text(double(get(rows[i].run))) : "";
}

std::string csv_text(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

}  // namespace

const std::vector<StudyColumn>& study_columns() {
    static const std::vector<StudyColumn> columns = {
        {"method", "", "how the mesh was made", false, [](const Rows& r, std::size_t i) { return r[i].run.method; }},
        {"tolerance", "scene units", "what was asked for", true, [](const Rows& r, std::size_t i) { return to_text(r[i].run.tolerance); }},
        {"triangles", "", "of the mesh", true,
         [](const Rows& r, std::size_t i) { return of_mesh(r, i, [](const StudyRun& s) { return s.triangles; }); }},
        {"vertices", "", "of the mesh", true,
         [](const Rows& r, std::size_t i) { return of_mesh(r, i, [](const StudyRun& s) { return s.vertices; }); }},
        {"certified_error", "scene units",
         "proved: no point of mesh or surface is farther from the other; the same certificate for every method", true,
         [](const Rows& r, std::size_t i) { return of_mesh(r, i, [](const StudyRun& s) { return s.certified_error; }); }},
        {"certified_parametric", "scene units", "proved: largest distance of the points of mesh and surface at equal parameters", true,
         [](const Rows& r, std::size_t i) { return of_mesh(r, i, [](const StudyRun& s) { return s.certified_parametric; }); }},
        {"sampled_error", "scene units", "largest distance seen from 12 points of the surface over each triangle to the mesh", true,
         [](const Rows& r, std::size_t i) { return of_mesh(r, i, [](const StudyRun& s) { return s.sampled_error; }); }},
        {"n_opt", "", "asymptotic optimum of triangles at this tolerance, vertices on the surface", true,
         [](const Rows& r, std::size_t i) { return to_text(r[i].run.optimal); }},
        {"ratio", "", "triangles / n_opt", true,
         [](const Rows& r, std::size_t i) {
             return r[i].run.optimal > 0 ? of_mesh(r, i, [](const StudyRun& s) { return s.ratio(); }) : "";
         }},
        {"seconds_processor", "s", "processor time of the method until its mesh was proved, all threads together", true,
         [](const Rows& r, std::size_t i) { return to_text(r[i].run.processor_seconds); }},
        {"seconds_wall", "s", "the same by the clock on the wall", true,
         [](const Rows& r, std::size_t i) { return to_text(r[i].run.seconds); }},
        {"min_angle_least", "degrees", "smallest angle of all triangles", true,
         [](const Rows& r, std::size_t i) { return of_mesh(r, i, [](const StudyRun& s) { return s.angles.least; }); }},
        {"min_angle_1_percent", "degrees", "1 % of the triangles have a smallest angle below this", true,
         [](const Rows& r, std::size_t i) { return of_mesh(r, i, [](const StudyRun& s) { return s.angles.percent_1; }); }},
        {"min_angle_5_percent", "degrees", "the same for 5 %", true,
         [](const Rows& r, std::size_t i) { return of_mesh(r, i, [](const StudyRun& s) { return s.angles.percent_5; }); }},
        {"min_angle_median", "degrees", "the same for half of them", true,
         [](const Rows& r, std::size_t i) { return of_mesh(r, i, [](const StudyRun& s) { return s.angles.median; }); }},
        {"order", "", "of the certified error in triangles^(-1/2), between this row and the coarser one before it", true,
         [](const Rows& r, std::size_t i) {
             const auto order = local_order(r, i);
             return order ? to_text(*order) : "";
         }},
        {"threads", "", "that the run had; nothing but the time depends on them", true,
         [](const Rows& r, std::size_t i) { return std::to_string(r[i].threads); }},
        {"status", "", "reached, or not reached", false,
         [](const Rows& r, std::size_t i) { return std::string(r[i].run.reached ? "reached" : "not reached"); }},
        {"reason", "", "why it was not", false, [](const Rows& r, std::size_t i) { return r[i].run.reason; }},
    };
    return columns;
}

std::optional<double> local_order(const std::vector<StudyRow>& rows, std::size_t i) {
    if (i == 0 || rows[i - 1].run.method != rows[i].run.method || !rows[i].run.reached || !rows[i - 1].run.reached) return {};
    const StudyRun &a = rows[i - 1].run, &b = rows[i].run;
    const auto fitted = fit_order({double(a.triangles), double(b.triangles)}, {a.certified_error, b.certified_error});
    if (!fitted || fitted->points < 2) return {};
    return fitted->order;
}

MethodOrders fitted_orders(const std::vector<StudyRow>& rows, const std::string& method) {
    std::vector<double> triangles, certified, sampled;
    for (const StudyRow& r : rows) {
        if (r.run.method != method || !r.run.reached) continue;
        triangles.push_back(double(r.run.triangles));
        certified.push_back(r.run.certified_error);
        sampled.push_back(r.run.sampled_error);
    }
    return {fit_order(triangles, certified), fit_order(triangles, sampled)};
}

void write_csv(std::ostream& out, const std::vector<StudyRow>& rows) {
    const auto& columns = study_columns();
    for (std::size_t k = 0; k < columns.size(); ++k) out << (k ? "," : "") << columns[k].name;
    out << "\r\n";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t k = 0; k < columns.size(); ++k) out << (k ? "," : "") << csv_text(columns[k].value(rows, i));
        out << "\r\n";
    }
}

std::string row_json(const std::vector<StudyRow>& rows, std::size_t i) {
    std::string text = "{";
    for (const StudyColumn& c : study_columns()) {
        const std::string value = c.value(rows, i);
        text += (text.size() > 1 ? ", " : "") + json_text(std::string(c.name)) + ": " +
                (!c.number       ? json_text(value)
                 : value.empty() ? "null"
                                 : value);
    }
    return text + "}";
}

}  // namespace isoparm
