#include "study/study_output.h"

#include <filesystem>
#include <ostream>

#include "drawing/text_cairo.h"
#include "io/atomic_file.h"
#include "provenance.h"
#include "scene/json.h"
#include "study/peer.h"
#include "study/study_page.h"
#include "study/study_plots.h"
#include "text/json_text.h"

namespace isoparm {
namespace {

using Facts = std::vector<std::pair<std::string, std::string>>;

Facts provenance_of(const Study& study) {
    Facts facts = {{"program", "isoparm " + program_version()},
                   {"compiler", compiler_name()},
                   {"machine", machine_line()},
                   {"threads", std::to_string(study.threads)},
                   {"scene", std::filesystem::path(study.scene.path).filename().string()},
                   {"scene sha256", study.scene_hash},
                   {"surfaces sha256", study.geometry_hash},
                   {"options", study.options},
                   {"max_triangles", std::to_string(study.max_triangles)},
                   {"diagonal", to_text(study.diagonal)}};
    if (!study.reproducible) facts.push_back({"date", date_line()});
    return facts;
}

std::string order_json(const std::optional<FittedOrder>& o) {
    return o ? "{\"order\": " + json_text(o->order) + ", \"points\": " + std::to_string(o->points) + "}" : "null";
}

void write_json(std::ostream& out, const Study& study, const Facts& facts, const std::vector<StudyRow>& rows) {
    out << "{\"isoparm_study\": 1,\n \"title\": " << json_text(study.scene.title) << ",\n \"provenance\": {";
    for (std::size_t i = 0; i < facts.size(); ++i)
        out << (i ? ",\n  " : "\n  ") << json_text(facts[i].first) << ": " << json_text(facts[i].second);
    out << "},\n \"columns\": {";
    bool first = true;
    for (const StudyColumn& c : study_columns()) {
        out << (first ? "\n  " : ",\n  ") << json_text(std::string(c.name)) << ": {\"unit\": " << json_text(std::string(c.unit))
            << ", \"meaning\": " << json_text(std::string(c.meaning)) << "}";
        first = false;
    }
    out << "},\n \"methods\": [";
    for (std::size_t i = 0; i < study.methods.size(); ++i) {
        const MethodOrders o = fitted_orders(rows, study.methods[i]);
        out << (i ? ",\n  " : "\n  ") << "{\"name\": " << json_text(study.methods[i])
            << ", \"summary\": " << json_text(std::string(find_any_study_method(study.methods[i])->summary))
            << ",\n   \"order\": {\"certified\": " << order_json(o.certified) << ", \"sampled\": " << order_json(o.sampled) << "}}";
    }
    out << "],\n \"runs\": [";
    for (std::size_t i = 0; i < rows.size(); ++i) out << (i ? ",\n  " : "\n  ") << row_json(rows, i);
    out << "]}\n";
}

}  // namespace

void write_results(const Study& study, const StudyStore& store, const std::vector<StudyRow>& rows) {
    const auto write = [&](const std::string& name, const std::string& bytes) {
        write_atomically(store.path(name), [&](std::ostream& out) { out << bytes; });
    };
    StudyFacts facts{study.scene.title.empty() ? std::filesystem::path(study.scene.path).stem().string() : study.scene.title,
                     provenance_of(study), study.methods, study.heat_tolerance()};
    write_atomically(store.path("study.json"), [&](std::ostream& out) { write_json(out, study, facts.provenance, rows); });
    write_atomically(store.path("study.csv"), [&](std::ostream& out) { write_csv(out, rows); });
    std::vector<std::string> svg;
    for (const StudyPlot& p : study_plots(rows, study.methods)) {
        const Drawing drawing = draw_plot(p.plot, kPlotWidth, kPlotHeight);
        svg.push_back(vector_file(drawing, kPlotWidth, kPlotHeight, VectorFormat::svg, p.plot.title));
        write(p.file + ".svg", svg.back());
        write(p.file + ".pdf", vector_file(drawing, kPlotWidth, kPlotHeight, VectorFormat::pdf, p.plot.title));
    }
    std::vector<std::pair<std::string, std::string>> png;
    for (const StudyRow& r : rows)
        if (r.run.tolerance == study.heat_tolerance())
            for (const std::string& name : r.heat) png.push_back({name, read_text_file(store.path(name))});
    write("index.html", study_page(facts, rows, svg, png));
}

}  // namespace isoparm
