#include "report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "text/json_text.h"

namespace isoparm::bench {
namespace {

/// Median over that of the fastest reference in the table; 0 where none was run.
double ratio(const Measured& m, const std::vector<Measured>& all) {
    double fastest = 0;
    for (const Measured& other : all)
        if (other.table == m.table && other.reference) fastest = std::max(fastest, other.median());
    return fastest > 0 ? m.median() / fastest : 0;
}

std::string text(const char* format, double x) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, format, x);
    return buffer;
}
/// Three digits and k, M or G.
std::string short_text(double x) {
    const char* const units[] = {"", " k", " M", " G"};
    int k = 0;
    for (; k < 3 && x >= 999.5; ++k) x /= 1000;
    return text(x < 9.995 ? "%.2f" : x < 99.95 ? "%.1f" : "%.0f", x) + units[k];
}
std::string padded(const std::string& s, std::size_t width, bool left) {
    const std::string fill(s.size() < width ? width - s.size() : 0, ' ');
    return left ? s + fill : fill + s;
}
std::string load_text(double x) { return x < 0 ? "unknown" : text("%.2f", x); }

}  // namespace

double Measured::median() const {
    if (rates.empty()) return 0;
    std::vector<double> r = rates;
    std::sort(r.begin(), r.end());
    return 0.5 * (r[(r.size() - 1) / 2] + r[r.size() / 2]);
}
double Measured::best() const { return rates.empty() ? 0 : *std::max_element(rates.begin(), rates.end()); }

void write_tables(std::ostream& out, const Place& place, const std::vector<Measured>& all) {
    out << place.machine << "\nload average " << load_text(place.load_before) << " before, "
        << load_text(place.load_after) << " after\n";
    std::size_t width = 0;
    for (const Measured& m : all) width = std::max(width, m.name.size());
    const Measured* last = nullptr;
    for (const Measured& m : all) {
        if (!last || last->table != m.table)
            out << '\n'
                << m.table << '\n'
                << padded("", width + 2, true) << padded(m.unit + "/s: median", 20, false) << padded("best", 10, false)
                << padded("ratio", 9, false) << '\n';
        last = &m;
        const double r = ratio(m, all);
        out << "  " << padded(m.name, width, true) << padded(short_text(m.median()), 20, false)
            << padded(short_text(m.best()), 10, false) << padded(r > 0 ? text("%.2f", r) : "", 9, false);
        for (const auto& [name, value] : m.facts)
            out << "   " << name << ' ' << (value == std::floor(value) ? text("%.0f", value) : text("%.2f", value));
        out << (m.clock == "wall" ? "   (wall time)" : "") << '\n';
    }
}

void write_json(std::ostream& out, const Place& place, const std::vector<Measured>& all) {
    out << "{\"machine\": " << json_text(place.machine) << ",\n \"load\": [" << json_text(place.load_before) << ", "
        << json_text(place.load_after) << "],\n \"cases\": [";
    for (std::size_t k = 0; k < all.size(); ++k) {
        const Measured& m = all[k];
        out << (k ? ",\n  " : "\n  ") << "{\"table\": " << json_text(m.table) << ", \"name\": " << json_text(m.name)
            << ", \"unit\": " << json_text(m.unit + "/s") << ", \"clock\": " << json_text(m.clock)
            << ", \"median\": " << json_text(m.median()) << ", \"best\": " << json_text(m.best());
        if (const double r = ratio(m, all); r > 0)
            out << ", \"reference\": " << (m.reference ? "true" : "false") << ", \"ratio\": " << json_text(r);
        for (const auto& [name, value] : m.facts) out << ", " << json_text(name) << ": " << json_text(value);
        out << ",\n   \"rates\": [";
        for (std::size_t i = 0; i < m.rates.size(); ++i) out << (i ? ", " : "") << json_text(m.rates[i]);
        out << "]}";
    }
    out << "]}\n";
}

}  // namespace isoparm::bench
